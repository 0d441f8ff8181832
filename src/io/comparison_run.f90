!> A run in memory, for comparison with other runs of the same case: its rows, impacts, revolutions and results.
module comparison_run
  use kinds, only: dp
  use error_handling, only: error_t, fail, status_integration
  use joint_places, only: n_places, in_order, name_prefix
  use joint_case, only: joint_case_t
  use case_definition, only: case_t
  use cycle_statistics, only: cycle_t
  use cycle_watch, only: cycle_watch_t
  use trace_columns, only: column_list_t
  use scene_problem, only: event_contact_begins
  use simulation, only: run_t, run_report_t
  use whole_run, only: go_to_end
  use row_store, only: row_store_t
  use run_figures, only: run_figures_t
  use trace_sink, only: trace_event_t
  implicit none
  private
  public :: comparison_run_t, run, has_coarse_table, means_of, has_figures, figures_of, name_figure, n_statistics, &
    statistic_names, n_figures, loss_figure

  integer, parameter :: n_statistics = 4
  character(len=*), parameter :: statistic_names(n_statistics) = [character(len=23) :: 'mean_pin_force', 'contact_time_fraction', &
    'impacts_per_revolution', 'loss_per_revolution']

  !> Results of the whole run, as in the summary: some for each place, in order, the mean crank speed, volumes of wear for each
  !> place, and a mean over whole revolutions.
  integer, parameter :: n_figures = 5*n_places + 2, speed_figure = 3*n_places + 1, loss_figure = n_figures
  character(len=*), parameter :: of_place(3) = [character(len=21) :: 'max_pin_force', 'contact_time_fraction', 'min_film_thickness']
  character(len=*), parameter :: of_wear(2) = [character(len=16) :: 'worn_volume_pin', 'worn_volume_bore']

  !> One run.
  type :: comparison_run_t
    real(dp), allocatable :: values(:, :)              !! (columns, rows)
    type(trace_event_t), allocatable :: impact(:)      !! contacts that begin
    type(cycle_watch_t), allocatable :: cycles
    type(run_figures_t) :: figures
    real(dp) :: worn(2, n_places) = 0                  !! volumes of pin and bore, by place [m^3]
    logical :: is_done = .false.
  end type comparison_run_t

contains

  !> Run a case, whose films have their tables, in memory. `is_done` is false if it does not reach its end, or needs more than
  !> `most_evaluations` (0: no limit).
  subroutine run(case, list, most_evaluations, comparison, error)
    type(case_t), intent(in) :: case
    type(column_list_t), intent(in) :: list
    integer, intent(in) :: most_evaluations
    type(comparison_run_t), intent(out) :: comparison
    type(error_t), allocatable, intent(out) :: error   !! the user interrupted
    type(error_t), allocatable :: failure
    type(run_t) :: own
    type(run_report_t) :: report
    type(case_t) :: limited
    type(row_store_t) :: sink
    type(trace_event_t), allocatable :: event(:)
    logical :: was_interrupted
    integer :: i
    limited = case
    limited%output%answers = .false.
    if (most_evaluations > 0) limited%integrator%max_evaluations = min(limited%integrator%max_evaluations, most_evaluations)
    if (case%has_play()) then   ! without clearance the integrals of the joint would change the steps
      allocate (comparison%cycles)
      comparison%cycles%keeps_cycles = .true.
    end if
    call own%begin(limited, .false., list, sink, failure, comparison%cycles)
    if (.not. allocated(failure)) then
      call go_to_end(own, was_interrupted)
      if (was_interrupted) call fail(error, 'interrupted before it was certified', status_integration)
      call own%finish(report, failure, comparison%cycles)
    end if
    comparison%is_done = .not. allocated(failure)
    comparison%figures = report%figures
    if (allocated(report%wear)) then
      do i = 1, size(report%wear)
        comparison%worn(:, report%wear(i)%place) = sum(report%wear(i)%volume, 1)
      end do
    end if
    call sink%hand_over(size(list%id), comparison%values, event)
    comparison%impact = pack(event, event%kind == event_contact_begins)
  end subroutine run

  !> Whether a tighter tolerance would give a finer table of a film of the case.
  logical function has_coarse_table(case, tolerance)
    type(case_t), intent(in) :: case
    real(dp), intent(in) :: tolerance   !! the tighter one
    integer :: i
    has_coarse_table = .false.
    do i = 1, n_places
      call look_at(case%joints(i))
    end do

  contains

    subroutine look_at(joint)
      type(joint_case_t), intent(in) :: joint
      character(len=:), allocatable :: own, finer
      if (.not. (allocated(joint%film) .and. joint%has_clearance())) return
      own = joint%film%table_key(joint%bearing(case%mechanism%rod_length), case%integrator%relative_tolerance)
      finer = joint%film%table_key(joint%bearing(case%mechanism%rod_length), tolerance)
      if (finer /= own) has_coarse_table = .true.
    end subroutine look_at
  end function has_coarse_table

  !> Name and unit of a result.
  pure subroutine name_figure(i, name, unit)
    integer, intent(in) :: i
    character(len=:), allocatable, intent(out) :: name, unit
    character(len=1), parameter :: units(3) = ['N', '1', 'm']   ! of `of_place`
    integer :: k
    if (i < speed_figure) then
      k = mod(i - 1, 3) + 1
      name = name_prefix(in_order((i - k)/3 + 1))//trim(of_place(k))
      unit = units(k)
    else if (i == speed_figure) then
      name = 'mean_crank_speed'
      unit = 'rad/s'
    else if (i < loss_figure) then
      k = mod(i - speed_figure - 1, 2) + 1
      name = name_prefix(in_order((i - speed_figure - k)/2 + 1))//trim(of_wear(k))
      unit = 'm3'
    else
      name = 'loss_per_revolution'
      unit = 'J'
    end if
  end subroutine name_figure

  !> Results of a run; 0 for results that it does not have.
  pure function figures_of(comparison) result(values)
    type(comparison_run_t), intent(in) :: comparison
    real(dp) :: values(n_figures)
    integer :: i
    values = 0
    if (.not. comparison%figures%time > 0) return
    associate (f => comparison%figures)
      do i = 1, n_places
        associate (pin => f%pin(in_order(i)))
          values(3*i - 2:3*i) = [pin%max_force, pin%contact_time/f%time, pin%min_film_thickness]
        end associate
        values(speed_figure + 2*i - 1:speed_figure + 2*i) = comparison%worn(:, in_order(i))
      end do
      values(speed_figure) = f%crank_travel/f%time
    end associate
    if (.not. allocated(comparison%cycles)) return
    associate (s => comparison%cycles%statistics)
      if (s%cycles > 0) values(loss_figure) = s%total%dissipated_energy/s%cycles
    end associate
  end function figures_of

  !> The results that a run of a case has, but that of whole revolutions.
  pure function has_figures(case, comparison) result(has)
    type(case_t), intent(in) :: case
    type(comparison_run_t), intent(in) :: comparison
    logical :: has(n_figures)
    integer :: i
    has = .false.
    do i = 1, n_places
      associate (joint => case%joints(in_order(i)))
        has(3*i - 2:3*i) = joint%has_clearance()
        has(speed_figure + 2*i - 1:speed_figure + 2*i) = allocated(joint%wear) .and. joint%has_clearance() &
          .and. case%output%window == 'all'
      end associate
    end do
    has(1) = .true.
    has(speed_figure) = comparison%figures%time > 0
  end function has_figures

  !> Statistics of some revolutions, of all pins; the force is that of the first one.
  pure function means_of(cycles) result(means)
    type(cycle_t), intent(in) :: cycles(:)
    real(dp) :: means(n_statistics), duration, contact_time(size(cycles)), impacts(size(cycles))
    integer :: i
    duration = sum(cycles%duration)
    contact_time = 0
    impacts = 0
    do i = 1, n_places
      contact_time = contact_time + cycles%pin(i)%contact_time
      impacts = impacts + cycles%pin(i)%impacts
    end do
    means = [sum(cycles%pin(in_order(1))%force_integral/duration), sum(contact_time/duration), sum(impacts/size(cycles)), &
      sum(cycles%dissipated_energy/size(cycles))]
  end function means_of
end module comparison_run
