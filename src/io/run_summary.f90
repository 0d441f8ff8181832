!> The summary of a run: NAME.summary.csv.
module run_summary
  use, intrinsic :: iso_fortran_env, only: compiler_version, compiler_options
  use kinds, only: dp
  use constants, only: two_pi, degree
  use ideal_linkage, only: linkage_t
  use ode_method, only: highest_order, with_adams, with_radau, n_limits, limit_names, limit_stability
  use simulation, only: run_report_t
  use train_record, only: train_result_t
  use cycle_answers, only: answer_t, cycle_quantities
  use history_files, only: add_histories
  use result_table, only: result_table_t
  use run_figures, only: run_figures_t, pin_figures_t, elastic_figures_t
  use piston_guide, only: n_corners, corner_names
  use period_watch, only: period_watch_t
  use joint_places, only: n_places, in_order, name_prefix, piston_pin, small_end
  use archard_wear, only: of_pin, of_bore
  use film_heat, only: heat_totals_t
  use case_definition, only: case_t
  use joint_case, only: joint_case_t
  use result_notes, only: notes_on_results, relative_residual, energy_warning, no_exponent, &
    pin_is_undecided, undecided_pin
  use text_tools, only: integer_text
  use version_number, only: program_version
  implicit none
  private
  public :: summary_table, build_advice

  character(len=*), parameter :: newline = achar(10)

contains

  !> The rows `quantity,value,unit` of a run.
  function summary_table(case, report, wall_time, is_twin) result(text)
    type(case_t), intent(in) :: case
    type(run_report_t), intent(in) :: report
    real(dp), intent(in) :: wall_time                               !! [s]
    logical, intent(in), optional :: is_twin                        !! true for the ideal twin, whose bodies are rigid
    character(len=:), allocatable :: text
    type(result_table_t) :: table
    logical :: rigid
    rigid = .false.
    if (present(is_twin)) rigid = is_twin
    table%digits = case%output%digits
    call table%clear()
    call table%append('quantity,value,unit'//newline)
    call table%add('status', report%status)
    call table%add('simulated_time', report%figures%time)
    call table%add('wall_time', wall_time)
    call add_integration(table, case, report)
    call add_machine(table, case, report)
    call add_notes(table, case, report)
    call add_places(table, case, report)
    if (case%is_elastic()) call add_elastic(table, case, report%figures%elastic, rigid)
    if (allocated(report%train)) call add_train(table, report%train)
    if (allocated(report%answers)) call add_answers(table, case, report, report%answers)
    if (allocated(report%histories)) call add_histories(table, report%histories)
    call table%add('version', program_version)
    call table%add('compiler', compiler_version())
    call table%add('compiler_options', compiler_options())
    text = table%text(:table%used)
  end function summary_table

  !> Rows of the work of the integrator.
  subroutine add_integration(table, case, report)
    type(result_table_t), intent(inout) :: table
    type(case_t), intent(in) :: case
    type(run_report_t), intent(in) :: report
    character(len=5), parameter :: method_names(2) = ['adams', 'radau']
    integer :: order, limit, mode, method
    associate (s => report%statistics, f => report%figures)
      call table%add('method', trim(case%integrator%method))
      call table%add('steps_accepted', s%accepted)
      call table%add('steps_rejected_error', s%rejected_error)
      call table%add('steps_rejected_penetration', s%rejected_penetration)
      call table%add('steps_rejected_domain', s%rejected_domain)
      call table%add('rhs_evaluations', s%evaluations)
      call table%add('trace_evaluations', f%evaluations)
      call table%add('restarts', s%restarts)
      if (s%accepted > 0) call table%add('smallest_step', s%smallest_step)
      do order = 1, highest_order
        call table%add('steps_of_order_N', s%order_count(order), for=integer_text(order))
      end do
      if (s%accepted > 0) then
        call table%add('step_limited_by', trim(limit_names(maxloc(s%limited_by, 1))))
        call table%add('stability_bound_fraction', real(s%limited_by(limit_stability), dp)/s%accepted)
        do limit = 1, n_limits
          call table%add('steps_limited_by_NAME', s%limited_by(limit), for=trim(limit_names(limit)))
        end do
        call table%add('stiffness_integral', s%stiffness)
      end if
      if (allocated(report%time_with)) then
        call table%add('method_switches', s%switches)
        do mode = lbound(report%time_with, 2), ubound(report%time_with, 2)
          do method = with_adams, with_radau
            if (report%time_with(method, mode) > 0) call &
              table%add('PHASE_time_fraction_with_NAME', report%time_with(method, mode)/sum(report%time_with), &
              phases_of(case, mode)//'_', trim(method_names(method)))
          end do
        end do
      end if
      if (s%jacobians > 0) then
        call table%add('jacobians', s%jacobians)
        call table%add('steps_rejected_convergence', s%rejected_convergence)
        do order = 1, size(s%stage_count)
          call table%add('steps_of_N_stages', s%stage_count(order), for=integer_text(2*order + 1))
        end do
      end if
    end associate
  end subroutine add_integration

  !> Rows of the machine: what is kept of its columns, its motion, its energy.
  subroutine add_machine(table, case, report)
    type(result_table_t), intent(inout) :: table
    type(case_t), intent(in) :: case
    type(run_report_t), intent(in) :: report
    associate (f => report%figures)
      call add_kept(table, report, '', in_cycle=.false.)
      if (f%floating%is_present) call add_floating_pin(table, case, f)
      if (abs(case%mechanism%axis_offset) > 0) call add_dead_centres(table, case%mechanism%linkage())
      call table%add('crank_revolutions', f%crank_travel/two_pi)
      if (f%time > 0) call table%add('mean_crank_speed', f%crank_travel/f%time)
      if (report%periods%is_on) call add_period(table, report%periods)
      if (report%exponent%is_known) then
        call table%add('lyapunov_exponent', report%exponent%mean)
        call table%add('lyapunov_exponent_error', report%exponent%error)
        call table%add('lyapunov_revolutions', report%exponent%revolutions)
      else if (allocated(report%exponent%reason)) then
        call table%add('lyapunov_warning', no_exponent//report%exponent%reason)
      end if
      call table%add('max_energy_residual', max(f%max_energy_residual, f%row_energy_residual))
      call table%add('max_energy_residual_relative', relative_residual(report))
      if (report%energy_is_poor) call table%add('energy_warning', energy_warning(case, report))
      if (f%gas_residual >= 0) call table%add('gas_residual_relative', f%gas_residual)
    end associate
  end subroutine add_machine

  !> Rows of the joints with clearance and of the corners of the skirt.
  subroutine add_places(table, case, report)
    type(result_table_t), intent(inout) :: table
    type(case_t), intent(in) :: case
    type(run_report_t), intent(in) :: report
    integer, allocatable :: spots(:)
    integer :: corner, i, k
    associate (f => report%figures)
      do i = 1, n_places
        if (.not. case%joints(in_order(i))%has_bearing()) cycle
        spots = case%spots(in_order(i))
        do k = 1, size(spots)
          call add_joint(table, report, name_prefix(spots(k)), case%joints(in_order(i)), f%pin(spots(k)))
        end do
      end do
      if (case%has_skirt_corners()) then
        do corner = 1, n_corners
          associate (c => f%corner(corner), prefix => corner_names(corner)//'_')
            call add_kept(table, report, prefix, in_cycle=.false.)
            call add_contacts(table, report, prefix, c)
          end associate
        end do
      end if
    end associate
  end subroutine add_places

  !> Rows of the notes on the case and on the results. The ideal twin has those on its own results.
  subroutine add_notes(table, case, report)
    type(result_table_t), intent(inout) :: table
    type(case_t), intent(in) :: case
    type(run_report_t), intent(in) :: report
    character(len=:), allocatable :: notes
    notes = notes_on_results(case, report)
    if (allocated(case%notes)) notes = case%notes//newline//notes
    call table%add_notes(notes)
  end subroutine add_notes

  !> Rows of the stroke of a mechanism whose cylinder axis is offset.
  subroutine add_dead_centres(table, linkage)
    type(result_table_t), intent(inout) :: table
    type(linkage_t), intent(in) :: linkage
    call table%add('stroke', linkage%stroke())
    call table%add('top_dead_centre_angle', linkage%top_angle()/degree)
    call table%add('bottom_dead_centre_angle', linkage%bottom_angle()/degree)
  end subroutine add_dead_centres

  !> Rows about the period of the motion, of a run until it is periodic.
  subroutine add_period(table, periods)
    type(result_table_t), intent(inout) :: table
    type(period_watch_t), intent(in) :: periods
    call table%add('motion', trim(merge('periodic    ', 'not_periodic', periods%period > 0)))
    call table%add('period_revolutions', periods%period)
    if (periods%period > 0) then
      call table%add('periodic_after', periods%found_after)
      call table%add('period', periods%duration)
      call table%add('periodic_difference', periods%difference)
    end if
    if (periods%window_after >= 0) call table%add('window_start', periods%window_start)
  end subroutine add_period

  !> Rows of a joint with clearance, with a prefix.
  subroutine add_joint(table, report, prefix, joint, pin)
    type(result_table_t), intent(inout) :: table
    type(run_report_t), intent(in) :: report
    character(len=*), intent(in) :: prefix
    type(joint_case_t), intent(in) :: joint
    type(pin_figures_t), intent(in) :: pin
    if (allocated(joint%film)) then
      if (joint%oil%has_name()) call table%add('oil', joint%oil%name, prefix)
      if (joint%oil%is_known()) call table%add('viscosity', joint%oil%dynamic_viscosity(), prefix)
      if (joint%film%table_of /= '') then
        call table%add('film_table_error', joint%film%table_error, prefix)
        call table%add('film_table_mean_error', joint%film%table_mean_error, prefix)
        call table%add('film_table_time', joint%film%table_time, prefix)
      end if
    end if
    if (prefix /= '') call add_kept(table, report, prefix, in_cycle=.false.)
    if (allocated(joint%film) .and. abs(pin%film_change) > 0) &
      call table%add('film_thickness_change', pin%film_change, prefix)
    call add_contacts(table, report, prefix, pin)
    call table%add('max_entry_penetration', pin%max_entry_penetration, prefix)
    call table%add('impacts_beyond_validity', pin%impacts_beyond_validity, prefix)
    call table%add('contacts_beyond_validity', pin%contacts_beyond_validity, prefix)
    if (pin%friction_work < huge(pin%friction_work)) call table%add('friction_work', pin%friction_work, prefix)
    if (allocated(joint%wear) .and. allocated(report%wear)) call add_wear(table, report, prefix)
    if (pin%heat%is_known) call add_heat(table, prefix, pin%heat)
  end subroutine add_joint

  !> Rows of what is kept of the columns of a place, over the run or over its last cycle.
  subroutine add_kept(table, report, place, in_cycle)
    type(result_table_t), intent(inout) :: table
    type(run_report_t), intent(in) :: report
    character(len=*), intent(in) :: place   !! prefix of the names; empty: of the first pin and of the machine
    logical, intent(in) :: in_cycle
    integer :: i
    if (.not. allocated(report%kept)) return
    do i = 1, size(report%kept)
      associate (it => report%kept(i))
        if (it%place == place .and. (it%is_of_cycle .eqv. in_cycle)) &
          call table%add_with_unit(place//trim(it%name), it%value, trim(it%unit))
      end associate
    end do
  end subroutine add_kept

  !> Rows of the turn of a floating pin.
  subroutine add_floating_pin(table, case, f)
    type(result_table_t), intent(inout) :: table
    type(case_t), intent(in) :: case
    type(run_figures_t), intent(in) :: f
    associate (in_piston => f%pin(piston_pin)%turning, in_rod => f%pin(small_end)%turning)
      call table%add('pin_turn', f%floating%turn)
      if (f%floating%revolutions > 0) call table%add('pin_drift_per_revolution', f%floating%drift)
      if (f%floating%revolutions > 0) call table%add('pin_swing', f%floating%swing)
      call table%add('turning_in_piston', in_piston)
      call table%add('turning_in_rod', in_rod)
      if (in_piston + in_rod > 0) call table%add('small_end_turning_share', in_rod/(in_piston + in_rod))
      if (pin_is_undecided(case)) call table%add('pin_warning', undecided_pin)
    end associate
  end subroutine add_floating_pin

  !> Rows of the heat of a film.
  subroutine add_heat(table, prefix, heat)
    type(result_table_t), intent(inout) :: table
    character(len=*), intent(in) :: prefix
    type(heat_totals_t), intent(in) :: heat
    call table%add('film_temperature', heat%temperature, prefix)
    call table%add('heat_in', heat%came_in, prefix)
    call table%add('heat_to_oil', heat%to_oil, prefix)
    call table%add('heat_to_housing', heat%to_housing, prefix)
    call table%add('heat_stored', heat%stored, prefix)
    if (heat%jumps > 0) then
      call table%add('temperature_jumps', heat%jumps, prefix)
      call table%add('heat_extrapolated', heat%extrapolated, prefix)
    end if
    call table%add('heat_residual', heat%residual, prefix)
    call table%add('heat_residual_relative', heat%relative_residual(), prefix)
  end subroutine add_heat

  !> Rows of the worn surfaces of a joint.
  subroutine add_wear(table, report, prefix)
    type(result_table_t), intent(inout) :: table
    type(run_report_t), intent(in) :: report
    character(len=*), intent(in) :: prefix
    integer :: i
    do i = 1, size(report%wear)
      associate (worn => report%wear(i))
        if (name_prefix(worn%place) /= prefix) cycle
        call table%add('worn_volume_pin', sum(worn%volume(:, of_pin)), prefix)
        call table%add('worn_volume_bore', sum(worn%volume(:, of_bore)), prefix)
        call table%add('max_wear_depth_pin', maxval(worn%depth(:, of_pin)), prefix)
        call table%add('max_wear_depth_bore', maxval(worn%depth(:, of_bore)), prefix)
        if (.not. worn%bore_changes) cycle
        call table%add('wear_revolutions', worn%turns, prefix)
        call table%add('wear_step_over_clearance', worn%step_ratios(1), prefix)
        call table%add('wear_step_over_penetration', worn%step_ratios(2), prefix)
      end associate
    end do
  end subroutine add_wear

  !> Rows of the contacts of a pin or of a corner of the skirt.
  subroutine add_contacts(table, report, prefix, at)
    type(result_table_t), intent(inout) :: table
    type(run_report_t), intent(in) :: report
    character(len=*), intent(in) :: prefix
    type(pin_figures_t), intent(in) :: at
    call table%add('contacts', at%contacts, prefix)
    if (report%figures%time > 0) call table%add('contact_time_fraction', at%contact_time/report%figures%time, prefix)
    call table%add('max_penetration', at%max_penetration, prefix)
  end subroutine add_contacts

  !> Rows of elastic members. The summary of the ideal twin says that they are rigid.
  subroutine add_elastic(table, case, natural, is_twin)
    type(result_table_t), intent(inout) :: table
    type(case_t), intent(in) :: case
    type(elastic_figures_t), intent(in) :: natural
    logical, intent(in) :: is_twin
    if (is_twin) then
      call table%add('elastic_members', 'none: the ideal twin is rigid')
      return
    end if
    call table%add('elastic_members', trim(merge(merge('rod and crankshaft', 'rod               ', &
      allocated(case%crankshaft)), 'crankshaft        ', allocated(case%elastic_rod))))
    if (allocated(case%elastic_rod)) then
      call table%add('rod_bending_frequency', natural%bending_frequency/two_pi)
      call table%add('rod_axial_frequency', natural%axial_frequency/two_pi)
    end if
    if (.not. allocated(case%crankshaft)) return
    call table%add('crankshaft_frequency', natural%twist_frequency/two_pi)
  end subroutine add_elastic

  !> Rows of several cylinders on one crankshaft.
  subroutine add_train(table, results)
    type(result_table_t), intent(inout) :: table
    type(train_result_t), intent(in) :: results(:)
    integer :: i
    do i = 1, size(results)
      if (allocated(results(i)%text)) then
        call table%add_numbered(trim(results(i)%declared), trim(results(i)%name), 0.0_dp, results(i)%text)
      else
        call table%add_numbered(trim(results(i)%declared), trim(results(i)%name), results(i)%value)
      end if
    end do
  end subroutine add_train

  !> Rows of the last whole cycle: which it is, what is kept of columns, and what follows from that.
  subroutine add_answers(table, case, report, answers)
    type(result_table_t), intent(inout) :: table
    type(case_t), intent(in) :: case
    type(run_report_t), intent(in) :: report
    type(answer_t), intent(in) :: answers(:)
    character(len=:), allocatable :: name
    integer, allocatable :: spots(:)
    integer :: i, k, j
    do i = 1, size(answers)
      associate (it => answers(i))
        name = trim(cycle_quantities(it%quantity)%name)
        if (it%text /= '') then
          call table%add(name, trim(it%text))
        else if (name == 'cycle_revolutions') then
          call table%add(name, nint(it%value))
        else if (it%place > 0) then
          call table%add(name, it%value, name_prefix(it%place))
        else
          call table%add(name, it%value)
        end if
        if (name /= 'cycle_is_settled') cycle
        do k = 1, n_places
          spots = case%spots(in_order(k))
          do j = 1, size(spots)
            call add_kept(table, report, name_prefix(spots(j)), in_cycle=.true.)
          end do
        end do
        do k = 1, n_corners
          call add_kept(table, report, corner_names(k)//'_', in_cycle=.true.)
        end do
      end associate
    end do
  end subroutine add_answers

  !> Names of the phases of the joints in a mode of the scene, in the order of the places: the digits of the mode in base three. If
  !> the first place has none, the place of the first name precedes it. For a guide with clearance its phase precedes them; it is
  !> the highest digit.
  function phases_of(case, mode) result(text)
    type(case_t), intent(in) :: case
    integer, intent(in) :: mode   !! number >= 0
    character(len=:), allocatable :: text
    character(len=7), parameter :: names(0:2) = ['free   ', 'film   ', 'contact']
    integer :: pins, i
    pins = mode
    text = ''
    if (case%has_skirt_corners()) then
      pins = mod(mode, size(names)**count(case%joints%has_clearance()))
      text = trim(merge('guide_free   ', 'guide_contact', pins == mode))
    end if
    do i = 1, n_places
      if (.not. case%joints(in_order(i))%has_clearance()) cycle
      if (text /= '') text = text//'_'
      if (.not. any(case%joints(in_order(:i - 1))%has_clearance())) text = text//name_prefix(in_order(i))
      text = text//trim(names(mod(pins, size(names))))
      pins = pins/size(names)
    end do
    if (text == '') text = trim(names(mod(pins, size(names))))
  end function phases_of

  !> Advice for the user of a program that was compiled without optimisation, or an empty text.
  pure function build_advice(flags, seconds) result(text)
    character(len=*), intent(in) :: flags   !! compiler options, separated by blanks
    real(dp), intent(in) :: seconds         !! time taken by the cases [s]
    character(len=:), allocatable :: text
    real(dp), parameter :: long_run = 2
    text = ''
    if (seconds > long_run .and. index(' '//flags, ' -O2') + index(' '//flags, ' -O3') + index(' '//flags, ' -Ofast') == 0) &
      text = 'this is a build for debugging, several times slower than the fast program: scripts/install.sh installs that'
  end function build_advice
end module run_summary
