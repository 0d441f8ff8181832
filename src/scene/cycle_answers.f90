!> The answers of a cycle: what the last whole cycle of a run gives, by bearing and for the machine, and the work done in it.
!>
!> The cycle is the period of the motion if one was found, else that of the gas, else one revolution. It ends where the run last
!> completed a revolution. Work is that on the bodies, so losses are negative.
module cycle_answers
  use kinds, only: dp
  use run_length, only: longest_period
  use constants, only: two_pi
  use load_element, only: of_contact, of_friction, of_film, of_asperities
  use chain_motion, only: body_pin
  use joint_places, only: name_prefix, spot_name
  use scene_problem, only: scene_t, by_gas, by_drive, by_damping, by_guide, by_elastic
  use cycle_statistics, only: cycle_t
  use cycle_watch, only: cycle_watch_t
  use period_watch, only: period_watch_t
  use run_extremes, only: run_extremes_t
  use piston_skirt, only: n_corners, corner_names
  use ring_case, only: most_piston_rings
  use text_tools, only: integer_text
  use result_ledger, only: kept_result_t, find_result, degrees_in_cycle
  use archard_wear, only: of_pin, of_bore
  use gas_cycle, only: released_share
  use ideal_linkage, only: linkage_t
  use cylinder_charge, only: of_balance, to_walls, leaked, leaked_enthalpy, moved, delivered, delivered_heat, suction_loss, &
    discharge_loss, work_on_gas
  use flow_valve, only: flow_valve_t, suction, discharge
  use valve_reeds, only: ports
  use film_heat, only: temperature_sum, heat_to_oil, heat_to_housing
  implicit none
  private
  public :: answer_t, quantity_t, find_answers, cycle_quantities

  !> What a result is.
  type :: quantity_t
    character(len=48) :: name = ''
    character(len=14) :: unit = ''    !! unit as in the file; 1: a number without unit; empty: a text
    character(len=170) :: meaning = ''
  end type quantity_t

  !> An answer of one run.
  type :: answer_t
    integer :: quantity = 0           !! index in `cycle_quantities`
    integer :: place = 0              !! spot of the joint (`joint_places`); 0: of the machine
    real(dp) :: value = 0
    character(len=16) :: text = ''    !! instead of the value, of a quantity without unit
  end type answer_t

  !> Parts of the work, and their quantities.
  integer, parameter :: parts(*) = [by_gas, by_drive, by_damping, of_contact, of_friction, of_film, of_asperities, by_guide, &
    by_elastic]
  character(len=21), parameter :: work_of_parts(size(parts)) = [character(len=21) :: 'cycle_work_gas', 'cycle_work_drive', &
    'cycle_work_damping', 'cycle_work_contact', 'cycle_work_friction', 'cycle_work_film', 'cycle_work_asperities', &
    'cycle_work_guide', 'cycle_work_elastic']

  !> All quantities; those of a joint get its place as a prefix.
  type(quantity_t), parameter :: cycle_quantities(*) = [ &
    quantity_t('cycle_start', 's', 'beginning of the last whole cycle of the run; `cycle_...` is of this cycle alone'), &
    quantity_t('cycle_duration', 's', 'its duration'), &
    quantity_t('cycle_revolutions', '1', 'its revolutions: the period of the motion if one was found, else of the gas, else 1'), &
    quantity_t('cycle_change', '1', &
      'largest difference of the state from one cycle earlier, over the range of each component'), &
    quantity_t('cycle_is_settled', '', &
      '`yes`, `no` (that is above `periodic_tolerance`) or `unknown` (the run has only one whole cycle)'), &
    quantity_t('cycle_max_eccentricity_ratio', '1', 'largest eccentricity in the cycle over the clearance'), &
    quantity_t('cycle_contact_share', '1', 'share of the cycle in contact'), &
    quantity_t('cycle_asperity_load_share', '1', &
      'load of the asperities over the whole force, both integrated over the cycle; with `report`'), &
    quantity_t('cycle_mean_film_power', 'W', 'mean power that the film takes from the bodies in the cycle'), &
    quantity_t('cycle_mean_friction_power', 'W', 'the same of the friction of contact and asperities'), &
    quantity_t('cycle_mean_friction_moment', 'N.m', &
      'these losses in the cycle over the angle that the pin turns through in its bearing, in either sense'), &
    quantity_t('cycle_turning', 'rad', 'angle that a floating pin turns through in this bearing in the cycle, in either sense'), &
    quantity_t('cycle_joint_fmep', 'Pa', 'these losses in the cycle over the displacement of all cylinders'), &
    quantity_t('cycle_mean_film_temperature', 'K', 'mean temperature of the film in the cycle, with `&heat`'), &
    quantity_t('cycle_heat_to_oil', 'J', 'heat that the oil carries out of the film in the cycle'), &
    quantity_t('cycle_heat_to_housing', 'J', 'heat that flows from the film to the housing in the cycle'), &
    quantity_t('cycle_wear_depth_rate_pin', 'm/h', &
      'largest depth by which a bin of the pin has worn in the cycle, in an hour of such cycles; without `extrapolation`'), &
    quantity_t('cycle_wear_depth_rate_bore', 'm/h', 'the same on the bore'), &
    quantity_t('cycle_wear_depth_100h_pin', 'm', 'the same on the pin, in 100 hours of such cycles'), &
    quantity_t('cycle_wear_depth_100h_bore', 'm', 'the same on the bore'), &
    quantity_t('cycle_mean_crank_speed', 'rad/s', 'angle that the crank turns through in the cycle over its duration'), &
    quantity_t('cycle_pin_turn', 'rad', 'angle by which a floating pin turns in the cycle, positive from x to y'), &
    quantity_t('cycle_speed_fluctuation', '1', 'largest minus smallest crank speed in the cycle, over the mean'), &
    quantity_t('cycle_slap_impacts', '1', 'contacts of the corners of the skirt with the bore that began in the cycle'), &
    quantity_t('cycle_slap_speed', 'm/s', 'largest speed at which one of them began: the hardest slap'), &
    quantity_t('cycle_slap_angle', 'deg', 'crank angle then, from 0 to the length of the cycle'), &
    quantity_t('cycle_slap_corner', '', 'which corner it was, `guide_1` to `guide_4`'), &
    quantity_t('cycle_slap_energy', 'J', &
      'largest kinetic energy of the piston across its bore and of its tilt when one of them began'), &
    quantity_t('cycle_bearings_power', 'W', 'losses of all bearings of kind quasi_static in the cycle over its duration, of a '// &
      'case with numbered bearings'), &
    quantity_t('cycle_thinnest_bearing', '', 'which of these bearings has the thinnest film in the cycle: main_bearing_3'), &
    quantity_t('cycle_mean_piston_speed', 'm/s', 'two strokes of the ideal mechanism in the mean time of a revolution'), &
    quantity_t('cycle_max_cylinder_pressure', 'Pa', &
      'largest pressure of the gas in the cycle, in the cylinder of the mechanism itself'), &
    quantity_t('cycle_max_cylinder_pressure_angle', 'deg', 'crank angle then, from 0 to the length of the cycle'), &
    quantity_t('cycle_indicated_power', 'W', 'work of the gas on the piston in the cycle over its duration'), &
    quantity_t('cycle_brake_power', 'W', &
      'power through the shaft, by drive and damping, less the losses of quasi-static bearings; negative: it is driven'), &
    quantity_t('cycle_imep', 'Pa', 'work of the gas in a cycle of the gas over the displacement'), &
    quantity_t('cycle_heat_released', 'J', &
      'heat that combustion releases in the cylinder of the mechanism in a cycle of the gas'), &
    quantity_t('cycle_heat_to_walls', 'J', 'heat of that gas to the walls in a cycle of the gas, with `&wall_heat`'), &
    quantity_t('cycle_leak_share', '1', 'mass that leaks from that cylinder in a cycle of the gas over that closed in'), &
    quantity_t('cycle_leak_enthalpy', 'J', 'enthalpy that leaves with it'), &
    quantity_t('cycle_opening_temperature', 'K', 'temperature of that gas when the cylinder opened, with `&working_gas`'), &
    quantity_t('cycle_indicated_efficiency', '1', 'work of the gas over the heat that combustion releases in all cylinders'), &
    quantity_t('cycle_gas_energy_residual', '1', 'energy of the gas less what it received by heat, work and leak in the cycle, '// &
      'over the size of its work: the error of the integration'), &
    quantity_t('cycle_mass_flow', 'kg/s', 'gas that the cylinder of a compressor delivers through its discharge valve, with '// &
      '`&working_gas`'), &
    quantity_t('recent_mass_flow', 'kg/s', 'that in the mean of the last revolutions: of the second half of a run, 16 at most'), &
    quantity_t('recent_mass_flow_scatter', '1', 'largest less least flow of the cycles in these revolutions, over their mean'), &
    quantity_t('cycle_volumetric_efficiency', '1', '`cycle_mass_flow` over the displacement full of gas of the suction chamber'), &
    quantity_t('cycle_isentropic_efficiency', '1', 'work of the isentropic compression of that gas over the work on the gas'), &
    quantity_t('cycle_discharge_temperature', 'K', 'mean temperature of that gas, by its mass'), &
    quantity_t('cycle_suction_loss', 'W', 'power lost in the suction valve: by pressures below that of suction'), &
    quantity_t('cycle_discharge_loss', 'W', 'power lost in the discharge valve: by pressures above that of discharge'), &
    quantity_t('cycle_max_suction_valve_lift', 'm', 'largest lift of the suction valve in the cycle'), &
    quantity_t('cycle_max_discharge_valve_lift', 'm', 'largest lift of the discharge valve in the cycle'), &
    quantity_t('cycle_max_suction_valve_speed', 'm/s', &
      'largest speed at which the suction valve meets its seat or its stop in the cycle, with `mass`'), &
    quantity_t('cycle_max_discharge_valve_speed', 'm/s', 'the same of the discharge valve'), &
    quantity_t('cycle_open_valve', '', &
      'which valve is open through the whole cycle, `suction` or `discharge`; not told if both of them shut'), &
    quantity_t('cycle_leak_flow', 'kg/s', 'mean flow past the rings of a compressor'), &
    quantity_t('cycle_wall_heat_flow', 'W', 'mean heat of its gas to the walls'), &
    quantity_t('cycle_bmep', 'Pa', 'the same of the brake power'), &
    quantity_t('cycle_fmep', 'Pa', 'the same of the losses in joints, guide and elastic members'), &
    quantity_t('cycle_one_way_fmep', 'Pa', &
      'the part of it in bearings of kind quasi_static, which is not fed back: the motion does not feel it'), &
    quantity_t('cycle_skirt_fmep', 'Pa', 'the part of FMEP by film and asperities of a lubricated skirt'), &
    quantity_t('cycle_ring_fmep', 'Pa', 'the part of FMEP by the friction of the piston rings'), &
    quantity_t('cycle_ring_1_fmep', 'Pa', 'that of the first piston ring from the top'), &
    quantity_t('cycle_ring_2_fmep', 'Pa', 'that of the second one'), &
    quantity_t('cycle_ring_3_fmep', 'Pa', 'that of the third one'), &
    quantity_t('cycle_ring_4_fmep', 'Pa', 'that of the fourth one'), &
    quantity_t('cycle_ring_5_fmep', 'Pa', 'that of the fifth one'), &
    quantity_t('cycle_ring_6_fmep', 'Pa', 'that of the sixth one'), &
    quantity_t('cycle_work_gas', 'J', 'work of the gas on the piston in the cycle'), &
    quantity_t('cycle_work_drive', 'J', 'work of the driving torque, or of the moment that holds the speed'), &
    quantity_t('cycle_work_damping', 'J', 'work of the damping of the drive'), &
    quantity_t('cycle_work_contact', 'J', 'work of the normal forces of the contact, and of elastic walls'), &
    quantity_t('cycle_work_friction', 'J', 'work of the friction of the contact'), &
    quantity_t('cycle_work_film', 'J', 'work of the film'), &
    quantity_t('cycle_work_asperities', 'J', 'work of the asperities, with their friction'), &
    quantity_t('cycle_work_guide', 'J', &
      'work of the guide: friction of the bore and of piston rings, loads of the corners of the skirt'), &
    quantity_t('cycle_work_elastic', 'J', 'work of the damping of rod and crankshaft'), &
    quantity_t('cycle_energy_change', 'J', 'change of kinetic, potential and elastic energy in the cycle'), &
    quantity_t('cycle_work_rest', 'J', 'that change less all work in the cycle: the error of the integration')]

contains

  !> The answers of a run that has ended; none if it has no whole cycle. The scene must tell the parts of the work apart.
  function find_answers(scene, cycles, periods, extremes, kept_results) result(answers)
    type(scene_t), intent(in) :: scene
    type(cycle_watch_t), intent(in) :: cycles
    type(period_watch_t), intent(in) :: periods
    type(run_extremes_t), intent(in) :: extremes
    type(kept_result_t), intent(in) :: kept_results(:)   !! those of columns
    type(answer_t), allocatable :: answers(:)
    type(cycle_t) :: cycle
    real(dp) :: displacement   !! swept in all cycles of the gas in this cycle [m^3]
    real(dp) :: loss, shaft, one_way
    integer :: revolutions, i
    allocate (answers(0))
    revolutions = periods%cycle_revolutions()
    if (.not. cycles%has_cycle(revolutions)) return
    cycle = cycles%last_cycle(revolutions)
    displacement = 0
    if (allocated(scene%gas)) displacement = scene%gas%cylinder%displacement*revolutions/scene%forced_revolutions()
    if (allocated(scene%chain%train)) displacement = displacement*(1 + size(scene%chain%train%cylinders))

    call add('cycle_start', cycle%start)
    call add('cycle_duration', cycle%duration)
    call add('cycle_revolutions', real(revolutions, dp))
    call add_change(periods%change(revolutions))
    do i = 1, size(scene%joints)
      call add_joint(i)
    end do
    call add_machine()
    do i = 1, scene%n_works
      call add(trim(work_of_parts(findloc(parts, scene%parts(i)%what, 1))), cycle%work(i), scene%parts(i)%joint)
    end do
    if (allocated(scene%given_load)) return
    call add('cycle_energy_change', cycle%energy_change)
    call add('cycle_work_rest', cycle%energy_change - sum(cycle%work(:scene%n_works)))

  contains

    subroutine add(name, value, joint)
      character(len=*), intent(in) :: name   !! of a quantity
      real(dp), intent(in) :: value
      integer, intent(in), optional :: joint   !! 0 or absent: not of a joint
      type(answer_t) :: answer
      answer%quantity = index_of(name)
      answer%value = value
      if (present(joint)) then
        if (joint > 0) answer%place = scene%joints(joint)%spot
      end if
      answers = [answers, answer]
    end subroutine add

    pure integer function index_of(name)
      character(len=*), intent(in) :: name
      do index_of = size(cycle_quantities), 1, -1
        if (cycle_quantities(index_of)%name == name) return
      end do
    end function index_of

    subroutine add_change(change)
      real(dp), intent(in) :: change   !! negative: not known
      if (change >= 0) call add('cycle_change', change)
      call add('cycle_is_settled', 0.0_dp)
      answers(size(answers))%text = 'unknown'
      if (change >= 0) answers(size(answers))%text = merge('yes', 'no ', change <= periods%tolerance)
    end subroutine add_change

    !> Work of one kind in a joint, or of another part [J].
    pure real(dp) function work_of(what, joint) result(work)
      integer, intent(in) :: what
      integer, intent(in), optional :: joint
      integer :: k
      work = 0
      do k = 1, size(scene%parts)
        if (scene%parts(k)%what /= what) cycle
        if (present(joint)) then
          if (scene%parts(k)%joint /= joint) cycle
        end if
        work = work + cycle%work(k)
      end do
    end function work_of

    subroutine add_joint(i)
      integer, intent(in) :: i
      real(dp) :: film, friction, load, worn(2)
      associate (joint => scene%joints(i), pin => cycle%pin(scene%joints(i)%spot))
        if (.not. joint%has_own_gap) &
          call add('cycle_max_eccentricity_ratio', 1 - pin%min_film_thickness/joint%bearing%clearance, i)
        call add('cycle_contact_share', pin%contact_time/cycle%duration, i)
        film = work_of(of_film, i)
        friction = work_of(of_friction, i) + work_of(of_asperities, i)
        if (joint%has_kind(of_film)) call add('cycle_mean_film_power', -film/cycle%duration, i)
        if (joint%has_kind(of_friction) .or. joint%has_kind(of_asperities)) &
          call add('cycle_mean_friction_power', -friction/cycle%duration, i)
        if (pin%turning > 0) call add('cycle_mean_friction_moment', -(film + friction)/pin%turning, i)
        if (joint%site%pin_body == body_pin) call add('cycle_turning', pin%turning, i)
        if (displacement > 0) call add('cycle_joint_fmep', -(film + friction)/displacement, i)
        worn = extremes%wear_growth(scene, joint%spot, revolutions)*3600/cycle%duration
        if (all(worn >= 0)) call add('cycle_wear_depth_rate_pin', worn(of_pin), i)
        if (all(worn >= 0)) call add('cycle_wear_depth_rate_bore', worn(of_bore), i)
        if (all(worn >= 0)) call add('cycle_wear_depth_100h_pin', 100*worn(of_pin), i)
        if (all(worn >= 0)) call add('cycle_wear_depth_100h_bore', 100*worn(of_bore), i)
        if (allocated(joint%heat)) then
          call add('cycle_mean_film_temperature', pin%heat(temperature_sum)/cycle%duration, i)
          call add('cycle_heat_to_oil', pin%heat(heat_to_oil), i)
          call add('cycle_heat_to_housing', pin%heat(heat_to_housing), i)
        end if
        load = kept(name_prefix(joint%spot), 'mean_pin_force')
        if (joint%reports_film .and. joint%has_kind(of_asperities) .and. load > 0) call add('cycle_asperity_load_share', &
          kept(name_prefix(joint%spot), 'mean_asperity_force')/load, i)
      end associate
    end subroutine add_joint

    subroutine add_machine()
      type(linkage_t) :: linkage
      real(dp) :: mean_speed
      mean_speed = two_pi*revolutions/cycle%duration
      call add('cycle_mean_crank_speed', cycles%direction*mean_speed)
      if (allocated(scene%chain%floating)) call add('cycle_pin_turn', cycle%pin_turn)
      call add('cycle_speed_fluctuation', (kept('', 'max_crank_speed') - kept('', 'min_crank_speed'))/mean_speed)
      if (allocated(scene%given_load)) return
      if (allocated(scene%guide)) then
        if (scene%guide%touching > 0) call add_slap()
      end if
      associate (bodies => scene%chain%bodies)
        linkage = linkage_t(bodies%crank%length, bodies%rod%length, bodies%piston%axis_offset)
      end associate
      call add('cycle_mean_piston_speed', 2*linkage%stroke()*revolutions/cycle%duration)
      one_way = -sum(cycle%work(scene%n_works + 1:size(scene%parts)))    ! by bearings that the mechanism does not feel
      if (scene%has_numbers) call add_bearings()
      if (.not. allocated(scene%gas)) return
      if (scene%gas%has_force .and. .not. scene%has_charge) then   ! else that is kept of its column
        call add('cycle_max_cylinder_pressure', cycle%max_pressure)
        call add('cycle_max_cylinder_pressure_angle', degrees_in_cycle(cycle%max_pressure_angle, revolutions))
      end if
      shaft = -work_of(by_drive) - work_of(by_damping)
      loss = work_of(by_gas) - shaft - sum(cycle%work(:scene%n_works)) + one_way   ! by what is neither gas nor shaft
      shaft = shaft - one_way
      call add('cycle_indicated_power', work_of(by_gas)/cycle%duration)
      call add('cycle_brake_power', shaft/cycle%duration)
      call add('cycle_imep', work_of(by_gas)/displacement)
      if (allocated(scene%gas%cycle)) call add('cycle_heat_released', &
        scene%gas%cycle%release%heat*released_share(scene%gas%cycle%release%efficiency))
      if (allocated(scene%gas%valves)) then
        call add_ideal_compressor()
      else if (allocated(scene%gas%charge)) then
        call add_charge(real(revolutions, dp)/scene%forced_revolutions())
      end if
      call add('cycle_bmep', shaft/displacement)
      call add('cycle_fmep', loss/displacement)
      if (scene%n_works < size(scene%parts)) &
        call add('cycle_one_way_fmep', one_way/displacement)
      call add_own_fmep('skirt')
      call add_own_fmep('ring')
      do i = 1, most_piston_rings
        call add_own_fmep('ring_'//integer_text(i))
      end do
    end subroutine add_machine

    !> The mean effective pressure of a part of the guide that keeps its mean power, if there is one: of the film of the skirt, of a
    !> ring, of all rings.
    subroutine add_own_fmep(name)
      character(len=*), intent(in) :: name   !! of the part
      real(dp) :: power
      logical :: is_known
      call find_result(kept_results, 'cycle_mean_'//name//'_power', power, is_known)
      if (is_known) call add('cycle_'//name//'_fmep', power*cycle%duration/displacement)
    end subroutine add_own_fmep

    !> The losses of all quasi-static bearings, and the one with the thinnest film; of equal ones the first.
    subroutine add_bearings()
      real(dp), parameter :: same = 1e-4_dp   ! difference of films of equal bearings
      integer :: thinnest
      call add('cycle_bearings_power', one_way/cycle%duration)
      thinnest = scene%carried(1)%joint
      do i = 2, size(scene%carried)
        if (thickness(scene%carried(i)%joint) < (1 - same)*thickness(thinnest)) thinnest = scene%carried(i)%joint
      end do
      call add('cycle_thinnest_bearing', 0.0_dp)
      answers(size(answers))%text = spot_name(scene%joints(thinnest)%spot)
    end subroutine add_bearings

    pure real(dp) function thickness(joint)
      integer, intent(in) :: joint
      thickness = cycle%pin(scene%joints(joint)%spot)%min_film_thickness
    end function thickness

    !> The gas that has a mass.
    subroutine add_charge(cycles)
      real(dp), intent(in) :: cycles   !! of the gas in this cycle
      real(dp) :: heat   !! released in all cylinders in a cycle of the gas, but for the share that does not burn [J]
      associate (gas => scene%gas)
        if (gas%charge%is_state) call add('cycle_gas_energy_residual', cycle%gas(of_balance)/cycle%gas(moved))
        if (allocated(gas%charge%valves)) then
          call add_compressor()
          return
        end if
        if (allocated(gas%charge%walls)) call add('cycle_heat_to_walls', cycle%gas(to_walls)/cycles)
        if (gas%charge%loses_gas()) call add('cycle_leak_share', cycle%gas(leaked)/cycles/gas%charge%closed_mass)
        if (gas%charge%loses_gas()) call add('cycle_leak_enthalpy', cycle%gas(leaked_enthalpy)/cycles)
        if (cycle%opening_temperature > 0) call add('cycle_opening_temperature', cycle%opening_temperature)
        heat = merge(gas%cycle%release%heat, 0.0_dp, gas%has_force)
        if (allocated(scene%other_gas)) heat = heat + scene%other_gas%heat(gas)
        if (heat > 0) call add('cycle_indicated_efficiency', &
          work_of(by_gas)/(cycles*heat*released_share(gas%cycle%release%efficiency)))
      end associate
    end subroutine add_charge

    !> The flow of a compressor with ideal valves.
    subroutine add_ideal_compressor()
      real(dp) :: delivered_volume   !! of gas at suction, in the cycle [m^3]
      associate (valves => scene%gas%valves)
        call add('cycle_volumetric_efficiency', valves%volumetric_efficiency())
        if (.not. allocated(scene%gas%charge)) return
        delivered_volume = valves%volumetric_efficiency()*valves%cylinder%displacement*revolutions
        associate (charge => scene%gas%charge)
          call add('cycle_mass_flow', charge%fresh_mass(delivered_volume)/cycle%duration)
          if (delivered_volume > 0) call add('cycle_discharge_temperature', &
            charge%delivery_temperature(valves%discharge_pressure, valves%exponent))
        end associate
      end associate
    end subroutine add_ideal_compressor

    !> The flow of a compressor, what it does to the gas, and its losses.
    subroutine add_compressor()
      real(dp) :: ideal   !! isentropic work on a mass [J/kg]
      associate (charge => scene%gas%charge, chamber => scene%gas%charge%chamber, g => scene%gas%charge%chamber%heat_capacity_ratio)
        ideal = g/(g - 1)*chamber%gas_constant*chamber%closing_temperature* &
          ((charge%discharge_pressure/chamber%closing_pressure)**((g - 1)/g) - 1)
        call add('cycle_mass_flow', cycle%gas(delivered)/cycle%duration)
        call add_recent_flow()
        call add('cycle_volumetric_efficiency', cycle%gas(delivered)*chamber%gas_constant*chamber%closing_temperature/ &
          (chamber%closing_pressure*chamber%displacement*revolutions))
        if (cycle%gas(work_on_gas) > 0) call add('cycle_isentropic_efficiency', cycle%gas(delivered)*ideal/cycle%gas(work_on_gas))
        if (cycle%gas(delivered) > 0) call add('cycle_discharge_temperature', cycle%gas(delivered_heat)/cycle%gas(delivered))
        call add('cycle_suction_loss', cycle%gas(suction_loss)/cycle%duration)
        call add('cycle_discharge_loss', cycle%gas(discharge_loss)/cycle%duration)
        if (scene%gas%has_force) then
          call add_lift(suction, charge%valves(suction), chamber%closing_pressure - [kept('', 'min_cylinder_pressure'), &
            kept('', 'max_cylinder_pressure')])
          call add_lift(discharge, charge%valves(discharge), [kept('', 'max_cylinder_pressure'), &
            kept('', 'min_cylinder_pressure')] - charge%discharge_pressure)
        end if
        if (charge%loses_gas()) call add('cycle_leak_flow', cycle%gas(leaked)/cycle%duration)
        if (allocated(charge%walls)) call add('cycle_wall_heat_flow', cycle%gas(to_walls)/cycle%duration)
      end associate
    end subroutine add_compressor

    !> The flow in the mean of the last cycles and its scatter among them: valves that flutter deliver another mass in each.
    subroutine add_recent_flow()
      type(cycle_t) :: one
      real(dp) :: flow(longest_period), mean
      integer :: n, k
      n = min(longest_period, cycles%followed/2)/revolutions
      if (n < 2) return
      do k = 1, n
        one = cycles%last_cycle(revolutions, (k - 1)*revolutions)
        flow(k) = one%gas(delivered)/one%duration
      end do
      mean = sum(flow(:n))/n
      call add('recent_mass_flow', mean)
      if (mean > 0) call add('recent_mass_flow_scatter', (maxval(flow(:n)) - minval(flow(:n)))/mean)
    end subroutine add_recent_flow

    !> The largest lift of a valve, the speed of its impacts if it has a mass, and whether it does not shut; without mass from the
    !> largest and the least difference of the pressures on it [Pa].
    subroutine add_lift(port, valve, difference)
      integer, intent(in) :: port
      type(flow_valve_t), intent(in) :: valve
      real(dp), intent(in) :: difference(2)
      real(dp) :: least_lift
      if (valve%mass > 0) then   ! the largest lift is kept of its column
        least_lift = kept('', 'min_'//trim(ports(port))//'_valve_lift')
        call add('cycle_max_'//trim(ports(port))//'_valve_speed', cycle%valve_speed(port))
      else
        least_lift = valve%lift*valve%open_share(difference(2))
        call add('cycle_max_'//trim(ports(port))//'_valve_lift', valve%lift*valve%open_share(difference(1)))
      end if
      if (.not. least_lift > 0) return
      call add('cycle_open_valve', 0.0_dp)
      answers(size(answers))%text = ports(port)
    end subroutine add_lift

    !> The hardest impact of the skirt in the cycle.
    subroutine add_slap()
      integer :: hardest
      hardest = maxloc([(kept(corner_names(i)//'_', 'max_impact_speed'), i=1, n_corners)], 1)
      call add('cycle_slap_impacts', sum([(kept(corner_names(i)//'_', 'impacts'), i=1, n_corners)]))
      if (.not. kept(corner_names(hardest)//'_', 'max_impact_speed') > 0) return
      call add('cycle_slap_speed', kept(corner_names(hardest)//'_', 'max_impact_speed'))
      call add('cycle_slap_angle', kept(corner_names(hardest)//'_', 'max_impact_speed_angle'))
      call add('cycle_slap_corner', 0.0_dp)
      answers(size(answers))%text = corner_names(hardest)
      call add('cycle_slap_energy', maxval([(kept(corner_names(i)//'_', 'max_impact_energy'), i=1, n_corners)]))
    end subroutine add_slap

    !> A result that is kept of a column, over this cycle; 0 if the scene does not have it.
    pure real(dp) function kept(place, name)
      character(len=*), intent(in) :: place, name   !! prefix of the place
      logical :: is_known
      call find_result(kept_results, place//'cycle_'//name, kept, is_known)
    end function kept
  end function find_answers
end module cycle_answers
