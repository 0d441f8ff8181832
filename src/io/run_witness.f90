!> A run in memory, for comparison with other runs of the same case: its rows, impacts, revolutions and results.
module run_witness
  use gudgeon_kinds, only: dp
  use gudgeon_errors, only: error_t, fail, status_integration
  use case_definition, only: case_t, joint_case_t
  use chain_motion, only: piston_pin, crank_pin
  use cycle_statistics, only: cycle_t
  use cycle_watch, only: cycle_watch_t
  use gudgeon_columns, only: column_list_t
  use gudgeon_scene, only: event_contact_begins
  use gudgeon_simulation, only: run_t, run_report_t
  use patient_run, only: go_to_end
  use row_store, only: row_store_t
  use run_figures, only: run_figures_t
  use trace_sink, only: trace_event_t
  use wear_record, only: wear_profile_t
  implicit none
  private
  public :: witness_t, run, has_coarse_table, means_of, figures_of, n_statistics, statistic_names, &
    n_figures, figure_names, loss_figure

  integer, parameter :: n_statistics = 4
  character(len=*), parameter :: statistic_names(n_statistics) = [character(len=23) :: 'mean_pin_force', 'contact_time_fraction', &
    'impacts_per_revolution', 'loss_per_revolution']

  !> Results of the whole run, with their names in the summary; wear is in four of them, and the last one is a mean over whole
  !> revolutions.
  integer, parameter :: n_figures = 12, wear_figures = 8, loss_figure = 12
  character(len=*), parameter :: figure_names(n_figures) = [character(len=31) :: 'max_pin_force', 'contact_time_fraction', &
    'min_film_thickness', 'crank_pin_max_pin_force', 'crank_pin_contact_time_fraction', 'crank_pin_min_film_thickness', &
    'mean_crank_speed', 'worn_volume_pin', 'worn_volume_bore', 'crank_pin_worn_volume_pin', 'crank_pin_worn_volume_bore', &
    'loss_per_revolution']

  !> One run.
  type :: witness_t
    real(dp), allocatable :: values(:, :)              !! (columns, rows)
    type(trace_event_t), allocatable :: impact(:)      !! contacts that begin
    type(cycle_watch_t), allocatable :: cycles
    type(run_figures_t) :: figures
    real(dp) :: worn(4) = 0                            !! volumes of pin and bore, at the piston pin and at the crank pin [m^3]
    logical :: is_done = .false.
  end type witness_t

contains

  !> Run a case, whose films have their tables, in memory. `is_done` is false if it does not reach its end, or needs more than
  !> `most_evaluations` (0: no limit).
  subroutine run(case, list, most_evaluations, witness, error)
    type(case_t), intent(in) :: case
    type(column_list_t), intent(in) :: list
    integer, intent(in) :: most_evaluations
    type(witness_t), intent(out) :: witness
    type(error_t), allocatable, intent(out) :: error   !! the user interrupted
    type(error_t), allocatable :: failure
    type(run_t) :: own
    type(run_report_t) :: report
    type(case_t) :: limited
    type(row_store_t) :: sink
    type(trace_event_t), allocatable :: event(:)
    logical :: was_interrupted
    limited = case
    if (most_evaluations > 0) limited%integrator%max_evaluations = min(limited%integrator%max_evaluations, most_evaluations)
    if (case%has_play()) then   ! without clearance the integrals of the joint would change the steps
      allocate (witness%cycles)
      witness%cycles%keeps_cycles = .true.
    end if
    call own%begin(limited, .false., list, sink, failure, witness%cycles)
    if (.not. allocated(failure)) then
      call go_to_end(own, was_interrupted)
      if (was_interrupted) call fail(error, 'interrupted before it was certified', status_integration)
      call own%finish(report, failure, witness%cycles)
    end if
    witness%is_done = .not. allocated(failure)
    witness%figures = report%figures
    if (allocated(report%wear)) call take_wear(report%wear, witness%worn)
    call sink%hand_over(size(list%id), witness%values, event)
    witness%impact = pack(event, event%kind == event_contact_begins)
  end subroutine run

  pure subroutine take_wear(wear, worn)
    type(wear_profile_t), intent(in) :: wear(:)
    real(dp), intent(inout) :: worn(:)
    integer :: i, first
    do i = 1, size(wear)
      first = merge(1, 3, wear(i)%place == piston_pin)
      worn(first:first + 1) = sum(wear(i)%volume, 1)
    end do
  end subroutine take_wear

  !> Whether a tighter tolerance would give a finer table of a film of the case.
  logical function has_coarse_table(case, tolerance)
    type(case_t), intent(in) :: case
    real(dp), intent(in) :: tolerance   !! the tighter one
    has_coarse_table = .false.
    call look_at(case%joint)
    call look_at(case%crank_pin)

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

  !> Results of a run in the order of `figure_names`; 0 for results that it does not have.
  pure function figures_of(witness) result(values)
    type(witness_t), intent(in) :: witness
    real(dp) :: values(n_figures)
    values = 0
    if (.not. witness%figures%time > 0) return
    associate (f => witness%figures, piston => witness%figures%pin(piston_pin), crank => witness%figures%pin(crank_pin))
      values(:7) = [piston%max_force, piston%contact_time/f%time, piston%min_film_thickness, crank%max_force, &
        crank%contact_time/f%time, crank%min_film_thickness, f%crank_travel/f%time]
    end associate
    values(wear_figures:wear_figures + 3) = witness%worn
    if (.not. allocated(witness%cycles)) return
    associate (s => witness%cycles%statistics)
      if (s%cycles > 0) values(loss_figure) = s%total%dissipated_energy/s%cycles
    end associate
  end function figures_of

  !> Statistics of some revolutions, at both pins.
  pure function means_of(cycles) result(means)
    type(cycle_t), intent(in) :: cycles(:)
    real(dp) :: means(n_statistics), duration
    duration = sum(cycles%duration)
    associate (piston => cycles%pin(piston_pin), crank => cycles%pin(crank_pin), n => size(cycles))
      means = [sum(piston%force_integral/duration), sum((piston%contact_time + crank%contact_time)/duration), &
        sum(real(piston%impacts + crank%impacts, dp)/n), sum(cycles%dissipated_energy/n)]
    end associate
  end function means_of
end module run_witness
