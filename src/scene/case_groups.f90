!> The groups of a case: every group with its keys and laws, in the order of the template.
submodule (case_definition) case_groups
  use gudgeon_parameters, only: law_t
  use contact_laws, only: offer_contact_laws, offer_contact_geometries
  use friction_laws, only: offer_friction_laws, offer_speed_laws
  use films, only: offer_film_laws
  use gas_laws, only: offer_gas_cycles
  implicit none

contains

  module procedure visit_case
    call list%group('case', 'All values are in SI units; angles are in degrees only where the key ends in _deg', .false.)
    call list%text('title', case%title, 'title of the case, for pictures and pages', '')
    call list%group('mechanism', &
      'Crank, rod and piston. A centre of mass is given along and across its body, from the end nearer to the crank axis', .false.)
    call case%mechanism%parameters(list)
    call list%group('drive', 'Drive of the crank', .false.)
    call case%drive%parameters(list)
    call list%group('initial', &
      'Initial state. Velocities are those of the mechanism with ideal joints, plus the rates given here', .false.)
    call case%initial%parameters(list)
    call visit_joint(case%joint, piston_pin_place, .false., list)
    call visit_joint(case%crank_pin, crank_pin_place, case%joint%has_clearance(), list)
    if (list%sets) then
      call drop_laws(case%joint, case%crank_pin)
      call drop_laws(case%crank_pin, case%joint)
    end if
    call visit_guide(case%guide, list)
    call visit_elastic_rod(case%elastic_rod, list)
    call visit_crankshaft(case%crankshaft, list)
    call visit_gas(case%combustion, list)
    call visit_measured(case%measured, list)
    call list%group('run', 'When the run ends. until = ''periodic'' replaces the end given in &integrator', .false.)
    call case%run%parameters(list)
    call list%group('integrator', &
      'Integration. The run ends after revolutions, crank_revolutions or end_time; give one of them', .false.)
    call case%integrator%parameters(list)
    call list%group('output', 'Rows and columns of the results', .false.)
    call case%output%parameters(list)
  end procedure visit_case

  !> Visit the groups of one joint and of its laws. If another joint has clearance, the laws of an ideal joint are not set.
  subroutine visit_joint(joint, place, another_has_clearance, list)
    type(joint_case_t), intent(inout) :: joint
    character(len=*), intent(in) :: place
    logical, intent(in) :: another_has_clearance
    class(parameter_list_t), intent(inout) :: list
    call list%group('joint', 'Joint of rod and piston (piston pin)', .false., place)
    call joint%parameters(list)
    if (list%sets .and. another_has_clearance .and. .not. joint%has_clearance()) return
    call visit_contact(joint%contact, place, list)
    call visit_friction(joint%friction, joint%reports_friction_work, place, list)
    call visit_film(joint%film, joint%transition, joint%oil, joint%elastic, joint%reports_film, place, list)
    call visit_asperities(joint%asperities, place, list)
    call visit_wear(joint%wear, place, list)
  end subroutine visit_joint

  !> Remove laws that were given for all joints from an ideal joint, if the other joint has clearance.
  subroutine drop_laws(joint, other)
    type(joint_case_t), intent(inout) :: joint
    type(joint_case_t), intent(in) :: other
    if (joint%has_clearance() .or. .not. other%has_clearance()) return
    if (allocated(joint%contact)) deallocate (joint%contact)
    if (allocated(joint%friction)) deallocate (joint%friction)
    if (allocated(joint%film)) deallocate (joint%film)
    if (allocated(joint%asperities)) deallocate (joint%asperities)
    if (allocated(joint%wear)) deallocate (joint%wear)
  end subroutine drop_laws

  subroutine visit_contact(law, place, list)
    class(contact_law_t), allocatable, intent(inout) :: law
    character(len=*), intent(in) :: place
    class(parameter_list_t), intent(inout) :: list
    call list%group('contact', 'Contact of pin and bearing. Without this group there is no contact', .true., place)
    call list%choice('law', 'lankarani_nikravesh', 'energy loss of an impact; hertz: no loss')
    call offer_contact_laws(list)
    if (list%sets) call take_contact(list%chosen, law)
    call list%choice('geometry', 'hertz_sphere', 'elastic force of the contact')
    call offer_contact_geometries(list)
    if (.not. list%sets .or. .not. allocated(list%chosen)) return
    select type (chosen => list%chosen)
    class is (contact_geometry_t)
      allocate (law%geometry, source=chosen)
    end select
  end subroutine visit_contact

  subroutine visit_friction(law, reports_work, place, list)
    class(friction_law_t), allocatable, intent(inout) :: law
    logical, intent(inout) :: reports_work
    character(len=*), intent(in) :: place
    class(parameter_list_t), intent(inout) :: list
    call list%group('friction', 'Dry friction of the contact. Without this group there is no friction', .true., place)
    call list%choice('law', 'ambrosio', &
      'friction law; coulomb, lugre, dahl and elasto_plastic hold a load at rest, the others let it creep')
    call list%add('report_work', reports_work, &
      'write the work of friction into the summary (laws with bristles always do)', '.false.')
    call offer_friction_laws(list)
    if (list%sets) call take_friction(list%chosen, law)
  end subroutine visit_friction

  !> Take the contact law that a case names, if it names one.
  subroutine take_contact(chosen, law)
    class(law_t), allocatable, intent(in) :: chosen
    class(contact_law_t), allocatable, intent(out) :: law
    if (.not. allocated(chosen)) return
    select type (chosen)
    class is (contact_law_t)
      allocate (law, source=chosen)
    end select
  end subroutine take_contact

  !> Take the friction law that a case names, if it names one.
  subroutine take_friction(chosen, law)
    class(law_t), allocatable, intent(in) :: chosen
    class(friction_law_t), allocatable, intent(out) :: law
    if (.not. allocated(chosen)) return
    select type (chosen)
    class is (friction_law_t)
      allocate (law, source=chosen)
    end select
  end subroutine take_friction

  subroutine visit_film(law, transition, oil, elastic, reports, place, list)
    class(film_law_t), allocatable, intent(inout) :: law
    type(film_transition_t), intent(inout) :: transition
    type(oil_t), intent(inout) :: oil
    type(elastic_film_t), intent(inout) :: elastic
    logical, intent(inout) :: reports
    character(len=*), intent(in) :: place
    class(parameter_list_t), intent(inout) :: list
    call list%group('lubrication', 'Oil film in the clearance. Without this group the joint is dry', .true., place)
    call list%choice('law', 'pinkus_sternlicht', 'film theory: long journal bearing, oscillating film, or bearing of finite length')
    call oil%parameters(list)
    call transition%parameters(list)
    call elastic%parameters(list)
    call list%add('report', reports, &
      'write energy loss, largest pressure and mean side flow of the film into the summary', '.false.')
    call offer_film_laws(list)
    if (.not. list%sets) return
    if (allocated(law)) deallocate (law)
    if (.not. allocated(list%chosen)) return
    select type (chosen => list%chosen)
    class is (film_law_t)
      allocate (law, source=chosen)
    end select
  end subroutine visit_film

  subroutine visit_asperities(asperities, place, list)
    type(asperities_t), allocatable, intent(inout) :: asperities
    character(len=*), intent(in) :: place
    class(parameter_list_t), intent(inout) :: list
    type(asperities_t) :: described
    call list%group('asperities', 'Contact of rough surfaces through the film. Without this group surfaces are smooth', .true., &
      place, instead_of='contact')
    call described%parameters(list)
    if (.not. list%sets) return
    if (allocated(asperities)) deallocate (asperities)
    if (list%is_present) allocate (asperities, source=described)
  end subroutine visit_asperities

  subroutine visit_wear(wear, place, list)
    type(wear_law_t), allocatable, intent(inout) :: wear
    character(len=*), intent(in) :: place
    class(parameter_list_t), intent(inout) :: list
    type(wear_law_t) :: described
    call list%group('wear', &
      'Wear of pin and bore, with a file NAME.wear.csv. Without this group wear is not counted', .true., place)
    call described%parameters(list)
    if (.not. list%sets) return
    if (allocated(wear)) deallocate (wear)
    if (list%is_present) allocate (wear, source=described)
  end subroutine visit_wear

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
    call take_friction(list%chosen, described%friction)
    call list%choice('contact_law', 'exact', 'energy loss of an impact of the skirt, for kind = ''clearance''')
    call offer_contact_laws(list)
    call take_contact(list%chosen, described%contact)
    if (.not. list%sets) return
    if (allocated(guide)) deallocate (guide)
    if (list%is_present) allocate (guide, source=described)
  end subroutine visit_guide

  subroutine visit_elastic_rod(rod, list)
    type(elastic_rod_t), allocatable, intent(inout) :: rod
    class(parameter_list_t), intent(inout) :: list
    type(elastic_rod_t) :: described
    call list%group('elastic_rod', 'Elastic connecting rod. Without this group the rod is rigid', .true.)
    call described%parameters(list)
    if (.not. list%sets) return
    if (allocated(rod)) deallocate (rod)
    if (list%is_present) allocate (rod, source=described)
  end subroutine visit_elastic_rod

  subroutine visit_crankshaft(crankshaft, list)
    type(elastic_crankshaft_t), allocatable, intent(inout) :: crankshaft
    class(parameter_list_t), intent(inout) :: list
    type(elastic_crankshaft_t) :: described
    call list%group('crankshaft', 'Elastic crankshaft with a driven flywheel. Without this group the crankshaft is rigid', &
      .true.)
    call described%parameters(list)
    if (.not. list%sets) return
    if (allocated(crankshaft)) deallocate (crankshaft)
    if (list%is_present) allocate (crankshaft, source=described)
  end subroutine visit_crankshaft

  subroutine visit_gas(gas, list)
    class(gas_law_t), allocatable, intent(inout) :: gas
    class(parameter_list_t), intent(inout) :: list
    call list%group('combustion', &
      'Gas pressure on the piston, of an engine or a compressor. Without this group there is none', .true.)
    call list%choice('cycle', 'four_stroke', 'working cycle; compressor: without combustion')
    call offer_gas_cycles(list)
    if (.not. list%sets) return
    if (allocated(gas)) deallocate (gas)
    if (.not. allocated(list%chosen)) return
    select type (chosen => list%chosen)
    class is (gas_law_t)
      allocate (gas, source=chosen)
    end select
  end subroutine visit_gas

  !> Visit a measured pressure. If its table has been read before, it is kept.
  subroutine visit_measured(gas, list)
    type(measured_pressure_t), allocatable, intent(inout) :: gas
    class(parameter_list_t), intent(inout) :: list
    type(measured_pressure_t) :: described
    call list%group('cylinder_pressure', 'Measured gas pressure on the piston, from a table', .true., &
      instead_of='combustion')
    if (list%sets .and. allocated(gas)) described = gas
    call described%parameters(list)
    if (.not. list%sets) return
    if (allocated(gas)) deallocate (gas)
    if (list%is_present) allocate (gas, source=described)
  end subroutine visit_measured
end submodule case_groups
