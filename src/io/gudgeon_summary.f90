!> The summary of a run: NAME.summary.csv.
module gudgeon_summary
  use, intrinsic :: iso_fortran_env, only: compiler_version, compiler_options
  use gudgeon_kinds, only: dp
  use gudgeon_constants, only: two_pi
  use ode_method, only: highest_order, with_adams, with_radau, n_limits, limit_names, limit_stability
  use gudgeon_simulation, only: run_report_t
  use cycle_answers, only: answer_t
  use run_figures, only: pin_figures_t, elastic_figures_t
  use piston_guide, only: n_corners, corner_names
  use period_watch, only: period_watch_t
  use joint_places, only: places, n_places, in_order, name_prefix
  use archard_wear, only: of_pin, of_bore
  use case_definition, only: case_t
  use joint_case, only: joint_case_t
  use result_notes, only: notes_on_results, relative_residual, energy_warning, no_exponent
  use number_text, only: real_text
  use text_tools, only: integer_text, quoted, next_line
  use gudgeon_version, only: program_version
  implicit none
  private
  public :: summary_table, summary_value, build_advice

  character(len=*), parameter :: newline = achar(10)

contains

  !> The rows `quantity,value,unit`. Peaks and times have as many digits as the trace, so that rounding does not make a row of the
  !> trace exceed them.
  function summary_table(case, report, wall_time, is_twin) result(text)
    type(case_t), intent(in) :: case
    type(run_report_t), intent(in) :: report
    real(dp), intent(in) :: wall_time                               !! [s]
    logical, intent(in), optional :: is_twin                        !! true for the ideal twin, whose bodies are rigid
    character(len=:), allocatable :: text
    character(len=5), parameter :: method_names(2) = ['adams', 'radau']
    integer :: order, limit, mode, method, corner, i

    text = 'quantity,value,unit'//newline
    call add('status', quoted(report%status, '"'), '')
    associate (s => report%statistics, f => report%figures)
      call add('simulated_time', peak(f%time), 's')
      call add('wall_time', real_text(wall_time), 's')
      call add('method', trim(case%integrator%method), '')
      call add('steps_accepted', integer_text(s%accepted), '1')
      call add('steps_rejected_error', integer_text(s%rejected_error), '1')
      call add('steps_rejected_penetration', integer_text(s%rejected_penetration), '1')
      call add('steps_rejected_domain', integer_text(s%rejected_domain), '1')
      call add('rhs_evaluations', integer_text(s%evaluations), '1')
      call add('trace_evaluations', integer_text(f%evaluations), '1')
      call add('restarts', integer_text(s%restarts), '1')
      if (s%accepted > 0) call add('smallest_step', real_text(s%smallest_step), 's')
      do order = 1, highest_order
        call add('steps_of_order_'//integer_text(order), integer_text(s%order_count(order)), '1')
      end do
      if (s%accepted > 0) then
        call add('step_limited_by', trim(limit_names(maxloc(s%limited_by, 1))), '')
        call add('stability_bound_fraction', real_text(real(s%limited_by(limit_stability), dp)/s%accepted), '1')
        do limit = 1, n_limits
          call add('steps_limited_by_'//trim(limit_names(limit)), integer_text(s%limited_by(limit)), '1')
        end do
        call add('stiffness_integral', real_text(s%stiffness), '1')
      end if
      if (allocated(report%time_with)) then
        call add('method_switches', integer_text(s%switches), '1')
        do mode = lbound(report%time_with, 2), ubound(report%time_with, 2)
          do method = with_adams, with_radau
            if (report%time_with(method, mode) > 0) call add(phases_of(case, mode)// &
              '_time_fraction_with_'//trim(method_names(method)), real_text(report%time_with(method, mode)/f%time), '1')
          end do
        end do
      end if
      if (s%jacobians > 0) then
        call add('jacobians', integer_text(s%jacobians), '1')
        call add('steps_rejected_convergence', integer_text(s%rejected_convergence), '1')
        do order = 1, size(s%stage_count)
          call add('steps_of_'//integer_text(2*order + 1)//'_stages', integer_text(s%stage_count(order)), '1')
        end do
      end if
      call add('max_pin_force', peak(f%pin(in_order(1))%max_force), 'N')
      call add('crank_revolutions', real_text(f%crank_travel/two_pi), '1')
      if (f%time > 0) call add('mean_crank_speed', real_text(f%crank_travel/f%time), 'rad/s')
      if (report%periods%is_on) call add_period(report%periods)
      if (report%exponent%is_known) then
        call add('lyapunov_exponent', real_text(report%exponent%mean), '1/revolution')
        call add('lyapunov_exponent_error', real_text(report%exponent%error), '1/revolution')
        call add('lyapunov_revolutions', integer_text(report%exponent%revolutions), '1')
      else if (allocated(report%exponent%reason)) then
        call add('lyapunov_warning', quoted(no_exponent//report%exponent%reason, '"'), '')
      end if
      call add('max_energy_residual', peak(max(f%max_energy_residual, f%row_energy_residual)), 'J')
      call add('max_energy_residual_relative', real_text(relative_residual(report)), '1')
      if (report%energy_is_poor) call add('energy_warning', quoted(energy_warning(case, report), '"'), '')
      call add_notes()
      do i = 1, n_places
        if (.not. case%joints(in_order(i))%has_clearance()) cycle
        if (i > 1) call add(name_prefix(in_order(i))//'max_pin_force', peak(f%pin(in_order(i))%max_force), 'N')
        call add_joint(name_prefix(in_order(i)), case%joints(in_order(i)), f%pin(in_order(i)))
      end do
      if (case%has_loose_guide()) then
        do corner = 1, n_corners
          associate (c => f%corner(corner), prefix => corner_names(corner)//'_')
            call add_contacts(prefix, c)
            call add(prefix//'max_force', peak(c%max_force), 'N')
          end associate
        end do
      end if
      if (case%is_elastic()) call add_elastic(f%elastic)
    end associate
    if (allocated(report%answers)) call add_answers(report%answers)
    call add('version', program_version, '')
    call add('compiler', quoted(compiler_version(), '"'), '')
    call add('compiler_options', quoted(compiler_options(), '"'), '')

  contains

    !> Rows of the notes on the case and on the results. The ideal twin has those on its own results.
    subroutine add_notes()
      character(len=:), allocatable :: notes, line
      integer :: at, number
      notes = notes_on_results(case, report)
      if (allocated(case%notes)) notes = case%notes//newline//notes
      at = 1
      number = 0
      do while (at <= len(notes))
        call next_line(notes, at, line)
        if (line == '') cycle
        number = number + 1
        call add('note_'//integer_text(number), quoted(line, '"'), '')
      end do
    end subroutine add_notes

    !> Rows about the period of the motion, of a run until it is periodic.
    subroutine add_period(periods)
      type(period_watch_t), intent(in) :: periods
      call add('motion', trim(merge('periodic    ', 'not_periodic', periods%period > 0)), '')
      call add('period_revolutions', integer_text(periods%period), '1')
      if (periods%period > 0) then
        call add('periodic_after', integer_text(periods%found_after), '1')
        call add('period', real_text(periods%duration), 's')
        call add('periodic_difference', real_text(periods%difference), '1')
      end if
      if (periods%window_after >= 0) call add('window_start', peak(periods%window_start), 's')
    end subroutine add_period

    !> Rows of a joint with clearance, with a prefix.
    subroutine add_joint(prefix, joint, pin)
      character(len=*), intent(in) :: prefix
      type(joint_case_t), intent(in) :: joint
      type(pin_figures_t), intent(in) :: pin
      if (allocated(joint%film)) then
        if (joint%oil%has_name()) call add(prefix//'oil', joint%oil%name, '')
        if (joint%oil%is_known()) call add(prefix//'viscosity', peak(joint%oil%dynamic_viscosity()), 'Pa s')
        if (joint%film%table_of /= '') then
          call add(prefix//'film_table_error', real_text(joint%film%table_error), '1')
          call add(prefix//'film_table_mean_error', real_text(joint%film%table_mean_error), '1')
          call add(prefix//'film_table_time', real_text(joint%film%table_time), 's')
        end if
      end if
      call add(prefix//'min_film_thickness', peak(pin%min_film_thickness), 'm')
      if (allocated(joint%film) .and. abs(pin%film_change) > 0) &
        call add(prefix//'film_thickness_change', real_text(pin%film_change), '1')
      call add_contacts(prefix, pin)
      call add(prefix//'max_entry_penetration', peak(pin%max_entry_penetration), 'm')
      call add(prefix//'impacts_beyond_validity', integer_text(pin%impacts_beyond_validity), '1')
      call add(prefix//'contacts_beyond_validity', integer_text(pin%contacts_beyond_validity), '1')
      if (pin%friction_work < huge(pin%friction_work)) call add(prefix//'friction_work', real_text(pin%friction_work), 'J')
      if (allocated(joint%wear) .and. allocated(report%wear)) call add_wear(prefix)
      if (.not. (joint%reports_film .and. allocated(joint%film))) return
      call add(prefix//'film_energy_lost', real_text(pin%film_energy_lost), 'J')
      if (joint%film%neglects_shear()) &
        call add(prefix//'neglected_shear_loss', real_text(pin%neglected_shear_loss), 'J')
      if (joint%film%gives_pressure()) call add(prefix//'max_film_pressure', peak(pin%max_film_pressure), 'Pa')
      if (joint%film%gives_side_flow() .and. report%figures%time > 0) &
        call add(prefix//'mean_film_side_flow', real_text(pin%film_volume/report%figures%time), 'm3/s')
    end subroutine add_joint

    !> Rows of the worn surfaces of a joint.
    subroutine add_wear(prefix)
      character(len=*), intent(in) :: prefix
      integer :: i
      do i = 1, size(report%wear)
        associate (worn => report%wear(i))
          if (name_prefix(worn%place) /= prefix) cycle
          call add(prefix//'worn_volume_pin', real_text(sum(worn%volume(:, of_pin))), 'm3')
          call add(prefix//'worn_volume_bore', real_text(sum(worn%volume(:, of_bore))), 'm3')
          call add(prefix//'max_wear_depth_pin', real_text(maxval(worn%depth(:, of_pin))), 'm')
          call add(prefix//'max_wear_depth_bore', real_text(maxval(worn%depth(:, of_bore))), 'm')
          if (.not. worn%bore_changes) cycle
          call add(prefix//'wear_revolutions', real_text(worn%turns), '1')
          call add(prefix//'wear_step_over_clearance', real_text(worn%step_ratios(1)), '1')
          call add(prefix//'wear_step_over_penetration', real_text(worn%step_ratios(2)), '1')
        end associate
      end do
    end subroutine add_wear

    !> Rows of the contacts of a pin or of a corner of the skirt.
    subroutine add_contacts(prefix, at)
      character(len=*), intent(in) :: prefix
      type(pin_figures_t), intent(in) :: at
      call add(prefix//'contacts', integer_text(at%contacts), '1')
      if (report%figures%time > 0) call add(prefix//'contact_time_fraction', real_text(at%contact_time/report%figures%time), '1')
      call add(prefix//'max_penetration', peak(at%max_penetration), 'm')
    end subroutine add_contacts

    !> Rows of elastic members. The summary of the ideal twin says that they are rigid.
    subroutine add_elastic(largest)
      type(elastic_figures_t), intent(in) :: largest
      if (present(is_twin)) then
        if (is_twin) call add('elastic_members', 'none: the ideal twin is rigid', '')
        if (is_twin) return
      end if
      call add('elastic_members', trim(merge(merge('rod and crankshaft', 'rod               ', allocated(case%crankshaft)), &
        'crankshaft        ', allocated(case%elastic_rod))), '')
      if (allocated(case%elastic_rod)) then
        call add('rod_bending_frequency', real_text(largest%bending_frequency/two_pi), 'Hz')
        call add('rod_axial_frequency', real_text(largest%axial_frequency/two_pi), 'Hz')
        call add('max_rod_mid_deflection', peak(largest%mid_deflection), 'm')
        call add('max_rod_stretch', peak(largest%stretch), 'm')
        call add('max_rod_strain_energy', peak(largest%strain_energy), 'J')
      end if
      if (.not. allocated(case%crankshaft)) return
      call add('crankshaft_frequency', real_text(largest%twist_frequency/two_pi), 'Hz')
      call add('max_crankshaft_twist', peak(largest%twist), 'rad')
    end subroutine add_elastic

    !> Rows of the last whole cycle.
    subroutine add_answers(answers)
      type(answer_t), intent(in) :: answers(:)
      integer :: i
      do i = 1, size(answers)
        associate (it => answers(i))
          if (it%unit == '') then
            call add(trim(it%name), trim(it%text), '')
          else if (it%name == 'cycle_revolutions') then
            call add(trim(it%name), integer_text(nint(it%value)), '1')
          else
            call add(trim(it%name), peak(it%value), trim(it%unit))
          end if
        end associate
      end do
    end subroutine add_answers

    !> A peak or a time, with as many digits as the trace.
    function peak(value) result(number)
      real(dp), intent(in) :: value
      character(len=:), allocatable :: number
      number = real_text(value, case%output%digits)
    end function peak

    subroutine add(quantity, value, unit)
      character(len=*), intent(in) :: quantity, value, unit
      text = text//quantity//','//value//','//unit//newline
    end subroutine add
  end function summary_table

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
    if (case%has_loose_guide()) then
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

  !> The value of a quantity in the text of a summary; empty if it is not there.
  function summary_value(table, quantity) result(text)
    character(len=*), intent(in) :: table, quantity
    character(len=:), allocatable :: text
    integer :: first
    text = ''
    first = index(table, newline//quantity//',')
    if (first == 0) return
    first = first + len(newline//quantity//',')
    text = table(first:first + index(table(first:)//newline, newline) - 2)
    text = text(:index(text, ',', back=.true.) - 1)
  end function summary_value

  !> Advice for the user of a program that was compiled without optimisation, or an empty text.
  pure function build_advice(flags, seconds) result(text)
    character(len=*), intent(in) :: flags   !! compiler options, separated by blanks
    real(dp), intent(in) :: seconds         !! time taken by the cases [s]
    character(len=:), allocatable :: text
    real(dp), parameter :: patience = 2
    text = ''
    if (seconds > patience .and. index(' '//flags, ' -O2') + index(' '//flags, ' -O3') + index(' '//flags, ' -Ofast') == 0) &
      text = 'this is a build for debugging, several times slower than the fast program: scripts/install.sh installs that'
  end function build_advice
end module gudgeon_summary
