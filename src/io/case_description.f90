!> What the program has understood of a case, in units that people use: the answer to --check.
module case_description
  use kinds, only: dp
  use constants, only: pi, two_pi, degree
  use ideal_linkage, only: linkage_t
  use case_definition, only: case_t
  use joint_case, only: joint_case_t
  use joint_places, only: places, n_places, in_order, crank_pin, number_of
  use scene_builder, only: simulated_time, sample_interval
  use train_case, only: order_cylinders
  use gas_law, only: gas_law_t
  use gas_figures, only: gas_figures_t, find_gas_figures
  use number_text, only: short_text, quantity_text
  use text_tools, only: integer_text, counted, printable
  implicit none
  private
  public :: description

  integer, parameter :: digits = 4
  real(dp), parameter :: mm3_to_cm3 = 1e6_dp        !! cm^3 in a m^3
  real(dp), parameter :: zero_celsius = 273.15_dp   !! [K]

contains

  !> One line that says that the case is correct, and one for each part of it.
  function description(case, columns, has_twin, base, tables) result(text)
    type(case_t), intent(in) :: case
    integer, intent(in) :: columns         !! number of columns of the trace
    logical, intent(in) :: has_twin
    character(len=*), intent(in) :: base     !! path of the results without suffix
    character(len=*), intent(in) :: tables   !! text about the tables of films; may be empty
    character(len=:), allocatable :: text
    integer :: i
    text = printable(case%file, 200)//': correct'
    if (allocated(case%load)) then
      call add('load', load_text(case))
    else
      call add('machine', machine_text(case))
    end if
    call add('speed', speed_text(case))
    if (allocated(case%combustion)) call add('gas', gas_text(case, case%combustion))
    if (allocated(case%measured)) call add('gas', gas_text(case, case%measured))
    if (allocated(case%cylinders)) call add('firing', firing_text(case))
    do i = 1, n_places
      associate (place => in_order(i))
        if (allocated(case%load)) then
          if (i == 1) call add('bearing', joint_text(case%joints(place)))
          if (i == 1) call add('note', advice(case%joints(place)))
        else if (i == 1 .or. case%joints(place)%has_bearing()) then
          call add(trim(places(place)%title), numbers_text(case, place)//joint_text(case%joints(place)))
          call add('note', advice(case%joints(place)))
        end if
      end associate
    end do
    if (allocated(case%guide)) call add('guide', guide_text(case))
    if (allocated(case%rings%rings)) call add('rings', integer_text(size(case%rings%rings))//', tension '// &
      quantity_text(sum(case%rings%rings%tension), 'N', digits)//' together; oil '// &
      quantity_text(case%rings%oil%viscosity(), 'Pa s', digits))
    call add('run', run_text(case))
    call add('results', results_text(case, columns, has_twin, base))
    call add('film table', tables)

  contains

    subroutine add(part, line)
      character(len=*), intent(in) :: part, line
      if (line /= '') text = text//achar(10)//'  '//part//repeat(' ', max(1, 12 - len(part)))//line
    end subroutine add
  end function description

  function machine_text(case) result(text)
    type(case_t), intent(in) :: case
    character(len=:), allocatable :: text
    real(dp) :: stroke, bore   !! [m]
    real(dp) :: swept          !! [cm^3]
    type(linkage_t) :: linkage
    linkage = case%mechanism%linkage()
    stroke = linkage%stroke()
    bore = 0
    if (allocated(case%combustion)) bore = case%combustion%bore
    if (allocated(case%measured)) bore = case%measured%bore
    text = 'stroke '//quantity_text(stroke, 'm', digits)//', rod '//quantity_text(case%mechanism%rod_length, 'm', digits)// &
      ' (crank over rod '//short_text(linkage%crank_length/linkage%rod_length, 3)//')'
    if (abs(linkage%axis_offset) > 0) text = text//', axis off by '//quantity_text(linkage%axis_offset, 'm', digits)// &
      ': dead centres at '//short_text(linkage%top_angle()/degree, digits)//' and '// &
      short_text(linkage%bottom_angle()/degree, digits)//' degrees'
    if (bore > 0) then
      swept = mm3_to_cm3*pi/4*bore**2*stroke
      text = text//', bore '//quantity_text(bore, 'm', digits)//', displacement '
      if (allocated(case%cylinders)) text = text//integer_text(size(case%cylinders))//' x '//short_text(swept, digits)//' = '
      if (allocated(case%cylinders)) swept = size(case%cylinders)*swept
      text = text//short_text(swept, digits)//' cm3'
    end if
    if (allocated(case%pin)) text = text//', piston pin: '//case%pin%kind
    if (allocated(case%elastic_rod)) text = text//', elastic rod'
    if (allocated(case%crankshaft)) text = text//', elastic crankshaft'
    if (allocated(case%cylinders)) text = text//'; cylinders: '//integer_text(size(case%cylinders))
    if (allocated(case%shaft)) text = text//'; crankshaft of '//integer_text(case%shaft%n_inertia)//' stations'
  end function machine_text

  !> The gas, and what it does in a cycle of one cylinder.
  function gas_text(case, law) result(text)
    type(case_t), intent(in) :: case
    class(gas_law_t), intent(in) :: law
    character(len=:), allocatable :: text
    type(gas_figures_t) :: gas
    real(dp), parameter :: bar = 1e5_dp, cm2 = 1e4_dp   ! [Pa], cm^2 in a m^2
    text = law%description()
    if (allocated(case%valves)) then   ! the pressures follow from the run
      text = text//', valves of '//short_text(case%valves(1)%area*cm2, digits)//' and '// &
        short_text(case%valves(size(case%valves))%area*cm2, digits)//' cm2'
      return
    end if
    call find_gas_figures(law, case%mechanism%linkage(), case%initial%crank_speed, gas)
    if (gas%is_known) text = text//'; '//short_text(gas%least/bar, digits)//' to '//short_text(gas%peak/bar, digits)// &
      ' bar, largest at '//short_text(gas%peak_angle, digits)//' degrees, IMEP '//short_text(gas%imep/bar, digits)//' bar'
  end function gas_text

  !> In which order cylinders reach the same point of the cycle, and after which angles.
  function firing_text(case) result(text)
    type(case_t), intent(in) :: case
    character(len=:), allocatable :: text
    real(dp), parameter :: same = 1e-3_dp   ! [degrees]
    real(dp) :: gaps(size(case%cylinders))  ! [degrees]
    integer :: i
    call order_cylinders(case%delays(), 360.0_dp*case%forced_revolutions(), text, gaps)
    text = 'order '//text//', every '//short_text(gaps(1), digits)
    if (maxval(gaps) - minval(gaps) > same) then
      do i = 2, size(gaps)
        text = text//trim(merge(' and', ',   ', i == size(gaps)))//' '//short_text(gaps(i), digits)
      end do
      text = text(:index(text, ', every') - 1)//', after '//text(index(text, 'every ') + 6:)
    end if
    text = text//' degrees'
  end function firing_text

  !> The load of a bearing by itself, and what turns.
  function load_text(case) result(text)
    type(case_t), intent(in) :: case
    character(len=:), allocatable :: text
    associate (load => case%load)
      text = quantity_text(load%factor*norm2(load%load), 'N', digits)
      if (load%curve%is_wanted()) text = integer_text(size(load%curve%x))//' rows of up to '// &
        quantity_text(load%factor*maxval(hypot(load%curve%y, load%curve%z)), 'N', digits)//', '//load%interpolation// &
        ', repeated every '//integer_text(load%period_deg)//' degrees'
      text = text//'; frame '//load%frame//', journal '//load%journal//', bearing '//load%bearing
    end associate
  end function load_text

  function speed_text(case) result(text)
    type(case_t), intent(in) :: case
    character(len=:), allocatable :: text
    type(linkage_t) :: linkage
    associate (speed => case%initial%crank_speed, drive => case%drive)
      text = rpm_text(speed)
      if (drive%kind == 'constant_speed') then
        text = text//' held'
        if (drive%ramp_time > 0) text = text//', after a ramp of '//quantity_text(drive%ramp_time, 's', digits)//' from '// &
          rpm_text(drive%ramp_from)
      else
        text = text//' at first, free crank'
      end if
      if (allocated(case%load)) return
      linkage = case%mechanism%linkage()
      text = text//'; mean piston speed '//short_text(abs(speed)*linkage%stroke()/pi, 3)//' m/s'
    end associate
  end function speed_text

  function rpm_text(speed) result(text)
    real(dp), intent(in) :: speed   !! [rad/s]
    character(len=:), allocatable :: text
    text = short_text(30*speed/pi, digits)//' rpm'
  end function rpm_text

  !> How many bearings a group of numbered ones stands for; empty: one without number.
  function numbers_text(case, place) result(text)
    type(case_t), intent(in) :: case
    integer, intent(in) :: place   !! index in `places`
    character(len=:), allocatable :: text
    integer, allocatable :: spots(:)
    integer :: i
    text = ''
    if (.not. case%has_numbers(place)) return
    spots = case%spots(place)
    text = 'bearings'
    if (place == crank_pin) text = 'cylinders'
    do i = 1, size(spots)
      if (i > 1) text = text//','
      text = text//' '//integer_text(number_of(spots(i)))
    end do
    text = text//': '
  end function numbers_text

  !> Clearance and models of a joint.
  function joint_text(joint) result(text)
    type(joint_case_t), intent(in) :: joint
    character(len=:), allocatable :: text
    text = 'ideal'
    if (.not. joint%has_bearing()) return
    text = ''
    if (joint%is_carried()) text = 'quasi-static, '
    if (joint%load_share < 1) text = text//short_text(joint%load_share)//' of the load, '
    text = text//'clearance '//quantity_text(joint%clearance, 'm', digits)//' (diametral '// &
      quantity_text(2*joint%clearance, 'm', digits)//'), '// &
      short_text(joint%clearance/joint%bearing_radius, 2)//' of the radius of '//quantity_text(joint%bearing_radius, 'm', digits)
    if (joint%bearing_length > 0) text = text//', length/diameter '//short_text(0.5_dp*joint%bearing_length/joint%bearing_radius, 3)
    if (allocated(joint%film)) then
      text = text//'; '//trim(joint%film%name)//' film, '
      if (joint%oil%is_known()) then
        text = text//quantity_text(joint%oil%dynamic_viscosity(), 'Pa s', 3)//' at '// &
          short_text(joint%oil%temperature - zero_celsius, 3)//' degrees C ('//joint%oil%law//')'
      else
        text = text//quantity_text(joint%film%viscosity, 'Pa s', 3)
      end if
      if (allocated(joint%heat)) text = text//' at the start, heats up'
      if (joint%oil%thinning_ratio < 1) text = text//', thins with the shear'
      if (joint%elastic%is_wanted) text = text//', elastic walls'
    end if
    if (allocated(joint%contact)) text = text//'; contact '//trim(joint%contact%name)//' on '//trim(joint%contact%geometry%name)
    if (allocated(joint%asperities)) text = text//'; rough surfaces, '//quantity_text(joint%asperities%roughness, 'm', 3)
    if (allocated(joint%friction)) text = text//'; friction '//trim(joint%friction%name)
    if (allocated(joint%wear)) text = text//'; wear'
  end function joint_text

  !> What the manual advises against in a joint, though the case asks for it; empty: nothing.
  function advice(joint) result(text)
    type(joint_case_t), intent(in) :: joint
    character(len=:), allocatable :: text
    text = ''
    if (.not. joint%has_bearing()) return
    if (joint%is_too_short_for_its_film()) text = 'the film is that of a long bearing, too thick below length/diameter 2: '// &
      'finite_bearing'
    if (.not. joint%can_touch()) return
    if (.not. joint%contact%geometry%is_of_spheres()) return
    if (text /= '') text = text//'; '
    text = text//'the contact is that of two spheres, far too soft for a pin in its bearing: conformal'
  end function advice

  function guide_text(case) result(text)
    type(case_t), intent(in) :: case
    character(len=:), allocatable :: text
    associate (guide => case%guide)
      text = 'piston on the axis of the cylinder'
      if (case%has_loose_guide()) text = 'clearance '//quantity_text(guide%bore_clearance, 'm', digits)// &
        ' around a piston of '//quantity_text(guide%piston_radius, 'm', digits)//' radius'
      if (case%has_skirt_corners()) text = text//'; contact '//trim(guide%contact%name)
      if (guide%is_lubricated()) text = text//', with a film at the '//trim(merge('elastic skirt', 'skirt        ', &
        guide%stiffness > 0))
      if (allocated(guide%friction) .and. .not. guide%is_lubricated()) text = text//'; friction '//trim(guide%friction%name)
    end associate
  end function guide_text

  function run_text(case) result(text)
    type(case_t), intent(in) :: case
    character(len=:), allocatable :: text
    associate (run => case%integrator)
      if (case%run%is_until_periodic()) then
        text = 'until the motion repeats, '//counted(integer_text(case%run%most_revolutions), 'revolution')//' at most'
      else if (run%crank_revolutions > 0) then
        text = counted(short_text(run%crank_revolutions), 'revolution')//' of the crank, about '// &
          quantity_text(simulated_time(case), 's', digits)
      else if (run%revolutions > 0) then
        text = counted(short_text(run%revolutions), 'revolution')//' at the starting speed, '// &
          quantity_text(simulated_time(case), 's', digits)
      else
        text = quantity_text(run%end_time, 's', digits)//', '// &
          counted(short_text(run%end_time*abs(case%initial%crank_speed)/two_pi, digits), 'revolution')//' at the starting speed'
      end if
      text = text//'; method '//run%method//', relative tolerance '//short_text(run%relative_tolerance)
      if (run%contact_entry /= 'root') text = text//', contact entry '//run%contact_entry
    end associate
  end function run_text

  function results_text(case, columns, has_twin, base) result(text)
    type(case_t), intent(in) :: case
    integer, intent(in) :: columns
    logical, intent(in) :: has_twin
    character(len=*), intent(in) :: base
    character(len=:), allocatable :: text
    associate (output => case%output)
      if (output%every_step) then
        text = 'a row for each step'
      else if (output%sampling == 'crank_angle') then
        text = integer_text(output%samples_per_revolution)//' rows a revolution'
      else if (case%run%is_until_periodic()) then
        text = 'a row every '//quantity_text(sample_interval(case), 's', digits)
      else
        text = 'about '//short_text(1 + aint((simulated_time(case) - output%start_time)/sample_interval(case)))//' rows'
      end if
      text = text//' of '//integer_text(columns)//' columns in '//printable(base, 200)//'.csv'
    end associate
    if (case%has_contact()) text = text//', with its events'
    if (has_twin) text = text//', and the ideal twin'
  end function results_text
end module case_description
