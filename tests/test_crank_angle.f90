!> Rows at equal crank angles: they are exactly at these angles, none is missing even if the crank turns back, and their values are
!> those of the integrator's steps.
module test_crank_angle
  use kinds, only: dp
  use constants, only: two_pi, degree
  use checks, only: checks_t
  use collecting_sink, only: trace_t, run_case, column
  implicit none
  private
  public :: run_test_crank_angle

  integer, parameter :: long = 60
  character(len=long), parameter :: by_angle = 'output.sampling=crank_angle'

contains

  subroutine run_test_crank_angle(check)
    class(checks_t), intent(inout) :: check
    call rows_are_at_their_angles(check)
    call values_are_those_between_steps(check)
    call a_crank_that_turns_back(check)
    call the_end_has_its_row(check)
  end subroutine run_test_crank_angle

  !> Every row is at an angle of the grid within 1e-12 rad and one angle after the row before it; also in the ideal twin.
  subroutine rows_are_at_their_angles(check)
    class(checks_t), intent(inout) :: check
    character(len=8), parameter :: methods(3) = [character(len=8) :: 'auto', 'adams', 'radau']
    character(len=40), parameter :: files(3) = [character(len=40) :: 'cases/sim_I_oscillating.nml', &
      'cases/flores/dry_0500um.nml', 'cases/sim_IV.nml']
    character(len=long) :: speed
    type(trace_t) :: trace
    integer :: i, k
    do i = 1, size(files)
      do k = 1, size(methods)
        speed = 'initial.crank_speed=250'
        if (k == 2) speed = 'initial.crank_speed=-250'   ! the angles decrease
        trace = run_case(trim(files(i)), [character(len=long) :: by_angle, 'output.angle_origin_deg=7', &
          'output.samples_per_revolution=50', 'integrator.revolutions=1.5', 'initial.crank_angle_deg=7', &
          'integrator.method='//methods(k), speed], ideal_joint=(k == 3 .and. i /= 2))
        call check%that(.not. allocated(trace%error), trim(files(i))//': runs')
        call steps_through_grid(check, trace, 7*degree, 50, trim(files(i))//' '//methods(k))
        call check%that(size(trace%values, 2) > 40, trim(files(i))//': there are rows for the whole run')
        call check%that(.not. abs(trace%values(1, 1)) > 0, trim(files(i))//': the first row is at the start')
      end do
    end do
    trace = run_case('cases/sim_I.nml', [character(len=long) :: by_angle, 'output.angle_origin_deg=1', &
      'output.samples_per_revolution=4', 'integrator.revolutions=2', 'output.start_time=5e-3'])
    call steps_through_grid(check, trace, degree, 4, 'from start_time on')
    call check%that(trace%values(1, 1) >= 5e-3_dp .and. trace%values(1, 1) < 5e-3_dp + 7e-3_dp, 'the first row after start_time')
  end subroutine rows_are_at_their_angles

  !> All rows are at angles of the grid, each next to the one before.
  subroutine steps_through_grid(check, trace, origin, per_revolution, what)
    class(checks_t), intent(inout) :: check
    type(trace_t), intent(in) :: trace
    real(dp), intent(in) :: origin   !! [rad]
    integer, intent(in) :: per_revolution
    character(len=*), intent(in) :: what
    real(dp) :: place(size(trace%values, 2))
    integer :: n
    n = size(place)
    place = (trace%values(column(trace, 'crank_angle[rad]'), :) - origin)/two_pi*per_revolution
    call check%that(maxval(abs(place - anint(place)))*two_pi/per_revolution <= 1e-12_dp, what//': rows are at their angles')
    call check%that(all(nint(abs(place(2:) - place(:n - 1))) == 1), what//': no angle is missing')
  end subroutine steps_through_grid

  !> The steps of the integrator are so short that a parabola through angle, speed and acceleration gives the time at which the
  !> crank reaches an angle, and linear interpolation gives the values at that time.
  subroutine values_are_those_between_steps(check)
    class(checks_t), intent(inout) :: check
    character(len=long), parameter :: common(4) = [character(len=long) :: 'integrator.revolutions=0.3', &
      'integrator.max_step=2e-6', 'integrator.relative_tolerance=1e-9', 'output.samples_per_revolution=90']
    character(len=24), parameter :: names(4) = [character(len=24) :: 'time[s]', 'piston_position[m]', 'eccentricity_x[m]', &
      'crank_speed[rad/s]']
    type(trace_t) :: rows, steps
    real(dp) :: part, value, size_of
    integer :: i, k, j, angle, c
    rows = run_case('cases/sim_I.nml', [common, by_angle])
    steps = run_case('cases/sim_I.nml', [character(len=long) :: common, 'output.every_step=T'])
    angle = column(rows, 'crank_angle[rad]')
    call check%that(size(rows%values, 2) > 20, 'there are rows to compare')
    call check%that(size(steps%values, 2) == steps%report%statistics%accepted + 1, &
      'every_step: the start and each step, no other rows')
    j = 2
    do i = 2, size(rows%values, 2)
      do while (steps%values(angle, j) < rows%values(angle, i) .and. j < size(steps%values, 2))
        j = j + 1
      end do
      part = (rows%values(angle, i) - steps%values(angle, j - 1))/(steps%values(angle, j) - steps%values(angle, j - 1))
      do k = 1, size(names)
        c = column(rows, trim(names(k)))
        size_of = maxval(abs(steps%values(c, :)))
        value = steps%values(c, j - 1) + part*(steps%values(c, j) - steps%values(c, j - 1))
        call check%close_to(rows%values(c, i), value, 1e-6_dp*size_of, trim(names(k))//' in a row between the steps')
      end do
    end do
  end subroutine values_are_those_between_steps

  !> A crank that swings from 30 degrees to the other side and back passes as many angles as its fine trace, in both directions.
  subroutine a_crank_that_turns_back(check)
    class(checks_t), intent(inout) :: check
    character(len=long), parameter :: common(3) = [character(len=long) :: 'integrator.revolutions=0', 'integrator.end_time=3', &
      'drive.kind=free']
    character(len=8), parameter :: starts(2) = [character(len=8) :: '30', '31.3']
    ! from rest at 30 degrees it would turn back at 330, an angle with a row, which it reaches or not by rounding
    character(len=long), parameter :: speeds(2) = [character(len=long) :: 'initial.crank_speed=1', 'initial.crank_speed=0']
    type(trace_t) :: rows, fine
    real(dp), allocatable :: place(:)
    integer, allocatable :: cell(:)
    integer :: i, angle, n
    do i = 1, size(starts)
      rows = run_case('cases/sim_I.nml', [character(len=long) :: common, speeds(i), by_angle, 'output.angle_origin_deg=30', &
        'output.samples_per_revolution=36', 'initial.crank_angle_deg='//starts(i)], ideal_joint=.true.)
      fine = run_case('cases/sim_I.nml', [character(len=long) :: common, speeds(i), 'output.interval=1e-4', &
        'initial.crank_angle_deg='//starts(i)], ideal_joint=.true.)
      angle = column(fine, 'crank_angle[rad]')
      if (allocated(cell)) deallocate (cell)
      allocate (cell(size(fine%values, 2)))
      cell(:) = floor((fine%values(angle, :) - 30*degree)/(10*degree) + 1e-9_dp)   ! rounding of the start
      n = size(cell)
      n = sum(abs(cell(2:) - cell(:n - 1)))
      if (i == 1) n = n + 1   ! the start is at an angle of the grid
      call check%that(size(rows%values, 2) == n, 'a row at each passage, from '//starts(i))
      n = size(rows%values, 2)
      if (allocated(place)) deallocate (place)
      allocate (place(n))
      place(:) = (rows%values(angle, :) - 30*degree)/(10*degree)
      call check%that(maxval(abs(place - anint(place)))*10*degree <= 1e-12_dp, 'rows are at the angles, from '//starts(i))
      call check%that(count(nint(place(2:) - place(:n - 1)) == 0) >= 2, 'the crank turns back, from '//starts(i))
      call check%that(all(rows%values(1, 2:) > rows%values(1, :n - 1)), 'time increases, from '//starts(i))
    end do
  end subroutine a_crank_that_turns_back

  !> A run that ends at an angle of the grid has a row there, in whichever way its end is found.
  subroutine the_end_has_its_row(check)
    class(checks_t), intent(inout) :: check
    type(trace_t) :: trace
    integer :: angle
    trace = run_case('cases/flores/dry_0100um.nml', [character(len=long) :: by_angle, 'integrator.revolutions=0.25', &
      'output.samples_per_revolution=36'])
    call check%that(size(trace%values, 2) == 10, 'constant speed: ten rows in a quarter revolution')
    trace = run_case('cases/sim_I.nml', [character(len=long) :: by_angle, 'integrator.crank_revolutions=0.25', &
      'output.samples_per_revolution=36'])
    call check%that(size(trace%values, 2) == 10, 'free crank: ten rows in a quarter revolution')
    angle = column(trace, 'crank_angle[rad]')
    call check%close_to(trace%values(angle, size(trace%values, 2)) - trace%values(angle, 1), 0.25_dp*two_pi, 1e-12_dp, &
      'the last row is exactly at the end')
  end subroutine the_end_has_its_row
end module test_crank_angle
