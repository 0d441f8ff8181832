!> Rules that the groups of a film in a joint must obey together: its oil, its heat, elastic walls.
module film_rules
  use joint_case, only: joint_case_t
  use oil_viscosity, only: oil_t
  use case_values, only: case_values_t
  use number_text, only: short_text
  implicit none
  private
  public :: check_oil, check_heat, check_thinning, check_transition, check_elastic_film

contains

  !> Check that the viscosity of the film is given by one source.
  subroutine check_oil(oil, group, values)
    type(oil_t), intent(in) :: oil
    character(len=*), intent(in) :: group   !! group of the film
    type(case_values_t), intent(inout) :: values
    character(len=*), parameter :: names(2) = [character(len=19) :: 'viscosity', 'kinematic_viscosity']
    character(len=:), allocatable :: key, wanted
    integer :: i, place
    logical :: is_said
    do i = 1, size(names)
      key = trim(names(i))
      place = values%place_of(group, key)
      if (place == 0) cycle
      is_said = values%is_said(place)
      if (oil%is_known()) then
        call values%forbid(is_said, group, key, 'must not be given: viscosity_law = '''//oil%law//''' computes it')
      else if (values%is_used(place)) then
        call values%demand(is_said, group, key, adjustl(values%by_law(values%keys(place))))
      end if
    end do
    if (oil%is_known()) then
      call oil%conflict(key, wanted)
      call values%forbid(key /= '', group, key, wanted)
    else
      call values%forbid(oil%temperature > 0 .and. .not. values%is_given(group, 'viscosity_law'), group, 'temperature', &
        'needs an oil, or viscosity_law = ''walther'' or ''vogel'': without one the viscosity is given')
    end if
  end subroutine check_oil

  !> Check that the film that heats up is one of an oil, whose force is proportional to its viscosity, and that heat can leave it.
  subroutine check_heat(joint, own, group, values)
    type(joint_case_t), intent(in) :: joint
    character(len=*), intent(in) :: own, group   !! groups of the film and of the heat
    type(case_values_t), intent(inout) :: values
    call values%forbid(.not. allocated(joint%film), group, 'heat_capacity', &
      'needs the group lubrication: it is the film that heats up')
    if (.not. allocated(joint%film)) return
    call values%forbid(.not. joint%oil%is_known(), own, 'viscosity_law', &
      'must not be given: &heat needs an oil: oil, or viscosity_law = walther or vogel')
    call values%forbid(.not. joint%film%is_quasi_static(), group, 'heat_capacity', &
      'is for films whose force is proportional to the viscosity: finite_bearing, and closed_form and half_film of '// &
      'pinkus_sternlicht')
    associate (heat => joint%heat)
      call values%forbid(.not. (joint%film%gives_side_flow() .or. heat%side_flow > 0 .or. heat%conductance > 0), group, &
        'side_flow', &
        'required with this film, which has no side flow, unless conductance is given: no heat would leave')
      call values%forbid(joint%oil%law == 'vogel' .and. joint%oil%vogel_temperature > min(heat%inlet_temperature, &
        heat%around()) - 10, &
        own, 'vogel_temperature', 'must be 10 K or more below inlet_temperature and housing_temperature')
    end associate
  end subroutine check_heat

  !> Check that a film that thins with the shear is one of a quasi-static law between rigid walls.
  subroutine check_thinning(joint, own, values)
    type(joint_case_t), intent(in) :: joint
    character(len=*), intent(in) :: own   !! group of the film
    type(case_values_t), intent(inout) :: values
    associate (oil => joint%oil)
      call values%demand(oil%thinning_rate > 0 .or. .not. oil%thinning_ratio < 1, own, 'thinning_rate', 'with thinning_ratio')
      call values%forbid(oil%thinning_rate > 0 .and. .not. (oil%thinning_ratio < 1 .or. values%is_given(own, 'thinning_ratio')), &
        own, &
        'thinning_rate', 'needs thinning_ratio, by which the viscosity is reduced')
      if (.not. oil%thinning_ratio < 1) return
      call values%forbid(.not. joint%film%is_quasi_static(), own, 'thinning_ratio', &
        'is for films whose force is proportional to the viscosity: finite_bearing, and closed_form and half_film of '// &
        'pinkus_sternlicht')
      call values%forbid(joint%elastic%is_wanted, own, 'thinning_ratio', 'cannot be combined with elastic_film')
    end associate
  end subroutine check_thinning

  !> Check that a film and a contact that share the load both exist, and share it over a range of penetrations.
  subroutine check_transition(joint, own, values)
    type(joint_case_t), intent(in) :: joint
    character(len=*), intent(in) :: own   !! group of the film
    type(case_values_t), intent(inout) :: values
    associate (depth => joint%transition%depth)
      if (.not. joint%transition%is_weighted()) then
        call values%forbid(depth > 0 .and. .not. values%is_given(own, 'transition'), own, 'transition_depth', &
          'needs transition = ''weighted''; the default is switch')
        return
      end if
      call values%forbid(joint%is_carried(), own, 'transition', &
        'must be switch with kind = ''quasi_static'': the film carries all '// &
        'of the load')
      if (joint%is_carried()) return
      call values%forbid(allocated(joint%asperities), own, 'transition', &
        'must be switch with asperities: they carry with the film at every depth')
      call values%forbid(.not. allocated(joint%contact), own, 'transition', &
        'needs the group contact: film and contact share the load')
      call values%demand(depth > 0, own, 'transition_depth', 'with transition = ''weighted''')
      call values%forbid(depth > joint%clearance, own, 'transition_depth', 'must be <= clearance = '//short_text(joint%clearance))
    end associate
  end subroutine check_transition

  !> Check that elastic walls have a stiffness and no loss, that the law of the film between them gives a velocity for a load, and
  !> that no contact law acts.
  subroutine check_elastic_film(joint, own, contact, values)
    type(joint_case_t), intent(in) :: joint
    character(len=*), intent(in) :: own, contact   !! groups of the film and of the contact
    type(case_values_t), intent(inout) :: values
    if (.not. joint%elastic%is_wanted) then
      call values%forbid(joint%elastic%pressure_viscosity > 0 .and. .not. allocated(joint%history%march), own, &
        'pressure_viscosity', &
        'needs elastic_film = .true.: the pressures between rigid walls are not realistic')
      return
    end if
    call values%forbid(.not. allocated(joint%contact), own, 'elastic_film', &
      'needs the group contact, whose geometry is the stiffness of the walls')
    if (.not. allocated(joint%contact)) return
    call values%forbid(.not. joint%contact%is_elastic(), contact, 'law', &
      'must be hertz with elastic_film: the film dissipates, '// &
      'the walls do not')
    call values%forbid(allocated(joint%friction), own, 'elastic_film', &
      'cannot be combined with the group friction: the surfaces never touch')
    call values%forbid(joint%transition%is_weighted(), own, 'elastic_film', &
      'cannot be combined with transition = ''weighted'': the film carries at every depth')
    call values%forbid(.not. joint%film%is_quasi_static(), own, 'elastic_film', &
      'is for films of wedge and squeeze: finite_bearing, and closed_form and half_film of pinkus_sternlicht')
  end subroutine check_elastic_film
end module film_rules
