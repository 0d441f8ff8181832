!> The certificate of a run: how far its results can be trusted. The case is run again at a hundredth of its tolerance, and once
!> more at that tolerance with another method; the run is compared with both.
!>
!> The error of a row is its difference from the run with the closer tolerance, times a margin for the error of that run itself and
!> for errors between rows. A run is certified up to the time at which the error of any coordinate or speed first exceeds 1e-3 of
!> its range, and not beyond the time at which the run with the other method differs from the closer run by that amount. (The errors
!> themselves are not taken from the run with the other method, which may be the least accurate of the three at equal tolerance.)
!> After that time means over whole revolutions are compared. Results of the whole run, such as largest forces, are compared
!> independently of the certified time.
module certificate
  use kinds, only: dp
  use constants, only: two_pi
  use error_handling, only: error_t
  use case_definition, only: case_t
  use trace_columns, only: column_list_t, choose_columns
  use simulation, only: run_report_t
  use trace_sink, only: trace_event_t
  use film_files, only: provide_tables
  use comparison_run, only: comparison_run_t, run, has_coarse_table, has_figures, figures_of, means_of, n_statistics, n_figures, &
    loss_figure
  use joint_places, only: n_places, name_prefix
  implicit none
  private
  public :: certificate_t, make_certificate, is_state

  real(dp), parameter :: limit = 1e-3_dp              !! error of a certified state, over its range
  real(dp), parameter :: margin = 2.5_dp  !! factor for the error of the closer run (at worst half as large) and for errors between
                                          !! rows
  real(dp), parameter :: closer = 1e-2_dp             !! tolerance of the comparison runs, relative to that of the run
  real(dp), parameter :: finest_tolerance = 1e-13_dp  !! smallest tolerance of the comparison runs
  real(dp), parameter :: finest_table = 9e-9_dp       !! tolerance at which the tables of films have their finest grid
  real(dp), parameter :: loosest_tolerance = 1e-3_dp  !! tolerances above this one count as this one
  integer, parameter :: rows_per_revolution = 10000, fewest_rows = 2000, most_rows = 60000

  !> Columns that are coordinates or speeds, without units and without the prefix of the pin. Of an elastic rod they are its stretch
  !> and its deflection midway; the range of a single shape may be a thousandth of theirs. Bristles are none: their deflection jumps
  !> with a contact, as a force does.
  character(len=*), parameter :: state_names(*) = [character(len=19) :: 'crank_angle', 'rod_angle', 'piston_position', &
    'crank_speed', 'rod_speed', 'piston_velocity', 'eccentricity_x', 'eccentricity_y', 'eccentricity_rate_x', &
    'eccentricity_rate_y', 'film_eccentricity_x', 'film_eccentricity_y', 'piston_offset', 'piston_tilt', &
    'piston_offset_rate', 'piston_tilt_rate', 'rod_stretch', 'rod_mid_deflection', 'crankshaft_twist', 'flywheel_speed']

  type :: certificate_t
    logical :: is_made = .false.
    character(len=:), allocatable :: reason      !! reason for which no certificate could be made
    real(dp) :: until = 0               !! end of the certified part [s]
    logical :: is_whole = .false.       !! the whole run is certified
    real(dp) :: digits = 0              !! correct digits of the states in the certified part, median over time
    real(dp) :: state_error = 0         !! largest error of the states in the certified part, relative to their ranges
    integer :: impacts = 0              !! number of impacts in the certified part
    integer :: impacts_matched = 0      !! number of those that the closer run has too
    logical :: has_other_method = .false.        !! the run with the other method reached the end
    integer :: revolutions_beyond = 0            !! number of whole revolutions after the certified part
    real(dp) :: statistic(n_statistics) = 0      !! means over these revolutions
    real(dp) :: difference(n_statistics) = 0     !! largest difference of the means of the other runs, relative to the mean
    logical :: has_figure(n_figures) = .false.
    real(dp) :: figure(n_figures) = 0            !! results of the whole run
    real(dp) :: figure_difference(n_figures) = 0 !! largest difference of the results of the other runs
    type(column_list_t) :: list
    real(dp), allocatable :: range(:)             !! range of each column over the run
    real(dp), allocatable :: error(:), rms(:)     !! largest and root-mean-square error of each column in the certified part
  end type certificate_t

contains

  !> Certify a completed run, or say why it cannot be certified. Error: the user interrupted (status_integration).
  subroutine make_certificate(case, report, announces, certificate, error)
    type(case_t), intent(in) :: case
    type(run_report_t), intent(in) :: report
    logical, intent(in) :: announces   !! tell the user that a film table is computed
    type(certificate_t), intent(out) :: certificate
    type(error_t), allocatable, intent(out) :: error
    type(case_t) :: plain, close
    type(comparison_run_t) :: own, closer_run, other_run
    real(dp), allocatable :: errors(:)   ! of the states in each row of the run
    integer :: n   ! number of rows that the closer run has too
    integer :: most_evaluations   ! allowed for the run with the other method

    if (case%integrator%relative_tolerance < 10*finest_tolerance) then
      certificate%reason = 'not certified: no tolerance ten times smaller is possible'
      return
    end if
    call prepare(case, report, plain, certificate%list, error)
    if (allocated(error)) return
    call provide_tables(plain, announces, .false., error)
    if (allocated(error)) return
    call run(plain, certificate%list, 0, own, error)
    if (allocated(error)) return
    close = plain
    close%integrator%relative_tolerance = max(finest_tolerance, closer*min(case%integrator%relative_tolerance, loosest_tolerance))
    if (.not. has_coarse_table(case, close%integrator%relative_tolerance)) then   ! the film has the same table at this tolerance
      if (has_coarse_table(close, finest_table)) close%integrator%relative_tolerance = &
        min(close%integrator%relative_tolerance, finest_table)
    end if
    if (case%integrator%absolute_tolerance > 0) &
      close%integrator%absolute_tolerance = max(finest_tolerance, closer*case%integrator%absolute_tolerance)
    call provide_tables(close, announces, .false., error)
    if (allocated(error)) return
    call run(close, certificate%list, 0, closer_run, error)
    if (allocated(error)) return
    if (.not. (own%is_done .and. closer_run%is_done)) then
      certificate%reason = 'not certified: the run at a hundredth of the tolerance could not continue'
      return
    end if
    close%integrator%method = merge('auto ', 'radau', case%integrator%method == 'radau')
    ! a method that is not suitable for the case would need hundreds of times as many evaluations
    most_evaluations = int(min(4*real(report%statistics%evaluations, dp) + 40000, real(huge(most_evaluations), dp)))
    call run(close, certificate%list, most_evaluations, other_run, error)
    if (allocated(error)) return
    certificate%has_other_method = other_run%is_done
    if (.not. other_run%is_done) other_run = closer_run   ! which then differs from itself in nothing
    call find_errors()
    call find_end()
    if (certificate%is_whole) certificate%until = report%figures%time   ! the remainder is shorter than one row
    call find_column_errors()
    call match_impacts()
    call compare_statistics()
    call compare_figures()
    certificate%is_made = .true.

  contains

    !> Error of the states in each row, relative to their ranges.
    subroutine find_errors()
      real(dp) :: doubt
      integer :: c, i
      associate (a => own%values, b => closer_run%values)
        certificate%range = maxval(a, 2) - minval(a, 2)
        n = min(size(a, 2), size(b, 2))
        allocate (errors(size(a, 2)), source=0.0_dp)
        errors(n + 1:) = huge(1.0_dp)
        do c = 1, size(certificate%list%id)
          if (.not. (is_state(certificate%list%names(certificate%list%id(c))) .and. certificate%range(c) > 0)) cycle
          do i = 1, n
            errors(i) = max(errors(i), margin*abs(a(c, i) - b(c, i))/certificate%range(c))
            if (i > size(other_run%values, 2)) cycle
            doubt = abs(other_run%values(c, i) - b(c, i))
            if (doubt > limit*certificate%range(c)) errors(i) = huge(1.0_dp)
          end do
        end do
      end associate
    end subroutine find_errors

    !> Find the time up to which the error of the states is within the limit, and the number of correct digits up to there.
    subroutine find_end()
      integer :: last
      last = findloc(errors(:n) > limit, .true., 1) - 1
      if (last < 0) last = n
      if (last == 0) return
      certificate%until = own%values(1, last)
      certificate%is_whole = last == size(own%values, 2)
      certificate%state_error = maxval(errors(:last))
      certificate%digits = -log10(max(median(errors(:last)), epsilon(1.0_dp)))
    end subroutine find_end

    !> Errors of every column in the certified part.
    subroutine find_column_errors()
      integer :: i, n
      allocate (certificate%error(size(certificate%range)), certificate%rms(size(certificate%range)), source=0.0_dp)
      associate (a => own%values, b => closer_run%values)
        n = count(a(1, :min(size(a, 2), size(b, 2))) <= certificate%until)
        do i = 1, n
          certificate%error = max(certificate%error, margin*abs(a(:, i) - b(:, i)))
          certificate%rms = certificate%rms + (a(:, i) - b(:, i))**2/n
        end do
      end associate
      certificate%rms = sqrt(certificate%rms)
    end subroutine find_column_errors

    !> Count the impacts in the certified part, and those that the closer run has at the same pin and at the same time: within half
    !> the time to the impacts before and after at that pin.
    subroutine match_impacts()
      integer :: pin
      certificate%impacts = count(own%impact%time <= certificate%until)
      do pin = 1, maxval(own%impact%pin)
        certificate%impacts_matched = certificate%impacts_matched + matched(times_at(own%impact, pin), &
          times_at(closer_run%impact, pin), certificate%until)
      end do
    end subroutine match_impacts

    !> Means over the whole revolutions that begin after the certified part, and their differences between the runs.
    subroutine compare_statistics()
      real(dp) :: begins
      integer :: first, last
      if (certificate%is_whole .or. .not. allocated(own%cycles)) return
      first = 1
      begins = 0
      last = min(own%cycles%statistics%cycles, closer_run%cycles%statistics%cycles, other_run%cycles%statistics%cycles)
      do while (first <= last .and. begins < certificate%until)
        begins = begins + own%cycles%cycles(first)%duration
        first = first + 1
      end do
      certificate%revolutions_beyond = max(0, last - first + 1)
      if (certificate%revolutions_beyond == 0) return
      certificate%statistic = means_of(own%cycles%cycles(first:last))
      certificate%difference = max(relative(means_of(closer_run%cycles%cycles(first:last)), certificate%statistic), &
        relative(means_of(other_run%cycles%cycles(first:last)), certificate%statistic))
    end subroutine compare_statistics

    !> Differences between the results of the runs.
    subroutine compare_figures()
      certificate%has_figure = has_figures(case, own)
      if (allocated(own%cycles)) certificate%has_figure(loss_figure) = min(own%cycles%statistics%cycles, &
        closer_run%cycles%statistics%cycles) > 0
      certificate%figure = figures_of(own)
      certificate%figure_difference = max(abs(figures_of(closer_run) - certificate%figure), &
        abs(figures_of(other_run) - certificate%figure))
    end subroutine compare_figures
  end subroutine make_certificate

  !> The case in the form in which all three runs carry it out: all columns, rows of its own, and the end of the run.
  subroutine prepare(case, report, plain, list, error)
    type(case_t), intent(in) :: case
    type(run_report_t), intent(in) :: report
    type(case_t), intent(out) :: plain
    type(column_list_t), intent(out) :: list
    type(error_t), allocatable, intent(out) :: error
    real(dp) :: speed
    integer :: i
    plain = case
    plain%output%sampling = 'time'
    plain%output%columns = 'standard'
    plain%output%window = 'all'
    plain%output%film_times = ''
    if (report%periods%is_on) then
      plain%run%until = 'end'
      plain%integrator%revolutions = 0
      plain%integrator%crank_revolutions = 0
      plain%integrator%end_time = report%figures%time
    end if
    call choose_columns(plain, .false., list, error)
    do i = 1, n_places   ! the files that the user names are not written again
      if (allocated(plain%joints(i)%film)) plain%joints(i)%film%table_file = ''
    end do
    plain%run%lyapunov_revolutions = 0
    plain%output%start_time = 0
    plain%output%every_step = .false.
    speed = max(abs(case%initial%crank_speed), abs(report%figures%crank_travel)/max(report%figures%time, tiny(1.0_dp)))
    plain%output%interval = report%figures%time/fewest_rows
    if (speed > 0) plain%output%interval = min(plain%output%interval, two_pi/(speed*rows_per_revolution))
    plain%output%interval = max(plain%output%interval, report%figures%time/most_rows)
  end subroutine prepare

  !> Whether a column is a coordinate or a speed.
  pure logical function is_state(name)
    character(len=*), intent(in) :: name
    integer :: i
    associate (quantity => name(:index(name, '[') - 1))
      is_state = .false.
      do i = 1, n_places
        is_state = is_state .or. any(quantity == name_prefix(i)//state_names)
      end do
    end associate
  end function is_state

  !> Differences of means relative to the larger ones; 0 where both are 0.
  pure elemental real(dp) function relative(other, own)
    real(dp), intent(in) :: other, own
    relative = 0
    if (abs(own) > 0 .or. abs(other) > 0) relative = abs(other - own)/max(abs(own), abs(other))
  end function relative

  !> Median, by bisection on the logarithm.
  pure real(dp) function median(values)
    real(dp), intent(in) :: values(:)
    real(dp) :: low, high
    integer :: i
    low = -40
    high = 0
    do i = 1, 50
      if (2*count(values <= 10**(0.5_dp*(low + high))) >= size(values)) then
        high = 0.5_dp*(low + high)
      else
        low = 0.5_dp*(low + high)
      end if
    end do
    median = 10**high
  end function median

  !> Times of the impacts at one pin.
  pure function times_at(impact, pin) result(times)
    type(trace_event_t), intent(in) :: impact(:)
    integer, intent(in) :: pin
    real(dp), allocatable :: times(:)
    integer :: i
    times = pack([(impact(i)%time, i=1, size(impact))], impact%pin == pin)
  end function times_at

  !> Number of times up to `until` that agree with one of the other run's times. Both lists are in rising order.
  pure integer function matched(times, others, until)
    real(dp), intent(in) :: times(:), others(:), until
    real(dp) :: gap
    integer :: i, nearest
    matched = 0
    if (size(others) == 0) return
    nearest = 1
    do i = 1, size(times)
      if (times(i) > until) exit
      gap = until
      if (i > 1) gap = times(i) - times(max(i - 1, 1))
      if (i < size(times)) gap = min(gap, times(min(i + 1, size(times))) - times(i))
      do while (nearest < size(others))
        if (abs(others(nearest + 1) - times(i)) >= abs(others(nearest) - times(i))) exit
        nearest = nearest + 1
      end do
      if (abs(others(nearest) - times(i)) < 0.5_dp*gap) matched = matched + 1
    end do
  end function matched
end module certificate
