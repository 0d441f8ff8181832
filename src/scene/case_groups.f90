!> The groups of a case: every group with its keys and laws, in the order of the template.
submodule (case_definition) case_groups
  use model_parameters, only: law_t
  use contact_laws, only: offer_contact_laws, new_power_geometry
  use friction_laws, only: offer_speed_laws
  use joint_case, only: visit_joint, drop_laws, select_contact, select_friction
  use gas_laws, only: offer_gas_cycles
  use wall_laws, only: offer_wall_laws
  use train_case, only: most_rings
  use ring_case, only: visit_rings
  use skirt_film_case, only: visit_skirt_film
  use flow_valve, only: flow_valve_t
  implicit none

contains

  module procedure visit_case
    type(pin_case_t) :: pin
    type(elastic_rod_t) :: rod
    type(elastic_crankshaft_t) :: crankshaft
    type(shaft_case_t) :: shaft
    type(measured_pressure_t) :: measured
    type(bearing_load_t) :: load
    type(charge_case_t) :: charge
    integer :: i
    call list%group('case', 'All values are in SI units; angles are in degrees only where the key ends in _deg', .false.)
    call list%text('title', case%title, 'title of the case, for pictures and pages', '')
    call list%group('mechanism', &
      'Crank, rod and piston. A centre of mass is given along and across its body, from the end nearer to the crank axis', .false.)
    call case%mechanism%parameters(list)
    call list%group('bearing_load', 'A bearing by itself under a load over the crank angle, &joint kind = ''quasi_static''', &
      .true., instead_of='mechanism')
    if (list%sets .and. allocated(case%load)) load = case%load   ! its table has been read
    call load%parameters(list)
    if (list%sets) case%load = load
    if (list%is_absent()) deallocate (case%load)
    call list%group('drive', 'Drive of the crank', .false.)
    call case%drive%parameters(list)
    call list%group('initial', &
      'Initial state. Velocities are those of the mechanism with ideal joints, plus the rates given here', .false.)
    call case%initial%parameters(list)
    call list%group('pin', 'The piston pin. Without this group it is fixed in the rod', .true.)
    call pin%parameters(list)
    if (list%sets) case%pin = pin
    if (list%is_absent()) deallocate (case%pin)
    do i = 1, n_places
      call visit_joint(case%joints(in_order(i)), trim(places(in_order(i))%name), &
        any(case%joints(in_order(:i - 1))%has_bearing()), list)
    end do
    if (list%sets .and. any(case%joints%has_bearing())) then
      do i = 1, n_places
        call drop_laws(case%joints(i))
      end do
    end if
    call visit_guide(case%guide, list)
    call visit_skirt_film(case%skirt_film, list)
    call visit_rings(case%rings, list)
    call list%group('elastic_rod', 'Elastic connecting rod. Without this group the rod is rigid', .true.)
    call rod%parameters(list)
    if (list%sets) case%elastic_rod = rod
    if (list%is_absent()) deallocate (case%elastic_rod)
    call list%group('crankshaft', 'Elastic crankshaft: with a driven flywheel, or with stations for several cylinders. '// &
      'Without this group the crankshaft is rigid', .true.)
    call crankshaft%parameters(list)
    call shaft%parameters(list)
    if (list%sets) then
      case%crankshaft = crankshaft
      case%shaft = shaft
      if (list%is_absent() .or. shaft%is_given()) deallocate (case%crankshaft)
      if (list%is_absent() .or. .not. shaft%is_given()) deallocate (case%shaft)
    end if
    call visit_dampers(case%dampers, list)
    call visit_cylinders(case%cylinders, list)
    call list%group('combustion', &
      'Gas pressure on the piston, of an engine or a compressor. Without this group there is none', .true.)
    call list%choice('cycle', 'four_stroke', 'working cycle; compressor: without combustion')
    call offer_gas_cycles(list)
    if (list%sets) call select_gas(list%chosen, case%combustion)
    call list%group('cylinder_pressure', 'Measured gas pressure on the piston, from a table', .true., instead_of='combustion')
    if (list%sets .and. allocated(case%measured)) measured = case%measured   ! its table has been read
    call measured%parameters(list)
    if (list%sets) case%measured = measured
    if (list%is_absent()) deallocate (case%measured)
    call list%group('working_gas', 'Mass and temperature of the gas in the cylinders, and its leak. Without this group the '// &
      'pressure follows from the crank angle alone', .true.)
    call charge%parameters(list)
    if (list%sets) case%charge = charge
    if (list%is_absent()) deallocate (case%charge)
    call visit_valves(case%valves, list)
    call list%group('wall_heat', 'Heat of the gas to the walls. `heat` of &combustion is then that of the fuel; without this '// &
      'group it is the net heat', .true.)
    call list%choice('law', 'woschni', 'heat transfer coefficient')
    call offer_wall_laws(list)
    if (list%sets) call select_walls(list%chosen, case%walls)
    call list%group('run', 'When the run ends. until = ''periodic'' replaces the end given in &integrator', .false.)
    call case%run%parameters(list)
    call list%group('integrator', &
      'Integration. The run ends after revolutions, crank_revolutions or end_time; give one of them', .false.)
    call case%integrator%parameters(list)
    call list%group('output', 'Rows and columns of the results', .false.)
    call case%output%parameters(list)
  end procedure visit_case

  !> Select the working cycle that a case names, if it names one.
  subroutine select_gas(chosen, law)
    class(law_t), allocatable, intent(in) :: chosen
    class(gas_law_t), allocatable, intent(out) :: law
    if (.not. allocated(chosen)) return
    select type (chosen)
    class is (gas_law_t)
      allocate (law, source=chosen)
    end select
  end subroutine select_gas

  !> Select the law of the heat to the walls that a case names, if it names one.
  subroutine select_walls(chosen, law)
    class(law_t), allocatable, intent(in) :: chosen
    class(wall_law_t), allocatable, intent(out) :: law
    if (.not. allocated(chosen)) return
    select type (chosen)
    class is (wall_law_t)
      allocate (law, source=chosen)
    end select
  end subroutine select_walls

  subroutine visit_dampers(dampers, list)
    type(damper_case_t), allocatable, intent(inout) :: dampers(:)
    class(parameter_list_t), intent(inout) :: list
    type(damper_case_t) :: found(most_rings), one
    integer :: i, n
    n = 0
    do i = 1, merge(most_rings, 1, list%repeats)
      call list%group('damper', 'Damper of torsional vibrations: a ring on a station of the crankshaft', .true., number=i)
      call one%parameters(list)
      if (.not. (list%sets .and. list%is_present)) cycle
      n = n + 1
      found(n) = one
    end do
    if (.not. list%sets) return
    if (allocated(dampers)) deallocate (dampers)
    if (n > 0) allocate (dampers, source=found(:n))
  end subroutine visit_dampers

  subroutine visit_cylinders(cylinders, list)
    type(cylinder_case_t), allocatable, intent(inout) :: cylinders(:)
    class(parameter_list_t), intent(inout) :: list
    type(cylinder_case_t) :: found(most_cylinders), one
    integer :: i, n
    n = 0
    do i = 1, merge(most_cylinders, 1, list%repeats)
      call list%group('cylinder', 'Cylinders on the crankshaft, a group for each in order; all but one have ideal joints. '// &
        'Without this group there is one', .true., number=i)
      call one%parameters(list)
      if (.not. (list%sets .and. list%is_present)) cycle
      n = n + 1
      found(n) = one
    end do
    if (.not. list%sets) return
    if (allocated(cylinders)) deallocate (cylinders)
    if (n > 0) allocate (cylinders, source=found(:n))
  end subroutine visit_cylinders

  subroutine visit_valves(valves, list)
    type(flow_valve_t), allocatable, intent(inout) :: valves(:)
    class(parameter_list_t), intent(inout) :: list
    type(flow_valve_t) :: found(2), one
    integer :: i, n
    n = 0
    do i = 1, merge(2, 1, list%repeats)
      call list%group('valve', 'Valves of a compressor with their losses, one group for both or one for each. Without '// &
        'this group they are ideal', .true., number=i)
      call one%parameters(list)
      if (.not. (list%sets .and. list%is_present)) cycle
      n = n + 1
      found(n) = one
    end do
    if (.not. list%sets) return
    if (allocated(valves)) deallocate (valves)
    if (n > 0) allocate (valves, source=found(:n))
  end subroutine visit_valves

  subroutine visit_guide(guide, list)
    type(guide_case_t), allocatable, intent(inout) :: guide
    class(parameter_list_t), intent(inout) :: list
    type(guide_case_t) :: described
    call list%group('guide', 'Piston in its bore. Without this group the guide is ideal', .true.)
    call described%parameters(list)
    call list%choice('law', 'ambrosio', 'friction law of piston and bore; coefficient = 0: no friction')
    call list%make_optional('coefficient')
    call offer_speed_laws(list)
    call list%make_optional('')
    call select_friction(list%chosen, described%friction)
    call list%choice('contact_law', 'exact', 'energy loss of an impact of the skirt, for kind = ''clearance''')
    call offer_contact_laws(list)
    call select_contact(list%chosen, described%contact)
    if (allocated(described%contact)) &
      call new_power_geometry(described%stiffness, described%exponent, described%contact%geometry)
    if (list%sets) guide = described
    if (list%is_absent()) deallocate (guide)
  end subroutine visit_guide
end submodule case_groups
