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
    type(elastic_rod_t) :: rod
    type(elastic_crankshaft_t) :: crankshaft
    type(measured_pressure_t) :: measured
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
    call list%group('elastic_rod', 'Elastic connecting rod. Without this group the rod is rigid', .true.)
    call rod%parameters(list)
    if (list%sets) case%elastic_rod = rod
    if (list%is_absent()) deallocate (case%elastic_rod)
    call list%group('crankshaft', 'Elastic crankshaft with a driven flywheel. Without this group the crankshaft is rigid', .true.)
    call crankshaft%parameters(list)
    if (list%sets) case%crankshaft = crankshaft
    if (list%is_absent()) deallocate (case%crankshaft)
    call list%group('combustion', &
      'Gas pressure on the piston, of an engine or a compressor. Without this group there is none', .true.)
    call list%choice('cycle', 'four_stroke', 'working cycle; compressor: without combustion')
    call offer_gas_cycles(list)
    if (list%sets) call take_gas(list%chosen, case%combustion)
    call list%group('cylinder_pressure', 'Measured gas pressure on the piston, from a table', .true., instead_of='combustion')
    if (list%sets .and. allocated(case%measured)) measured = case%measured   ! its table has been read
    call measured%parameters(list)
    if (list%sets) case%measured = measured
    if (list%is_absent()) deallocate (case%measured)
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
    type(asperities_t) :: asperities
    type(wear_law_t) :: wear
    call list%group('joint', 'Joint of rod and piston (piston pin)', .false., place)
    call joint%parameters(list)
    if (list%sets .and. another_has_clearance .and. .not. joint%has_clearance()) return
    call visit_contact(joint%contact, place, list)
    call visit_friction(joint%friction, joint%reports_friction_work, place, list)
    call visit_film(joint%film, joint%transition, joint%oil, joint%elastic, joint%reports_film, place, list)
    call list%group('asperities', 'Contact of rough surfaces through the film. Without this group surfaces are smooth', .true., &
      place, instead_of='contact')
    call asperities%parameters(list)
    if (list%sets) joint%asperities = asperities
    if (list%is_absent()) deallocate (joint%asperities)
    call list%group('wear', &
      'Wear of pin and bore, with a file NAME.wear.csv. Without this group wear is not counted', .true., place)
    call wear%parameters(list)
    if (list%sets) joint%wear = wear
    if (list%is_absent()) deallocate (joint%wear)
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
    if (list%sets) call take_film(list%chosen, law)
  end subroutine visit_film

  !> Take the film law that a case names, if it names one.
  subroutine take_film(chosen, law)
    class(law_t), allocatable, intent(in) :: chosen
    class(film_law_t), allocatable, intent(out) :: law
    if (.not. allocated(chosen)) return
    select type (chosen)
    class is (film_law_t)
      allocate (law, source=chosen)
    end select
  end subroutine take_film

  !> Take the working cycle that a case names, if it names one.
  subroutine take_gas(chosen, law)
    class(law_t), allocatable, intent(in) :: chosen
    class(gas_law_t), allocatable, intent(out) :: law
    if (.not. allocated(chosen)) return
    select type (chosen)
    class is (gas_law_t)
      allocate (law, source=chosen)
    end select
  end subroutine take_gas

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
    if (list%sets) guide = described
    if (list%is_absent()) deallocate (guide)
  end subroutine visit_guide
end submodule case_groups
