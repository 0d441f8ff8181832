!> The columns of a trace: their names with units, which of them a scene has, and their values.
module columns
  use kinds, only: dp
  use gudgeon_scene, only: scene_t, evaluation_t
  use case_definition, only: case_t
  use errors, only: error_t, fail, status_case_file
  use chain_motion, only: piston_pin
  use chain_reactions, only: reactions_t
  implicit none
  private
  public :: column_list_t, choose_columns, row_values, column_name

  integer, parameter :: n_columns = 35
  integer, parameter :: name_length = 32

  !> Names of all columns, in the order of a row.
  character(len=name_length), parameter :: names(n_columns) = [character(len=name_length) :: &
    'time[s]', 'crank_angle[rad]', 'rod_angle[rad]', 'piston_position[m]', 'crank_speed[rad/s]', 'rod_speed[rad/s]', &
    'piston_velocity[m/s]', 'crank_acceleration[rad/s2]', 'rod_acceleration[rad/s2]', 'piston_acceleration[m/s2]', &
    'crank_moment[N.m]', 'pin_force_x[N]', 'pin_force_y[N]', 'crankpin_force_x[N]', 'crankpin_force_y[N]', &
    'crank_bearing_force_x[N]', 'crank_bearing_force_y[N]', 'guide_force[N]', 'frame_force_x[N]', 'frame_force_y[N]', &
    'energy[J]', 'energy_residual[J]', &
    'eccentricity_x[m]', 'eccentricity_y[m]', 'eccentricity_ratio[-]', 'film_thickness[m]', 'phase[-]', &
    'normal_force[N]', 'friction_force[N]', 'sliding_speed[m/s]', 'film_force_x[N]', 'film_force_y[N]', &
    'cylinder_pressure[Pa]', 'cylinder_volume[m3]', 'gas_force[N]']

  !> Groups of columns: the first and last of each.
  integer, parameter :: always(2) = [1, 22], clearance(2) = [23, 27], contact(2) = [28, 30], film(2) = [31, 32], &
    gas(2) = [33, 35]

  !> The columns of one trace.
  type :: column_list_t
    integer, allocatable :: id(:)       !! positions in `names`
    real(dp) :: clearance = 1           !! of the joint [m], for the eccentricity ratio
    logical :: needs_rod_angle = .false.
    logical :: needs_reactions = .false.
    logical :: needs_energy = .false.
  end type column_list_t

contains

  !> The columns that the case asks for, of those that its scene has. Error: a name that the scene does not have.
  subroutine choose_columns(case, ideal_joint, list, error)
    type(case_t), intent(in) :: case
    logical, intent(in) :: ideal_joint   !! of the ideal twin: it has what an ideal joint has, and ignores other names
    type(column_list_t), intent(out) :: list
    type(error_t), allocatable, intent(out) :: error
    logical :: has(n_columns), wanted(n_columns)
    integer :: i

    has = .false.
    has(always(1):always(2)) = .true.
    if (case%joint%has_clearance() .and. .not. ideal_joint) then
      list%clearance = case%joint%clearance
      has(clearance(1):clearance(2)) = .true.
      has(contact(1):contact(2)) = allocated(case%joint%contact)
      has(film(1):film(2)) = allocated(case%joint%film)
    end if
    has(gas(1):gas(2)) = allocated(case%combustion)
    wanted = .true.
    if (allocated(case%output%columns)) then
      if (case%output%columns /= 'standard') call read_names(case%output%columns, has, ideal_joint, wanted, error)
      if (allocated(error)) return
    end if
    list%id = pack([(i, i=1, n_columns)], has .and. wanted)
    list%needs_rod_angle = any(list%id == 3)
    list%needs_reactions = any(list%id >= 14 .and. list%id <= 20)
    list%needs_energy = any(list%id == 21 .or. list%id == 22)
  end subroutine choose_columns

  !> Mark the columns named in a text such as 'time, crank_angle'.
  subroutine read_names(text, has, ignores_missing, wanted, error)
    character(len=*), intent(in) :: text
    logical, intent(in) :: has(:), ignores_missing
    logical, intent(out) :: wanted(:)
    type(error_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: rest, name, known
    integer :: i, comma
    logical :: found

    wanted = .false.
    rest = text//','
    do
      comma = scan(rest, ',')
      if (comma == 0) exit
      name = trim(adjustl(rest(:comma - 1)))
      rest = rest(comma + 1:)
      found = .false.
      do i = 1, n_columns
        if (name /= names(i) .and. name /= names(i)(:scan(names(i), '[') - 1)) cycle
        found = has(i) .or. ignores_missing
        wanted(i) = .true.
      end do
      if (.not. found) then
        known = ''
        do i = 1, n_columns
          if (has(i)) known = known//' '//names(i)(:scan(names(i), '[') - 1)
        end do
        call fail(error, "&output columns = '"//name//"': no such column in this scene; it has:"//known, status_case_file)
        return
      end if
    end do
  end subroutine read_names

  !> Name and unit of column i of the list.
  pure function column_name(list, i) result(name)
    type(column_list_t), intent(in) :: list
    integer, intent(in) :: i
    character(len=:), allocatable :: name
    name = trim(names(list%id(i)))
  end function column_name

  !> The values of a row from one evaluation of the scene at time t, with the work of the non-conservative forces so far.
  !> What takes work and is not in the list is left out.
  pure subroutine row_values(list, scene, t, now, work, initial_energy, values)
    type(column_list_t), intent(in) :: list
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t                !! [s]
    type(evaluation_t), intent(in) :: now
    real(dp), intent(in) :: work             !! [J]
    real(dp), intent(in) :: initial_energy   !! [J]
    real(dp), intent(out) :: values(:)       !! (size(list%id))
    real(dp) :: all_values(n_columns)   !! undefined for columns that the scene does not have
    type(reactions_t) :: reaction
    integer :: i

    associate (m => now%motion, a => now%accelerations, v => all_values)
      v(1) = t
      v(2) = m%crank_angle
      v(3) = 0
      if (list%needs_rod_angle) v(3) = atan2(m%sin_rod, m%cos_rod)
      v(4) = m%piston_position
      v(5) = m%crank_speed
      v(6) = m%rod_speed
      v(7) = m%piston_velocity
      v(8) = a%crank
      v(9) = a%rod
      v(10) = a%piston
      v(11) = now%crank_moment
      v(12:13) = now%loads%force(:, piston_pin)
      if (list%needs_reactions) then
        reaction = scene%chain%reactions(m, a, now%loads)
        v(14:15) = reaction%crankpin
        v(16:17) = reaction%crank_bearing
        v(18) = reaction%guide
        v(19:20) = reaction%frame
      end if
      v(21) = 0
      if (list%needs_energy) v(21) = scene%energy(m)
      v(22) = v(21) - initial_energy - work
      i = scene%joint_at(piston_pin)
      if (i > 0) then
        v(23:24) = now%relative(i)%eccentricity
        v(25) = now%relative(i)%distance/list%clearance
        v(26) = -now%relative(i)%penetration
        v(27) = scene%joints(i)%phase
        v(28) = now%joint(i)%normal_force
        v(29) = now%joint(i)%friction_force
        v(30) = now%relative(i)%sliding_speed
        v(31:32) = now%joint(i)%film
      end if
      if (allocated(scene%gas)) then
        v(33) = now%cylinder_pressure
        v(34) = scene%gas%cycle%cylinder%volume_at(m%sin_crank, m%cos_crank)
        v(35) = now%loads%gas_force
      end if
    end associate
    do i = 1, size(values)   ! all_values(list%id) would allocate a copy of the subscripts
      values(i) = all_values(list%id(i))
    end do
  end subroutine row_values
end module columns
