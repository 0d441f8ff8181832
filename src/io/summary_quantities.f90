!> The declarations of all quantities of NAME.summary.csv and of the columns of the other tables of results: name, unit, meaning.
!> The writers of these tables and the reference pages read them here.
module summary_quantities
  use cycle_answers, only: quantity_t, cycle_quantities
  implicit none
  private
  public :: quantity_t, quantities_of_runs, event_columns, wear_columns, study_columns, unit_of

  !> In the names N stands for a number and PHASE for the phases of the joints. Quantities of the crank pin have the prefix
  !> `crank_pin_`, those of the small end `small_end_`, those of the corners of the skirt `guide_1_` to `guide_4_`.
  type(quantity_t), parameter :: of_integration(*) = [ &
    quantity_t('status', '', '`done`, or the reason why the run ended early'), &
    quantity_t('simulated_time', 's', 'time that was simulated'), &
    quantity_t('wall_time', 's', 'time that the run took by the clock'), &
    quantity_t('method', '', 'integration method of the case: auto, adams or radau'), &
    quantity_t('steps_accepted', '1', 'accepted steps of the integrator'), &
    quantity_t('steps_rejected_error', '1', &
      'steps rejected because their estimated error was above the tolerance, or because they passed over the static friction of &
      &a pin that reverses its sliding'), &
    quantity_t('steps_rejected_penetration', '1', &
      'steps rejected because they entered contact deeper than `max_penetration` (step_rejection only)'), &
    quantity_t('steps_rejected_domain', '1', 'steps rejected because a film would have had no thickness'), &
    quantity_t('rhs_evaluations', '1', 'evaluations of the right-hand side by the integrator'), &
    quantity_t('trace_evaluations', '1', 'further evaluations, for rows of the trace and for peaks'), &
    quantity_t('restarts', '1', 'restarts of the integrator, at contacts and other discontinuities of the force'), &
    quantity_t('smallest_step', 's', 'smallest accepted step'), &
    quantity_t('steps_of_order_N', '1', 'accepted steps of the Adams method of order N'), &
    quantity_t('step_limited_by', '', 'what limited the largest number of steps'), &
    quantity_t('stability_bound_fraction', '1', 'share of the steps that were limited by the stability of the method'), &
    quantity_t('steps_limited_by_NAME', '1', &
      'accepted steps limited by NAME: error (estimate), stability, max_step, start (restart), refusal (trial rejected)'), &
    quantity_t('stiffness_integral', '1', &
      'integral over time of the rate of the fastest mode; large values call for an implicit method'), &
    quantity_t('method_switches', '1', 'changes between Adams and Radau (method auto)'), &
    quantity_t('PHASE_time_fraction_with_NAME', '1', &
      'share of the time in this phase (free, film or contact) integrated by this method (method auto)'), &
    quantity_t('jacobians', '1', 'Jacobian matrices that Radau evaluated'), &
    quantity_t('steps_rejected_convergence', '1', 'steps rejected because the Newton iteration of Radau did not converge'), &
    quantity_t('steps_of_N_stages', '1', 'accepted steps of Radau with N stages')]

  type(quantity_t), parameter :: of_motion(*) = [ &
    quantity_t('pin_turn', 'rad', 'angle by which a floating pin has turned since the start, positive from x to y'), &
    quantity_t('pin_drift_per_revolution', 'rad', 'its mean in the whole revolutions of the crank'), &
    quantity_t('pin_swing', 'rad', 'largest less smallest angle of a floating pin in the last cycle'), &
    quantity_t('turning_in_piston', 'rad', 'angle that a floating pin has turned through in the piston, in either sense'), &
    quantity_t('turning_in_rod', 'rad', 'the same in the small end of the rod'), &
    quantity_t('small_end_turning_share', '1', 'the latter over the sum of both'), &
    quantity_t('pin_warning', '', 'written where nothing decides in which bearing a floating pin turns'), &
    quantity_t('stroke', 'm', 'stroke of the ideal mechanism, with an `axis_offset`'), &
    quantity_t('top_dead_centre_angle', 'deg', 'crank angle at which the piston is highest, with an `axis_offset`'), &
    quantity_t('bottom_dead_centre_angle', 'deg', 'crank angle at which it is lowest'), &
    quantity_t('crank_revolutions', '1', 'angle that the crank has turned through, in revolutions'), &
    quantity_t('mean_crank_speed', 'rad/s', 'that angle over the simulated time'), &
    quantity_t('motion', '', '`periodic` or `not_periodic` (`until = ''periodic''`)'), &
    quantity_t('period_revolutions', '1', 'period of the motion in revolutions of the crank; 0: not periodic'), &
    quantity_t('periodic_after', '1', 'revolutions after which the period was found'), &
    quantity_t('period', 's', 'duration of one period'), &
    quantity_t('periodic_difference', '1', &
      'largest difference of the state after one period, over the range of each component'), &
    quantity_t('window_start', 's', 'time of the first row with `window = ''last_period''`'), &
    quantity_t('lyapunov_exponent', '1/revolution', &
      'largest Lyapunov exponent: growth rate of the distance of neighbouring motions'), &
    quantity_t('lyapunov_exponent_error', '1/revolution', 'its standard error'), &
    quantity_t('lyapunov_revolutions', '1', 'revolutions over which it was measured'), &
    quantity_t('max_energy_residual', 'J', 'largest size of the energy residual, at the ends of steps and in the rows'), &
    quantity_t('max_energy_residual_relative', '1', &
      'that at the ends of steps over the largest energy: a measure of the integration error'), &
    quantity_t('energy_warning', '', 'written where that is larger than the tolerance explains'), &
    quantity_t('gas_residual_relative', '1', 'energy of the gas less what it has received by heat, work and leak, over the '// &
      'size of its work, where pressure and mass are integrated'), &
    quantity_t('note_N', '', 'values of the case or results that are implausible or beyond a model')]

  type(quantity_t), parameter :: of_joints(*) = [ &
    quantity_t('oil', '', 'named oil of the film'), &
    quantity_t('viscosity', 'Pa s', 'dynamic viscosity of the oil at the temperature of the film'), &
    quantity_t('film_table_error', '1', &
      'largest relative error of the force in the table of the film against its solver, at gaps from 1e-4 of the clearance on'), &
    quantity_t('film_table_mean_error', '1', 'root mean square of the same'), &
    quantity_t('film_table_time', 's', 'time that computing or reading the table took, not part of `wall_time`'), &
    quantity_t('film_thickness_change', '1', &
      'smallest film thickness in the last cycle less that in the cycle before, over the latter; large: not settled'), &
    quantity_t('contacts', '1', 'contacts that began'), &
    quantity_t('contact_time_fraction', '1', 'share of the simulated time in contact'), &
    quantity_t('max_penetration', 'm', 'deepest penetration; 0 without contact'), &
    quantity_t('max_entry_penetration', 'm', 'deepest penetration at the instant that counts as the beginning of a contact'), &
    quantity_t('impacts_beyond_validity', '1', &
      'contacts that began faster than 1e-5 sqrt(E/rho), the limit of the contact theory'), &
    quantity_t('contacts_beyond_validity', '1', &
      'contacts that at some instant were deeper than their elastic force is valid for'), &
    quantity_t('friction_work', 'J', 'work of the friction on the bodies; negative: energy lost'), &
    quantity_t('worn_volume_pin', 'm3', 'volume worn from the pin (group wear)'), &
    quantity_t('worn_volume_bore', 'm3', 'volume worn from the bore'), &
    quantity_t('max_wear_depth_pin', 'm', 'largest mean depth of a bin of NAME.wear.csv on the pin'), &
    quantity_t('max_wear_depth_bore', 'm', 'the same on the bore'), &
    quantity_t('wear_revolutions', '1', 'revolutions that the last shape of a worn bore stands for, with `extrapolation`'), &
    quantity_t('wear_step_over_clearance', '1', 'largest change of its depth at once, over the clearance'), &
    quantity_t('wear_step_over_penetration', '1', &
      'the same over the mean penetration: a large value calls for less extrapolation or fewer `cycles_per_update`'), &
    quantity_t('film_temperature', 'K', 'temperature of the film at the end of the run (group heat)'), &
    quantity_t('heat_in', 'J', 'heat of the losses of the film, with its shear, and of friction'), &
    quantity_t('heat_to_oil', 'J', 'heat that has left with the side flow'), &
    quantity_t('heat_to_housing', 'J', 'heat that has flowed to the housing'), &
    quantity_t('heat_stored', 'J', 'heat capacity times the rise of the temperature'), &
    quantity_t('temperature_jumps', '1', &
      'changes of the temperature that stand for a time that was left out (`until = ''periodic''`)'), &
    quantity_t('heat_extrapolated', 'J', 'the part of the heat stored that comes from these changes'), &
    quantity_t('heat_residual', 'J', &
      'heat that came in less what has left and what was stored otherwise: a measure of the integration error'), &
    quantity_t('heat_residual_relative', '1', 'the same over the largest of the heats that came in, left or were stored'), &
    quantity_t('elastic_members', '', 'which bodies are elastic'), &
    quantity_t('rod_bending_frequency', 'Hz', 'lowest natural frequency of the rod in bending'), &
    quantity_t('rod_axial_frequency', 'Hz', &
      'lowest natural frequency of the rod along its axis, with the piston, crank pin at rest'), &
    quantity_t('crankshaft_frequency', 'Hz', &
      'natural frequency of the crank and the flywheel on the elastic shaft, with the mean inertia of rod and piston'), &
    quantity_t('film_history_cycles', '1', 'cycles over which the film with memory was solved (film_history)'), &
    quantity_t('film_history_cycle_change', '1', 'change of its oil from the end of a cycle to that of the next, over the oil'), &
    quantity_t('film_history_min_film_thickness', 'm', 'thinnest film of the last cycle'), &
    quantity_t('film_history_max_film_pressure', 'Pa', 'its largest pressure, above that of cavitation'), &
    quantity_t('film_history_mean_supply_flow', 'm3/s', 'its mean flow from the supply'), &
    quantity_t('film_history_mean_side_flow', 'm3/s', 'its mean flow out of both ends of the bearing'), &
    quantity_t('film_history_least_fill', '1', 'smallest part of the gap that oil fills'), &
    quantity_t('film_history_mean_power_loss', 'W', 'mean power that the shear of the film takes from the pin'), &
    quantity_t('film_history_mass_residual', '1', 'largest error of the balance of its oil, over the largest flow'), &
    quantity_t('film_history_cells_per_gap', '1', &
      'cells over the length in which the thinnest gap doubles; fewer than 4: too coarse'), &
    quantity_t('film_history_max_tilting_moment', 'N.m', 'largest moment of the film on a tilted pin, about an axis across it'), &
    quantity_t('film_history_shape_depth', 'm', &
      'largest less smallest deviation of the bore (`&shape`); the film of the run is that of a round bore in line'), &
    quantity_t('film_history_min_film_thickness_angle', 'deg', 'crank angle of the thinnest film'), &
    quantity_t('film_history_quick_min_film_thickness', 'm', 'thinnest film of the run in the rows of that cycle'), &
    quantity_t('film_history_quick_max_film_pressure', 'Pa', 'largest pressure of the film of the run in these rows'), &
    quantity_t('film_history_thickness_ratio', '1', &
      'thickness of the film with memory over that of the film of the run, where they differ most'), &
    quantity_t('film_history_thickness_ratio_time', 's', 'time of that row'), &
    quantity_t('firing_order', '', 'cylinders in the order in which the shaft brings them to one point of the cycle, from 1 on'), &
    quantity_t('natural_frequency_N', 'Hz', 'natural frequencies of the crankshaft with mean inertias, undamped, above 0; with '// &
      'its driven station held if the speed is prescribed'), &
    quantity_t('mode_N_station_J', '1', 'shape of the mode N (the first three) at station J; the largest is 1'), &
    quantity_t('mode_N_damper_R', '1', 'the same of the ring of a damper of rubber'), &
    quantity_t('cyclic_irregularity', '1', &
      'largest less smallest speed of the driven station in the last cycle, over the mean speed'), &
    quantity_t('front_irregularity', '1', 'the same of the first station'), &
    quantity_t('cycle_mean_damper_R_power', 'W', 'mean power that the damping of damper R takes in the last cycle'), &
    quantity_t('cycle_front_twist_order_H', 'rad', 'amplitude at order H of the twist of the first station against the '// &
      'driven one in the last cycle'), &
    quantity_t('cycle_segment_J_torque_order_H', 'N.m', 'amplitude at order H of the torque of segment J in the last cycle'), &
    quantity_t('cycle_max_segment_J_torque', 'N.m', 'largest torque of segment J of the crankshaft in the last cycle'), &
    quantity_t('cycle_max_station_J_twist', 'rad', &
      'largest twist of station J against the crank of the full cylinder in the last cycle'), &
    quantity_t('max_segment_J_torque', 'N.m', 'largest torque of segment J of the crankshaft'), &
    quantity_t('max_station_J_twist', 'rad', 'largest twist of station J against the crank of the full cylinder'), &
    quantity_t('version', '', 'version of the program'), &
    quantity_t('compiler', '', 'compiler of the program'), &
    quantity_t('compiler_options', '', 'its options')]

  type(quantity_t), parameter :: of_certificates(*) = [ &
    quantity_t('certificate', '', 'why there is no certificate (`--certify`)'), &
    quantity_t('certificate_note', '', 'results that are not certified'), &
    quantity_t('certified_until', 's', 'up to here no coordinate or speed is off by more than 1e-3 of its range'), &
    quantity_t('certified_digits', '1', 'correct digits of the state up to there, median over time'), &
    quantity_t('state_error', '1', 'largest error of the state up to there, over the range of each component'), &
    quantity_t('certified_with_other_method', '', 'whether the run with another method could be compared: yes or no'), &
    quantity_t('NAME_difference', '', &
      'largest difference of NAME, a result of the whole run or of its last whole cycle, in the two closer runs; in its unit')]

  !> Quantities of a summary, in their order.
  type(quantity_t), parameter :: quantities_of_runs(*) = [of_integration, of_motion, of_joints, &
    cycle_quantities, of_certificates]

  !> Columns of NAME.events.csv, in their order.
  type(quantity_t), parameter :: event_columns(*) = [ &
    quantity_t('time', 's', 'instant of the event'), &
    quantity_t('crank_angle', 'rad', 'crank angle then'), &
    quantity_t('event', '', '`contact_begins` or `contact_ends`'), &
    quantity_t('normal_speed', 'm/s', &
      'normal speed d|e|/dt at the event: positive when a contact begins, negative when it ends'), &
    quantity_t('duration', 's', 'duration of the contact (contact_ends only)'), &
    quantity_t('max_penetration', 'm', 'its deepest penetration (contact_ends only)'), &
    quantity_t('max_normal_force', 'N', 'its largest contact force (contact_ends only)'), &
    quantity_t('joint', '', '`piston_pin`, `small_end`, `crank_pin` or a corner of the skirt, `guide_1` to `guide_4`')]

  !> Columns of NAME.wear.csv, in their order.
  type(quantity_t), parameter :: wear_columns(*) = [ &
    quantity_t('joint', '', '`piston_pin`, `small_end` or `crank_pin`'), &
    quantity_t('angle', 'deg', 'middle of the bin, from x towards y in the frame of the body when its own angle is 0'), &
    quantity_t('pin_depth', 'm', 'mean depth worn from this bin of the pin'), &
    quantity_t('bore_depth', 'm', 'mean depth worn from this bin of the bore'), &
    quantity_t('pin_volume', 'm3', 'volume worn from this bin of the pin'), &
    quantity_t('bore_volume', 'm3', 'volume worn from this bin of the bore')]

  !> Columns of NAME.runs.csv and NAME.cycles.csv of a study, beside those of its parameters: of the whole revolutions after
  !> `settle_cycles`, or of one revolution. Columns of the crank pin have the prefix `crank_pin_`, those of the corners of the skirt
  !> together `guide_`.
  type(quantity_t), parameter :: study_columns(*) = [ &
    quantity_t('run', '', 'number of the run, from 1'), &
    quantity_t('status', '', &
      '`done`, or why the run failed; `no whole revolution after settle_cycles`: the run is too short, or the crank stopped'), &
    quantity_t('cycles', '-', 'revolutions that the statistics are of'), &
    quantity_t('min_film_thickness', 'm', 'smallest film thickness; negative: penetration'), &
    quantity_t('min_film_thickness_mean', 'm', 'mean over the revolutions of the smallest film thickness of each'), &
    quantity_t('contact_time_fraction', '-', 'share of the time in contact'), &
    quantity_t('impacts', '-', 'contacts that begin in a revolution, on average'), &
    quantity_t('max_penetration', 'm', 'deepest penetration'), &
    quantity_t('max_pin_force', 'N', 'largest pin force'), &
    quantity_t('max_pin_force_mean', 'N', 'mean over the revolutions of the largest pin force of each'), &
    quantity_t('mean_pin_force', 'N', 'mean over time of the pin force'), &
    quantity_t('mean_crank_speed', 'rad/s', 'mean crank speed'), &
    quantity_t('dissipated_energy', 'J', 'energy that the joints take from the bodies in a revolution'), &
    quantity_t('energy_residual', '-', 'relative energy residual: the integration error'), &
    quantity_t('rhs_evaluations', '-', 'evaluations of the right-hand side'), &
    quantity_t('simulated_time', 's', 'simulated time'), &
    quantity_t('notes', '-', 'notes on implausible values and results, which a run of the case alone prints'), &
    quantity_t('strobes', '-', 'rows of this run in NAME.strobe.csv (`strobe_columns`)'), &
    quantity_t('max_force', 'N', 'largest force of a corner of the skirt'), &
    quantity_t('max_force_mean', 'N', 'mean over the revolutions of the largest force of each'), &
    quantity_t('period_revolutions', '-', 'period of the motion in revolutions, 0: not periodic (`run.until = ''periodic''`)'), &
    quantity_t('lyapunov_exponent', '1/revolution', 'largest Lyapunov exponent (`run.lyapunov_revolutions`)'), &
    quantity_t('lyapunov_exponent_error', '1/revolution', 'its standard error'), &
    quantity_t('worn_volume_pin', 'm3', 'volume worn from the pin in the whole run, also before `settle_cycles`'), &
    quantity_t('worn_volume_bore', 'm3', 'volume worn from the bore'), &
    quantity_t('max_wear_depth_pin', 'm', 'largest mean depth of a bin on the pin'), &
    quantity_t('max_wear_depth_bore', 'm', 'the same on the bore'), &
    quantity_t('cycle', '', 'number of the revolution from the start of the run, from 1 (NAME.cycles.csv)'), &
    quantity_t('duration', 's', 'its duration (NAME.cycles.csv)')]

contains

  !> The unit of a quantity of a table; `?` if it has none of that name.
  pure function unit_of(table, name) result(unit)
    type(quantity_t), intent(in) :: table(:)
    character(len=*), intent(in) :: name
    character(len=:), allocatable :: unit
    integer :: i
    unit = '?'
    do i = 1, size(table)
      if (table(i)%name /= name) cycle
      unit = trim(table(i)%unit)
      return
    end do
  end function unit_of
end module summary_quantities
