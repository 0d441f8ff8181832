!> Notes on the results of a run: what no machine can do, and what the models do not describe.
module result_notes
  use kinds, only: dp
  use constants, only: two_pi
  use film_history, only: film_history_t
  use simulation, only: run_report_t
  use run_figures, only: pin_figures_t
  use joint_places, only: n_places, in_order, piston_pin, small_end, spot_title
  use case_definition, only: case_t
  use joint_case, only: joint_case_t
  use number_text, only: short_text, quantity_text
  implicit none
  private
  public :: notes_on_results, history_remarks, relative_residual, energy_warning, no_exponent, most_change, &
    pin_is_undecided, undecided_pin

  character(len=*), parameter :: undecided_pin = 'the friction of both dry bearings of the floating pin has the same moment: '// &
    'nothing decides in which one it turns, and its drift follows from inertia and the friction law near rest alone'
  real(dp), parameter :: longest_cycle = 2*two_pi      !! of a machine [rad]
  real(dp), parameter :: thinnest_film = 10e-9_dp      !! below this oil is no continuous fluid, and no surface is smooth [m]
  real(dp), parameter :: smoothest = 0.1e-6_dp         !! roughness of polished surfaces [m]
  character(len=*), parameter :: no_exponent = 'no Lyapunov exponent: '
  real(dp), parameter :: least_cells_per_gap = 4       !! with fewer cells the thinnest part of a film is not resolved
  real(dp), parameter :: least_period_tolerance = 10   !! of a periodic motion, over the relative tolerance of its integration
  real(dp), parameter :: largest_pressure = 5e9_dp     !! beyond the strength of every bearing [Pa]
  real(dp), parameter :: most_energy_change = 0.02_dp  !! in a cycle, of the work of the gas: more is no settled motion
  real(dp), parameter :: most_change = 0.05_dp         !! of a flow or a film thickness from cycle to cycle, of a settled run
  character(len=*), parameter :: too_much = ': no bearing carries it'

contains

  !> Notes on the results, one line each; empty if there are none.
  function notes_on_results(case, report) result(notes)
    type(case_t), intent(in) :: case
    type(run_report_t), intent(in) :: report
    character(len=:), allocatable :: notes
    integer, allocatable :: spots(:)
    integer :: i, k
    notes = ''
    do i = 1, n_places
      spots = case%spots(in_order(i))
      do k = 1, size(spots)
        call note_joint(case%joints(in_order(i)), report%figures%pin(spots(k)), spot_title(spots(k))//': ')
      end do
    end do
    if (allocated(report%histories)) then
      do i = 1, size(report%histories)
        associate (film => report%histories(i)%history)
          if (history_remarks(film) /= '') call add_line(history_remarks(film))
        end associate
      end do
    end if
    if (report%energy_is_poor) call add_line(energy_warning(case, report))
    if (report%heat_is_poor) call add_line('the heat of a film is kept only to '//short_text(report%figures%heat_residual())// &
      ': compare with a run with a tenth of &integrator relative_tolerance')
    if (report%gas_is_poor) call add_line('the energy of the gas is kept only to '//short_text(report%figures%gas_residual)// &
      ': compare with a run with a tenth of &integrator relative_tolerance')
    call note_gas()
    call note_skirt()
    call note_period()
    call note_power()
    call note_torque_table()
    if (report%figures%floating%is_present .and. pin_is_undecided(case)) call add_line(undecided_pin)
    if (.not. report%exponent%is_known .and. allocated(report%exponent%reason)) &
      call add_line(no_exponent//report%exponent%reason)
    if (notes /= '') notes = notes(:len(notes) - 1)

  contains

    subroutine add_line(text)
      character(len=*), intent(in) :: text
      notes = notes//text//achar(10)
    end subroutine add_line

    !> A leak of worn rings, temperatures of no gas in a cylinder, a compressor that does not deliver, a valve that does not shut,
    !> valves that move otherwise in each cycle.
    subroutine note_gas()
      real(dp), parameter :: largest_share = 0.1_dp, hottest = 4000, coldest = 150   ! [-], [K], [K]
      real(dp), parameter :: grams = 1000   ! in a kg
      character(len=:), allocatable :: open_valve
      real(dp) :: temperature
      logical :: is_known
      associate (share => machine_answer(report, 'cycle_leak_share'))
        if (share > largest_share) call add_line('the leak takes '//short_text(100*share, 2)//' % of the charge, usually 0.5 '// &
          'to 2 %: &working_gas leak_area')
      end associate
      call report%value_of('max_gas_temperature', temperature, is_known)
      if (is_known .and. temperature > hottest) call add_line('the gas reaches '//short_text(temperature, 4)//' K, usually up '// &
        'to 3000 K: &combustion heat, &working_gas temperature')
      call report%value_of('min_gas_temperature', temperature, is_known)
      if (is_known .and. temperature < coldest) call add_line('the gas is as cold as '//short_text(temperature, 4)//' K, '// &
        'usually above 200 K: &working_gas temperature, pressures')
      if (.not. allocated(case%combustion) .or. .not. machine_answer(report, 'cycle_duration') > 0) return
      if (.not. case%combustion%filling_pressure() > 0) return
      if (.not. machine_answer(report, 'cycle_volumetric_efficiency') > 0) call add_line('the compressor delivers no gas in '// &
        'the last cycle: its discharge valve stays closed')
      open_valve = trim(report%text_of('cycle_open_valve'))
      if (open_valve /= '') call add_line('the '//open_valve//' valve is open through the whole cycle: more &valve area, or '// &
        'less leak_area')
      associate (flow => machine_answer(report, 'cycle_mass_flow'), mean => machine_answer(report, 'recent_mass_flow'), &
          scatter => machine_answer(report, 'recent_mass_flow_scatter'))
        if (scatter > most_change) call add_line('the flow scatters by '//short_text(100*scatter, 2)//' % from cycle to cycle: '// &
          short_text(grams*flow, 3)//' g/s in the last one, as all answers are, '//short_text(grams*mean, 3)// &
          ' g/s in the mean of the last revolutions, recent_mass_flow; the run has not settled, or its valves flutter')
      end associate
    end subroutine note_gas

    !> A lubricated skirt that runs on its asperities, or whose faces bend more than there is room.
    subroutine note_skirt()
      real(dp), parameter :: least_ratio = 3   ! of the film to the roughness
      real(dp) :: thickness, deflection
      logical :: is_known
      call report%value_of('cycle_min_skirt_film_thickness', thickness, is_known)
      if (is_known) is_known = thickness < least_ratio*case%skirt_film%asperities%roughness
      if (is_known) call add_line('the skirt runs on its asperities, its least film is '//quantity_text(thickness, 'm')// &
        ': more &guide barrel or another barrel_height')
      call report%value_of('cycle_max_deflection', deflection, is_known)
      if (is_known) is_known = deflection > case%guide%bore_clearance
      if (is_known) call add_line('the faces of the skirt bend by up to '//quantity_text(deflection, 'm')// &
        ', more than bore_clearance: more &guide stiffness')
    end subroutine note_skirt

    !> No period was found, and errors of the integration may be the reason.
    subroutine note_period()
      associate (allowed => case%run%periodic_tolerance, tolerance => case%integrator%relative_tolerance)
        if (.not. report%periods%is_on .or. report%periods%period > 0 .or. report%status /= 'done') return
        if (allowed >= least_period_tolerance*tolerance) return
        call add_line('no period was found, perhaps since errors of the integration hide it: &run periodic_tolerance = '// &
          short_text(allowed)//' is less than 10 times the &integrator relative_tolerance, '//short_text(tolerance))
      end associate
    end subroutine note_period

    !> Speeds beyond the ends of a table of the torque. Other tables are periodic, or the run ends with them.
    subroutine note_torque_table()
      character(len=:), allocatable :: reached
      if (.not. (case%drive%table%is_wanted() .and. allocated(case%drive%table%x))) return
      associate (speed => case%drive%table%x, n => size(case%drive%table%x))
        reached = short_text(report%figures%driven_speeds(1))//' to '//short_text(report%figures%driven_speeds(2))
        if (report%figures%driven_speeds(1) < speed(1) .or. report%figures%driven_speeds(2) > speed(n)) &
          call add_line('&drive torque_table: the speed is from '//reached//' rad/s, the table from '//short_text(speed(1))// &
            ' to '//short_text(speed(n))//': beyond it the torque is that at its nearer end')
      end associate
    end subroutine note_torque_table

    !> The brake power of the last cycle: losses that the motion does not feel, and a speed that is not settled.
    subroutine note_power()
      real(dp) :: work, change, lost   ! in the cycle [J]
      character(len=:), allocatable :: power, share, way
      work = machine_answer(report, 'cycle_work_gas')
      if (.not. abs(work) > 0) return
      lost = machine_answer(report, 'cycle_one_way_fmep')*work/machine_answer(report, 'cycle_imep')
      power = quantity_text(lost/machine_answer(report, 'cycle_duration'), 'W')
      share = short_text(100*lost/abs(work), 2)
      if (lost > 0) call add_line('the losses of the quasi-static bearings, '//power//' or '//share//' % of the work of the '// &
        'gas, are counted in the brake power and not fed back: the motion does not feel them')
      change = machine_answer(report, 'cycle_energy_change')
      share = short_text(100*change/abs(work), 2)
      way = 'slows down'
      if (change > 0) way = 'speeds up'
      if (abs(change) > most_energy_change*abs(work)) call add_line('the machine still '//way//': its energy changes by '//share// &
        ' % of the work of the gas in the last cycle, and its brake power is not that of a settled motion')
    end subroutine note_power

    subroutine note_joint(joint, pin, name)
      type(joint_case_t), intent(in) :: joint
      type(pin_figures_t), intent(in) :: pin
      character(len=*), intent(in) :: name
      real(dp) :: length, area, limit
      if (.not. joint%has_bearing()) return
      if (allocated(joint%contact)) then
        if (joint%contact%remembers_impact() .and. pin%longest_contact*abs(report%figures%crank_travel) > &
            longest_cycle*report%figures%time) call add_line(name//'a contact lasts for more than two revolutions and keeps '// &
          'the damping of its first touch, on which its loss depends: give &contact dissipation')
      end if
      if (allocated(joint%film) .and. pin%min_film_thickness > 0) then
        if (pin%min_film_thickness < thinnest_film) then
          call add_line(name//'a film of '//quantity_text(pin%min_film_thickness, 'm')//' is thinner than 10 nm, where oil is '// &
            'not a continuous fluid')
        else if (pin%min_film_thickness < smoothest .and. .not. allocated(joint%asperities)) then
          call add_line(name//'a film of '//quantity_text(pin%min_film_thickness, 'm')//' is thinner than the roughness of '// &
            'polished surfaces, 0.1 um: &asperities')
        end if
      end if
      length = joint%bearing_length
      if (.not. length > 0) length = 2*joint%bearing_radius
      area = joint%bearing_radius*length
      limit = huge(limit)
      if (allocated(joint%contact)) limit = minval(joint%contact%geometry%youngs_modulus)*area
      if (pin%max_force > limit) then
        call add_line(name//'a force of '//quantity_text(pin%max_force, 'N')//' is larger than E R L = '// &
          quantity_text(limit, 'N')//too_much)
      else if (pin%max_force > largest_pressure*2*area) then
        call add_line(name//'a mean pressure of '//quantity_text(pin%max_force/(2*area), 'Pa')//' is larger than 5 GPa'//too_much)
      else if (pin%max_film_pressure > largest_pressure) then
        call add_line(name//'a film pressure of '//quantity_text(pin%max_film_pressure, 'Pa')//' is larger than 5 GPa'//too_much)
      end if
    end subroutine note_joint
  end function notes_on_results

  !> An answer of the machine; 0 if the run has not given it.
  pure real(dp) function machine_answer(report, name) result(value)
    type(run_report_t), intent(in) :: report
    character(len=*), intent(in) :: name
    logical :: is_known
    call report%value_of(name, value, is_known)
  end function machine_answer

  !> Whether a floating pin is between dry bearings whose friction has the same moment: while it slides in both of them the moments
  !> cancel at every speed of the pin.
  pure logical function pin_is_undecided(case)
    type(case_t), intent(in) :: case
    real(dp), parameter :: same = 1e-3_dp
    real(dp) :: moment(2)   ! of friction, over the normal force [m]
    integer :: i
    integer, parameter :: ends(2) = [piston_pin, small_end]
    pin_is_undecided = .false.
    do i = 1, size(ends)
      associate (joint => case%joints(ends(i)))
        if (allocated(joint%film) .or. .not. allocated(joint%friction)) return
        moment(i) = joint%friction%coefficient*(joint%bearing_radius - joint%clearance)
      end associate
    end do
    pin_is_undecided = abs(moment(1) - moment(2)) <= same*maxval(moment) .and. maxval(moment) > 0
  end function pin_is_undecided

  !> Largest energy residual at the ends of steps divided by the largest energy [-]; 0 if there is no energy.
  pure real(dp) function relative_residual(report)
    type(run_report_t), intent(in) :: report
    relative_residual = 0
    if (report%figures%max_energy > 0) relative_residual = report%figures%max_energy_residual/report%figures%max_energy
  end function relative_residual

  !> Warning about a completed run with a large energy residual.
  function energy_warning(case, report) result(text)
    type(case_t), intent(in) :: case
    type(run_report_t), intent(in) :: report
    character(len=:), allocatable :: text
    text = 'the energy is conserved only to '//short_text(relative_residual(report))//', that is '// &
      short_text(relative_residual(report)/case%integrator%relative_tolerance)// &
      ' relative tolerances: compare with a run with a tenth of &integrator relative_tolerance'
  end function energy_warning

  !> What a user should know of a march: no bearing carries its pressure, no oil its thickness, its film is not settled, or its grid
  !> is too coarse; one line each, else empty.
  pure function history_remarks(history) result(text)
    type(film_history_t), intent(in) :: history
    character(len=:), allocatable :: text
    text = ''
    if (.not. allocated(history%rows)) return   ! it was not marched: the run did not come to its end
    associate (found => history%summary)
      if (size(history%rows) > 0) then
        if (found%max_pressure > largest_pressure) call add_line('film_history: a film pressure of '// &
          quantity_text(found%max_pressure, 'Pa')//' is larger than 5 GPa'//too_much)
        if (found%min_thickness < thinnest_film) call add_line('film_history: a film of '// &
          quantity_text(found%min_thickness, 'm')//' is thinner than 10 nm, where oil is not a continuous fluid')
      end if
      if (found%cycles == history%most_cycles .and. .not. history%is_steady .and. found%content_change >= history%cycle_tolerance) &
        call add_line('film_history: the oil still changes by '//short_text(found%content_change)// &
          ' from cycle to cycle: raise &film_history most_cycles')
      if (found%cycles > 0 .and. found%cells_per_gap < least_cells_per_gap) &
        call add_line('film_history: the thinnest part of the film has '//short_text(found%cells_per_gap)// &
          ' cells, fewer than 4: raise &film_history around')
    end associate

  contains

    pure subroutine add_line(line)
      character(len=*), intent(in) :: line
      if (text /= '') text = text//achar(10)
      text = text//line
    end subroutine add_line
  end function history_remarks
end module result_notes
