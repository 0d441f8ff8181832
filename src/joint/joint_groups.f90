!> The groups of a joint and of its laws, in the order of the template.
submodule (joint_case) joint_groups
  use contact_geometry, only: contact_geometry_t
  use contact_laws, only: offer_contact_laws, offer_contact_geometries
  use friction_laws, only: offer_friction_laws
  use films, only: offer_film_laws
  use history_case, only: history_case_t, march_case_t, supply_case_t, bore_case_t, shape_case_t
  implicit none

contains

  module procedure visit_joint
    type(asperities_t) :: asperities
    type(wear_law_t) :: wear
    type(heat_case_t) :: heat
    call list%group('joint', 'Joint of rod and piston (piston pin)', .false., place)
    call joint%parameters(list)
    if (list%sets .and. another_has_bearing .and. .not. joint%has_bearing()) return
    call visit_contact(joint%contact, place, list)
    call visit_friction(joint%friction, joint%reports_friction_work, place, list)
    call visit_film(joint, place, list)
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
    call visit_history(joint%history, place, list)
    call list%group('heat', 'Heating of the film by its losses. Without this group the temperature is that of &lubrication', &
      .true., place, instead_of='lubrication viscosity')   ! a key: the viscosity is that of an oil
    call heat%parameters(list)
    if (list%sets) joint%heat = heat
    if (list%is_absent()) deallocate (joint%heat)
  end procedure visit_joint

  subroutine visit_contact(law, place, list)
    class(contact_law_t), allocatable, intent(inout) :: law
    character(len=*), intent(in) :: place
    class(parameter_list_t), intent(inout) :: list
    call list%group('contact', 'Contact of pin and bearing. Without this group there is no contact', .true., place)
    call list%choice('law', 'lankarani_nikravesh', 'energy loss of an impact; hertz: no loss')
    call offer_contact_laws(list)
    if (list%sets) call select_contact(list%chosen, law)
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
    if (list%sets) call select_friction(list%chosen, law)
  end subroutine visit_friction

  subroutine visit_film(joint, place, list)
    type(joint_case_t), intent(inout) :: joint
    character(len=*), intent(in) :: place
    class(parameter_list_t), intent(inout) :: list
    call list%group('lubrication', 'Oil film in the clearance. Without this group the joint is dry', .true., place)
    call list%choice('law', 'pinkus_sternlicht', 'film theory: long journal bearing, oscillating film, or bearing of finite length')
    call joint%oil%parameters(list)
    if (list%sets) call joint%oil%read_name()
    call joint%transition%parameters(list)
    call joint%elastic%parameters(list)
    call list%add('ambient_over_cavitation', joint%ambient_over_cavitation, &
      'film_history: ambient pressure above that of cavitation; > 0: the ends of the bearing are under oil', 'Pa', &
      '>= 0 and <= 1e7', default='0.0', usual='1e3 to 1e6')
    call list%add('report', joint%reports_film, &
      'write energy loss, largest pressure and mean side flow of the film into the summary', '.false.')
    call offer_film_laws(list)
    if (list%sets) call select_film(list%chosen, joint%film)
  end subroutine visit_film

  !> The groups of the film with memory that is marched after a run.
  subroutine visit_history(history, place, list)
    type(history_case_t), intent(inout) :: history
    character(len=*), intent(in) :: place
    class(parameter_list_t), intent(inout) :: list
    type(march_case_t) :: march
    type(supply_case_t) :: supply
    type(bore_case_t) :: bore
    type(shape_case_t) :: shape
    call list%group('film_history', &
      'Film with memory under the load of the run, solved step by step over its last cycle when it has ended', .true., place)
    call march%parameters(list)
    if (list%sets) history%march = march
    if (list%is_absent()) deallocate (history%march)
    call list%group('supply', 'Where oil is fed to the film of film_history. Without this group it is not fed', .true., place)
    call supply%parameters(list)
    if (list%sets) history%supply = supply
    if (list%is_absent()) deallocate (history%supply)
    call list%group('bore', 'Elastic bore of the film of film_history. Without this group the bore is rigid', .true., place)
    call bore%parameters(list)
    if (list%sets) history%bore = bore
    if (list%is_absent()) deallocate (history%bore)
    call list%group('shape', 'Shape of the bore of the film of film_history, barrel, tilt of the pin. Without this group it is '// &
      'round and in line', .true., place)
    call shape%parameters(list)
    if (list%sets) history%shape = shape
    if (list%is_absent()) deallocate (history%shape)
  end subroutine visit_history

  !> Select the film law that a case names, if it names one.
  subroutine select_film(chosen, law)
    class(law_t), allocatable, intent(in) :: chosen
    class(film_law_t), allocatable, intent(out) :: law
    if (.not. allocated(chosen)) return
    select type (chosen)
    class is (film_law_t)
      allocate (law, source=chosen)
    end select
  end subroutine select_film
end submodule joint_groups
