!> Rules that the values of a case with several cylinders, or with a crankshaft of several stations, must obey together.
module train_rules
  use kinds, only: dp
  use text_tools, only: integer_text
  use case_definition, only: case_t
  use case_schema, only: find_group
  use case_values, only: case_values_t
  use train_case, only: full_cylinder, number_throws, most_cylinders, most_rings
  use train_builder, only: least_inertia
  implicit none
  private
  public :: check_train

contains

  !> Note the errors of cylinders, crankshaft and dampers.
  subroutine check_train(c, values)
    type(case_t), intent(in) :: c
    type(case_values_t), intent(inout) :: values
    character(len=10) :: cylinder(most_cylinders), damper(most_rings)   ! names of their groups
    integer :: n_cylinders, n_dampers, i

    call find_groups(values, 'cylinder', n_cylinders, cylinder)
    call find_groups(values, 'damper', n_dampers, damper)
    if (values%problems%concerns('crankshaft')) return
    call check_keys(c, values, n_cylinders)
    if (values%problems%concerns('crankshaft')) return
    if (allocated(c%shaft)) call check_lists(c, values)
    do i = 1, n_dampers
      call check_damper(c, values, i, trim(damper(i)))
    end do
    if (values%problems%concerns('crankshaft')) return
    if (n_cylinders > 0) then
      if (n_cylinders < size(c%cylinders)) return   ! a number is left out
      call check_cylinders(c, values, cylinder(:n_cylinders))
    end if
    if (values%problems%concerns('mechanism') .or. any([(values%problems%concerns(trim(cylinder(i))), i=1, n_cylinders)])) return
    if (allocated(c%shaft) .and. .not. values%problems%concerns('crankshaft')) call check_inertias(c, values)
  end subroutine check_train

  !> The groups of a name that the case has; they must be numbered without a gap.
  subroutine find_groups(values, name, n, groups)
    type(case_values_t), intent(inout) :: values
    character(len=*), intent(in) :: name
    integer, intent(out) :: n
    character(len=*), intent(out) :: groups(:)
    integer :: k
    n = 0
    groups = ''
    do k = 1, size(groups)
      if (find_group(values%groups, name//'_'//integer_text(k)) == 0) return
      if (.not. values%is_present(find_group(values%groups, name//'_'//integer_text(k)))) cycle
      n = n + 1
      groups(n) = name//'_'//integer_text(k)
      if (k > n) call values%refuse(trim(groups(n)), 'station', 'there is no '//name//'_'//integer_text(n)//' before it', &
        unit='')
      if (k > n) return
    end do
  end subroutine find_groups

  !> Check that the shaft is given by the keys of a flywheel or by lists.
  subroutine check_keys(c, values, n_cylinders)
    type(case_t), intent(in) :: c
    type(case_values_t), intent(inout) :: values
    integer, intent(in) :: n_cylinders
    character(len=*), parameter :: both = 'must not be given together with the list '
    character(len=*), parameter :: flywheel(3) = [character(len=19) :: 'flywheel_inertia', 'torsional_stiffness', &
      'torsional_damping']
    character(len=*), parameter :: lists(7) = [character(len=22) :: 'damping', 'absolute_damping', 'absolute_damping_speed', &
      'loss_factor', 'loss_frequency', 'drive_station', 'stiffness']
    integer :: k
    if (allocated(c%shaft)) then
      do k = 1, size(flywheel)
        call values%forbid(values%is_said(values%place_of('crankshaft', trim(flywheel(k)))), 'crankshaft', trim(flywheel(k)), &
          both//'inertia')
      end do
      if (.not. any(c%shaft%inertia(:c%shaft%n_inertia) > 0)) call values%refuse('crankshaft', 'inertia', &
        'required with the list stiffness: one inertia for each station', unit='')
    else if (allocated(c%crankshaft)) then
      call values%demand(c%crankshaft%flywheel_inertia > 0, 'crankshaft', 'flywheel_inertia', &
        'or the lists inertia and stiffness')
      if (c%crankshaft%flywheel_inertia > 0) &
        call values%demand(c%crankshaft%stiffness > 0, 'crankshaft', 'torsional_stiffness', '')
      do k = 1, size(lists)
        call values%forbid(values%is_said(values%place_of('crankshaft', trim(lists(k)))), 'crankshaft', trim(lists(k)), &
          'needs the lists inertia and stiffness')
      end do
      if (n_cylinders > 1) call values%refuse('crankshaft', 'flywheel_inertia', 'needs one cylinder: with several give the '// &
        'lists inertia and stiffness', unit='')
    end if
  end subroutine check_keys

  !> Check the lengths of the lists.
  subroutine check_lists(c, values)
    type(case_t), intent(in) :: c
    type(case_values_t), intent(inout) :: values
    associate (shaft => c%shaft, n => c%shaft%n_inertia)
      call values%forbid(n < 2, 'crankshaft', 'inertia', 'must have 2 to 16 values, one for each station')
      if (n < 2) return
      call values%demand(all(shaft%stiffness(:shaft%n_stiffness) > 0), 'crankshaft', 'stiffness', 'with the list inertia')
      call check_length(c, values, 'stiffness', shaft%n_stiffness, n - 1)
      call check_length(c, values, 'damping', shaft%n_damping, n - 1)
      call check_length(c, values, 'absolute_damping', shaft%n_absolute, n)
      call check_length(c, values, 'loss_factor', shaft%n_loss, n - 1)
      call values%demand(shaft%loss_frequency > 0 .or. .not. any(shaft%loss_factor(:shaft%n_loss) > 0), 'crankshaft', &
        'loss_frequency', 'with loss_factor')
      call values%forbid(shaft%drive_station > n, 'crankshaft', 'drive_station', 'must be <= '//integer_text(n)// &
        ', the number of stations')
    end associate
  end subroutine check_lists

  !> Check that a list has one value for each place, or one for all.
  subroutine check_length(c, values, key, given, wanted)
    type(case_t), intent(in) :: c
    type(case_values_t), intent(inout) :: values
    character(len=*), intent(in) :: key
    integer, intent(in) :: given, wanted
    call values%forbid(given /= 1 .and. given /= wanted, 'crankshaft', key, 'must have '//integer_text(wanted)// &
      ' values or one, not '//integer_text(given)//', with '//integer_text(c%shaft%n_inertia)//' stations')
  end subroutine check_length

  !> Check the keys of a damper.
  subroutine check_damper(c, values, k, group)
    type(case_t), intent(in) :: c
    type(case_values_t), intent(inout) :: values
    integer, intent(in) :: k
    character(len=*), intent(in) :: group
    if (values%problems%concerns(group)) return
    associate (it => c%dampers(k))
      if (.not. allocated(c%shaft)) then
        call values%refuse(group, 'station', 'needs the lists inertia and stiffness of &crankshaft')
        return
      end if
      call values%forbid(it%station > c%shaft%n_inertia, group, 'station', 'must be <= '//integer_text(c%shaft%n_inertia)// &
        ', the number of stations')
      if (it%kind == 'viscous') then
        call values%forbid(it%stiffness > 0, group, 'stiffness', 'is for kind = ''rubber'' alone')
        call values%forbid(it%loss_factor > 0, group, 'loss_factor', 'is for kind = ''rubber'' alone')
        if (.not. values%is_given(group, 'damping')) call values%refuse(group, 'damping', 'required with kind = ''viscous''')
      else
        call values%demand(it%stiffness > 0, group, 'stiffness', 'with kind = ''rubber''')
        call values%demand(it%loss_frequency > 0 .or. .not. it%loss_factor > 0, group, 'loss_frequency', 'with loss_factor')
      end if
    end associate
  end subroutine check_damper

  !> Check throws, stations and bodies of the cylinders.
  subroutine check_cylinders(c, values, cylinder)
    type(case_t), intent(in) :: c
    type(case_values_t), intent(inout) :: values
    character(len=*), intent(in) :: cylinder(:)   !! names of their groups
    integer :: throw(size(cylinder)), full, k, j
    logical :: has_crank(size(cylinder))
    character(len=:), allocatable :: group
    full = full_cylinder(c%cylinders)
    call number_throws(c%cylinders, throw, has_crank)
    do k = 1, size(cylinder)
      group = trim(cylinder(k))
      associate (it => c%cylinders(k))
        if (values%problems%concerns(group)) cycle
        call values%forbid(it%full .and. k /= full, group, 'full', 'must be .true. in one cylinder alone')
        if (allocated(c%shaft)) then
          call values%demand(it%station > 0, group, 'station', 'with lists in &crankshaft')
          call values%forbid(it%station > c%shaft%n_inertia, group, 'station', 'must be <= '// &
            integer_text(c%shaft%n_inertia)//', the number of stations')
        else
          call values%forbid(it%station > 0, group, 'station', 'needs the lists inertia and stiffness of &crankshaft')
          if (it%station > 0) return
        end if
        j = findloc(throw(:k - 1), throw(k), 1)
        if (j > 0) call values%forbid(it%station /= c%cylinders(j)%station, group, 'throw', 'is that of cylinder_'// &
          integer_text(j)//': both must have one station')
        if (.not. any(throw == max(1, throw(k) - 1))) call values%refuse(group, 'throw', 'throws must be numbered from 1 '// &
          'without a gap: there is no throw '//integer_text(throw(k) - 1))
        call values%forbid(abs(it%heat_scale - 1) > 0 .and. has_no_heat(c), group, 'heat_scale', &
          'is a factor on the heat of an engine: a compressor or a measured pressure has none')
        call values%forbid(abs(it%pressure_scale - 1) > 0 .and. allocated(c%charge), group, 'pressure_scale', &
          'must be 1 with &working_gas, whose pressure follows from its mass: heat_scale changes the heat')
        call check_bodies(c, values, k, group, k == full, has_crank(k))
      end associate
    end do
  end subroutine check_cylinders

  !> Check that every station has an inertia at every angle of the shaft.
  subroutine check_inertias(c, values)
    type(case_t), intent(in) :: c
    type(case_values_t), intent(inout) :: values
    integer :: j
    do j = 1, c%shaft%n_inertia
      if (least_inertia(c, j) > 0) cycle
      call values%refuse('crankshaft', 'inertia', 'must be > 0 for a station on which no cylinder has inertia at all angles', &
        j, '')
      return
    end do
  end subroutine check_inertias

  !> Whether the gas is that of a compressor or measured.
  pure logical function has_no_heat(c)
    type(case_t), intent(in) :: c
    has_no_heat = allocated(c%measured)
    if (allocated(c%combustion)) has_no_heat = c%combustion%filling_pressure() > 0
  end function has_no_heat

  !> Check that a full cylinder has the bodies of the mechanism, and that a crank is given once for each throw.
  subroutine check_bodies(c, values, k, group, is_full, has_crank)
    type(case_t), intent(in) :: c
    type(case_values_t), intent(inout) :: values
    integer, intent(in) :: k
    character(len=*), intent(in) :: group
    logical, intent(in) :: is_full, has_crank
    associate (it => c%cylinders(k), m => c%mechanism)
      if (is_full) then
        call must_be_equal('piston_mass', [it%piston_mass], [m%piston_mass])
        call must_be_equal('rod_mass', [it%rod_mass], [m%rod_mass])
        call must_be_equal('rod_inertia', [it%rod_inertia], [m%rod_inertia])
        call must_be_equal('rod_com', it%rod_com, m%rod_com)
        call must_be_equal('crank_mass', [it%crank_mass], [m%crank_mass])
        call must_be_equal('crank_inertia', [it%crank_inertia], [m%crank_inertia])
        call must_be_equal('crank_com', it%crank_com, m%crank_com)
      else if (.not. has_crank) then
        call values%forbid(it%crank_mass > 0, group, 'crank_mass', 'must be 0: another cylinder has the crank of this throw')
        call values%forbid(it%crank_inertia > 0, group, 'crank_inertia', &
          'must be 0: another cylinder has the crank of this throw')
      end if
    end associate

  contains

    subroutine must_be_equal(key, own, shared)
      character(len=*), intent(in) :: key
      real(dp), intent(in) :: own(:), shared(:)
      call values%forbid(any(abs(own - shared) > 0), group, key, &
        'must be that of &mechanism: this is the full cylinder, which all other groups describe')
    end subroutine must_be_equal
  end subroutine check_bodies
end module train_rules
