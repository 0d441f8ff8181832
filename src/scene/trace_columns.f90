!> The columns of a trace: which columns a scene has, which the case asks for, and the values of a row.
module trace_columns
  use kinds, only: dp
  use error_handling, only: error_t, fail, status_case_file
  use text_tools, only: nearest_word, allowed
  use trace_row, only: trace_row_t, column_list_t, name_length, least, largest
  use chain_motion, only: motion_t, accelerations_t, piston_pin, small_end, body_pin
  use chain_reactions, only: reactions_t
  use joint_columns, only: add_joint_columns, add_pin_force, add_rod_load
  use joint_places, only: places, n_places, in_order
  use guide_columns, only: add_guide_columns
  use elastic_columns, only: add_elastic_columns
  use train_columns, only: add_train_columns
  use case_definition, only: case_t
  use scene_problem, only: scene_t, evaluation_t
  use scene_builder, only: assemble_scene
  implicit none
  private
  public :: column_list_t, all_columns, choose_columns, row_values, column_name, unit_in

contains

  !> The columns that the case asks for. Error: a column that the scene does not have.
  subroutine choose_columns(case, ideal_joint, list, error)
    type(case_t), intent(in) :: case
    logical, intent(in) :: ideal_joint  !! true for the ideal twin: it has the columns of ideal joints, and ignores names of other
                                        !! columns
    type(column_list_t), intent(out) :: list
    type(error_t), allocatable, intent(out) :: error
    logical, allocatable :: wanted(:)
    integer :: i
    call all_columns(case, ideal_joint, list)
    wanted = .not. list%on_request
    if (case%output%columns /= 'standard') &
      call read_names(case%output%columns, list%names, list%on_request, ideal_joint, wanted, error)
    list%id = pack([(i, i=1, size(wanted))], wanted)
  end subroutine choose_columns

  !> The columns of the scene of a case, and what is kept of them; none of them is in a row.
  subroutine all_columns(case, ideal_joint, list)
    type(case_t), intent(in) :: case
    logical, intent(in) :: ideal_joint  !! see `choose_columns`
    type(column_list_t), intent(out) :: list
    type(scene_t), allocatable :: scene
    type(trace_row_t) :: row
    type(evaluation_t) :: nothing
    integer :: i
    call assemble_scene(case, ideal_joint, .false., scene)
    nothing = transfer([(0.0_dp, i=1, storage_size(nothing)/storage_size(0.0_dp) + 1)], nothing)
    call row%collect_names()
    call add_columns(scene, 0.0_dp, nothing, 0.0_dp, 0.0_dp, row)
    list%names = row%names(:row%n)
    list%meanings = row%meanings(:row%n)
    list%on_request = row%on_request(:row%n)
    list%kept = row%kept
    list%id = [integer ::]
  end subroutine all_columns

  !> Mark the columns named in a text such as 'time, crank_angle' or 'standard, film_power'. Error: each name that the scene does
  !> not have.
  subroutine read_names(text, names, on_request, ignores_missing, wanted, error)
    character(len=*), intent(in) :: text
    character(len=name_length), intent(in) :: names(:)   !! names of the columns of the scene
    logical, intent(in) :: on_request(:)   !! true for columns that are not standard
    logical, intent(in) :: ignores_missing
    logical, intent(out) :: wanted(:)
    type(error_t), allocatable, intent(out) :: error
    character(len=name_length) :: known(size(names) + 1)   !! names without units
    integer, parameter :: longest = 500   !! list of columns in a message
    character(len=:), allocatable :: rest, name, near, message, listed
    integer :: i, comma
    logical :: found

    known(1) = 'standard'
    do i = 1, size(names)
      known(i + 1) = names(i)(:scan(names(i), '[') - 1)
    end do
    listed = allowed(known)
    if (len(listed) > longest) listed = listed(:index(listed(:longest), ',', back=.true.))//' ...)'
    message = ''
    near = ''
    wanted = .false.
    rest = text//','
    do
      comma = scan(rest, ',')
      if (comma == 0) exit
      name = trim(adjustl(rest(:comma - 1)))
      rest = rest(comma + 1:)
      found = ignores_missing .or. name == 'standard'
      if (name == 'standard') wanted = wanted .or. .not. on_request
      do i = 1, size(names)
        if (name /= names(i) .and. name /= known(i + 1)) cycle
        found = .true.
        wanted(i) = .true.
      end do
      if (found) cycle
      if (message /= '') message = message//achar(10)
      near = nearest_word(name, known)
      if (near /= '') near = '; did you mean '//near//'?'
      message = message//"&output columns = '"//name//"': no such column in this scene"//near//listed
    end do
    if (message /= '') call fail(error, message, status_case_file)
  end subroutine read_names

  !> The unit in the name of a column.
  pure function unit_in(name) result(unit)
    character(len=*), intent(in) :: name
    character(len=:), allocatable :: unit
    unit = name(index(name, '[') + 1:index(name, ']') - 1)
  end function unit_in

  !> Name and unit of column i of the list.
  pure function column_name(list, i) result(name)
    type(column_list_t), intent(in) :: list
    integer, intent(in) :: i
    character(len=:), allocatable :: name
    name = trim(list%names(list%id(i)))
  end function column_name

  !> The values of a row at time t, from an evaluation of the scene and the work of the non-conservative forces.
  pure subroutine row_values(list, scene, t, now, work, initial_energy, values, rates)
    type(column_list_t), intent(in) :: list
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t                !! [s]
    type(evaluation_t), intent(in) :: now
    real(dp), intent(in) :: work             !! of the non-conservative forces since t = 0 [J]
    real(dp), intent(in) :: initial_energy   !! [J]
    real(dp), intent(out) :: values(:)       !! (size(list%id))
    real(dp), intent(out), optional :: rates(:)   !! (size(list%id)), not defined for a column without one
    type(trace_row_t) :: row
    integer :: i
    call row%choose(list)
    call add_columns(scene, t, now, work, initial_energy, row)
    do i = 1, size(values)   ! row%values(list%id) would allocate a copy of the indices
      values(i) = row%values(list%id(i))
      if (present(rates)) rates(i) = row%rates(list%id(i))
    end do
  end subroutine row_values

  !> Add every column of a scene to a row, in the order of the trace.
  pure subroutine add_columns(scene, t, now, work, initial_energy, row)
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t, work, initial_energy
    type(evaluation_t), intent(in) :: now
    type(trace_row_t), intent(inout) :: row
    type(reactions_t) :: reaction
    real(dp) :: energy, rod(2)
    integer :: i
    call row%add('time[s]', t, 'time since the start of the run')
    if (allocated(scene%given_load)) then
      call add_crank_angle(now%motion, row)
      do i = 1, size(scene%joints)
        call add_joint_columns(scene%joints(i), now%joint(i), row)
      end do
      return
    end if
    call add_motion(now%motion, now%accelerations, row)
    call row%add('crank_moment[N.m]', now%crank_moment, &
      'moment of the drive on the crank, positive in the sense of crank_angle; at constant speed the one that holds the speed')
    if (.not. scene%chain%drive%free_crank .and. .not. scene%chain%has_crankshaft() .or. allocated(scene%chain%varying)) then
      call row%keep('max_drive_torque', largest, 'largest moment of the drive on the crank, in the sense of crank_angle')
      call row%keep('min_drive_torque', least, 'smallest moment of the drive on the crank; negative: against that sense')
    end if
    if (row%is_full()) return
    call add_forces(scene, now, row, reaction)
    energy = 0
    if (row%wants(2)) energy = scene%energy(now)
    call row%add('energy[J]', energy, 'kinetic and potential energy of all bodies, with the energy stored in elastic members')
    call row%add('energy_residual[J]', energy - initial_energy - work, &
      'energy minus initial energy minus the work of all non-conservative forces and of the drive; 0 for an exact integration')
    do i = 1, size(scene%joints)
      call add_joint_columns(scene%joints(i), now%joint(i), row)
      rod = now%joint(i)%rod
      if (scene%joints(i)%spot <= n_places) rod = rod_of(now%motion)
      if (places(scene%joints(i)%place)%pin > 0) call add_rod_load(scene%joints(i)%spot, rod, now%joint(i)%force, row)
    end do
    if (allocated(scene%chain%floating)) call add_floating_pin(scene, now, row)
    if (allocated(scene%guide)) &
      call add_guide_columns(scene%guide, scene%chain%bodies%piston, now%motion, now%accelerations, now%guide, row)
    if (allocated(scene%chain%elastic)) call add_elastic_columns(scene%chain%elastic, now%motion, now%accelerations, row)
    if (allocated(scene%chain%train)) &
      call add_train_columns(scene%chain%train, now%motion, now%accelerations, reaction, row)
    if (allocated(scene%gas)) call scene%gas%add_columns(now%motion%sin_crank, now%motion%cos_crank, now%cylinder_pressure, &
      now%charge, row)
  end subroutine add_columns

  !> Cosine and sine of the angle of the rod.
  pure function rod_of(motion) result(rod)
    type(motion_t), intent(in) :: motion
    real(dp) :: rod(2)
    rod = [motion%cos_rod, motion%sin_rod]
  end function rod_of

  !> Add the columns of a floating pin.
  pure subroutine add_floating_pin(scene, now, row)
    type(scene_t), intent(in) :: scene
    type(evaluation_t), intent(in) :: now
    type(trace_row_t), intent(inout) :: row
    real(dp) :: force(2)
    integer :: i
    force = -now%loads%force(:, small_end)
    call row%add('small_end_force_x[N]', force(1), 'force of the joint in the small end on the floating pin, along x')
    call row%add('small_end_force_y[N]', force(2), 'the same along y; the rod takes the opposite force')
    call row%add('pin_angle[rad]', now%motion%pin_angle, 'turn of the floating pin since the start, positive from x to y')
    call row%keep('max_pin_angle', largest, 'largest turn of the floating pin since the start', &
      rate=now%motion%turning(body_pin), is_cubic=.true.)
    call row%keep('min_pin_angle', least, 'smallest turn of the floating pin since the start', &
      rate=now%motion%turning(body_pin), is_cubic=.true.)
    call row%add('pin_speed[rad/s]', now%motion%turning(body_pin), 'rate of pin_angle')
    call row%add('pin_acceleration[rad/s2]', now%accelerations%pin_turn, 'rate of pin_speed')
    do i = 1, scene%n_joints
      if (scene%joints(i)%site%pin_body /= body_pin) cycle
      row%place = places(scene%joints(i)%place)%prefix
      call row%add_on_request('joint_moment[N.m]', now%joint(i)%moment, 'moment of the joint on the floating pin')
    end do
    row%place = ''
  end subroutine add_floating_pin

  pure subroutine add_motion(m, a, row)
    type(motion_t), intent(in) :: m
    type(accelerations_t), intent(in) :: a
    type(trace_row_t), intent(inout) :: row
    real(dp) :: rod_angle
    call add_crank_angle(m, row)
    rod_angle = 0
    if (row%wants(1)) rod_angle = atan2(m%sin_rod, m%cos_rod)
    call row%add('rod_angle[rad]', rod_angle, 'angle of the connecting rod from the cylinder axis, positive from +x towards -y')
    call row%add('piston_position[m]', m%piston_position, 'height of the piston pin bearing above the crank axis, along x')
    call row%add('crank_speed[rad/s]', m%crank_speed, 'rate of crank_angle')
    call row%keep('max_crank_speed', largest, 'largest speed of the crank', rate=a%crank)
    call row%keep('min_crank_speed', least, 'smallest speed of the crank', rate=a%crank)
    call row%add('rod_speed[rad/s]', m%rod_speed, 'rate of rod_angle')
    call row%add('piston_velocity[m/s]', m%piston_velocity, 'rate of piston_position')
    call row%add('crank_acceleration[rad/s2]', a%crank, 'rate of crank_speed')
    call row%add('rod_acceleration[rad/s2]', a%rod, 'rate of rod_speed')
    call row%add('piston_acceleration[m/s2]', a%piston, 'rate of piston_velocity')
  end subroutine add_motion

  pure subroutine add_crank_angle(m, row)
    type(motion_t), intent(in) :: m
    type(trace_row_t), intent(inout) :: row
    call row%add('crank_angle[rad]', m%crank_angle, 'angle of the crank from +x towards +y, counted on over whole revolutions')
  end subroutine add_crank_angle

  !> Add the columns of the forces between the bodies.
  pure subroutine add_forces(scene, now, row, reaction)
    type(scene_t), intent(in) :: scene
    type(evaluation_t), intent(in) :: now
    type(trace_row_t), intent(inout) :: row
    type(reactions_t), intent(out) :: reaction   !! those of the columns, if there are any
    call row%add('pin_force_x[N]', now%loads%force(1, piston_pin), &
      'force of the joint on the piston pin (on the rod), along x; the piston takes the opposite force')
    call row%add('pin_force_y[N]', now%loads%force(2, piston_pin), 'the same along y')
    if (all(scene%joints%place /= in_order(1))) then
      call add_pin_force(scene%pin_force(now, in_order(1)), row)
      call add_rod_load(in_order(1), rod_of(now%motion), now%loads%force(:, piston_pin), row)
    end if
    if (row%wants(7) .or. allocated(scene%chain%train) .and. .not. row%is_naming) &
      reaction = scene%chain%reactions(now%motion, now%accelerations, now%loads)
    call row%add('crankpin_force_x[N]', reaction%crankpin(1), 'force of the crank on the rod at the crank pin, along x (F3)')
    call row%add('crankpin_force_y[N]', reaction%crankpin(2), 'the same along y (F4)')
    call row%add('crank_bearing_force_x[N]', reaction%crank_bearing(1), &
      'force of the frame on the crank at its main bearing, along x (F1)')
    call row%add('crank_bearing_force_y[N]', reaction%crank_bearing(2), 'the same along y (F2)')
    call row%add('guide_force[N]', reaction%guide, 'force of the piston on its guide along y; the piston takes the opposite (F7)')
    call row%add('frame_force_x[N]', reaction%frame(1), &
      'force of the frame on the mechanism along x: crank bearing, guide and cylinder head together; the frame takes the opposite')
    call row%add('frame_force_y[N]', reaction%frame(2), 'the same along y')
  end subroutine add_forces
end module trace_columns
