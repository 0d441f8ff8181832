!> Rules that the values of a case must obey together: valid inertias, models that match their joint, a run that ends.
module case_rules
  use kinds, only: dp
  use constants, only: two_pi
  use number_text, only: short_text
  use text_tools, only: integer_text
  use case_definition, only: case_t
  use joint_case, only: joint_case_t
  use measured_pressure, only: measured_pressure_periods
  use case_schema, only: find_group
  use case_values, only: case_values_t
  use problem_list, only: behind_file
  use archard_wear, only: of_bore
  use friction_law, only: friction_law_t
  use history_rules, only: check_history
  use train_rules, only: check_train
  use pin_rules, only: check_piston_pin
  use train_builder, only: inertia_beside
  use body_rules, only: check_guide, check_elastic, bore_reach
  use chain_motion, only: crank_pin, piston_pin, n_pins, n_bodies, body_crank, body_big_end, body_small_end, body_piston
  use joint_places, only: places, n_places, in_order, name_prefix, joint_group, main_bearing
  implicit none
  private
  public :: check_rules

  real(dp), parameter :: most_samples = 1e9_dp   !! largest number of rows that a run may ask for
  real(dp), parameter :: rounding = 1e-12_dp     !! relative difference of two times or lengths that counts as none

contains

  !> Note the errors of a case of which no scene can be built; `values` tells which keys the user has set.
  subroutine check_rules(c, values)
    type(case_t), intent(in) :: c
    type(case_values_t), intent(inout) :: values
    logical :: turns   ! the crank turns at the start
    integer :: i
    turns = abs(c%initial%crank_speed) > 0
    if (allocated(c%load)) then
      call check_load()
    else
      call check_train(c, values)
      if (has_train_problem()) return
      call check_bodies()
      call check_piston_pin(c, values)
    end if
    do i = 1, n_places
      call check_joint(c%joints(in_order(i)), in_order(i))
    end do
    do i = 1, n_places
      call check_friction(c%joints(in_order(i)), in_order(i))
    end do
    call check_shared_laws()
    call check_start()
    if (.not. allocated(c%load)) then
      call check_guide(c, values)
      call check_elastic(c, values)
      call check_gas()
      call check_drive()
    end if
    call check_periods()
    call check_run()
    call check_output()

  contains

    !> Whether cylinders or crankshaft are wrong.
    logical function has_train_problem()
      integer :: k
      has_train_problem = values%problems%concerns('crankshaft')
      do k = 1, size(values%groups)
        if (values%groups(k)%number > 0) has_train_problem = has_train_problem .or. &
          values%problems%concerns(trim(values%groups(k)%name))
      end do
    end function has_train_problem

    !> Note an error of a value of the case if it is wrong.
    subroutine forbid(is_wrong, group, name, wanted)
      logical, intent(in) :: is_wrong
      character(len=*), intent(in) :: group, name, wanted
      call values%forbid(is_wrong, group, name, wanted)
    end subroutine forbid

    !> Check that the rod is long enough, and that the mass matrix of crank and rod is positive definite at every crank angle. With
    !> A = I_c + m_c |com_c|^2 and B = I_r + m_r |com_r|^2 its smallest determinant is A B + m_r R^2 I_r.
    subroutine check_bodies()
      character(len=*), parameter :: away = 'must be > 0 unless crank_mass is > 0 away from the axis'
      character(len=:), allocatable :: key
      real(dp) :: play, crank, rod
      logical :: is_loose(n_pins)
      associate (m => c%mechanism)
        play = sum(play_of(c%joints))
        if (m%rod_length <= m%crank_length) then
          call values%refuse('mechanism', 'rod_length', 'must be > crank_length = '//short_text(m%crank_length))
        else if (m%rod_length <= m%crank_length + play) then
          call values%refuse('mechanism', 'rod_length', 'must be > crank_length + clearance = '//short_text(m%crank_length + play))
        else if (m%rod_length <= m%crank_length + play + bore_reach(c)) then
          key = trim(merge('bore_clearance', 'piston_com    ', c%guide%bore_clearance > abs(c%guide%piston_com(2))))
          call values%refuse('guide', key, 'lets the pin move '//short_text(bore_reach(c))//' m off the cylinder''s axis: must '// &
            'be less than rod_length - crank_length - clearance = '//short_text(m%rod_length - m%crank_length - play))
        end if
        crank = m%crank_inertia + c%drive%flywheel_inertia + m%crank_mass*sum(m%crank_com**2) + inertia_beside(c)
        rod = m%rod_inertia + m%rod_mass*sum(m%rod_com**2)
        is_loose = c%loose_pins()
        if (is_loose(crank_pin)) then
          call forbid(crank <= 0, 'mechanism', 'crank_inertia', away)
          call forbid(m%rod_mass <= 0, 'mechanism', 'rod_mass', 'must be > 0 with clearance at the crank pin')
          call forbid(m%rod_inertia <= 0, 'mechanism', 'rod_inertia', 'must be > 0 with clearance at the crank pin')
        else if (is_loose(piston_pin)) then
          call forbid(rod <= 0, 'mechanism', 'rod_inertia', 'must be > 0 unless rod_mass is > 0 away from the crank pin')
          call forbid(rod > 0 .and. crank*rod + m%rod_mass*m%crank_length**2*m%rod_inertia <= 0, 'mechanism', 'crank_inertia', &
            away//', or rod_mass and rod_inertia are')
        else
          call forbid(crank + m%rod_inertia <= 0, 'mechanism', 'crank_inertia', away//', or rod_inertia is')
        end if
      end associate
    end subroutine check_bodies

    !> Check a bearing by itself: that there is no part of a mechanism, that its joint is carried, and that its bodies are known.
    subroutine check_load()
      character(len=*), parameter :: only = 'is for a mechanism; this case has &bearing_load', &
        groups(7) = [character(len=17) :: 'mechanism', 'pin', 'guide', 'elastic_rod', 'crankshaft', 'combustion', &
        'cylinder_pressure'], &
        of_drive(4) = [character(len=16) :: 'torque', 'damping', 'flywheel_inertia', 'torque_table'], &
        of_initial(5) = [character(len=18) :: 'pin_speed', 'piston_offset', 'piston_offset_rate', 'piston_tilt', &
        'piston_tilt_rate']
      character(len=:), allocatable :: group
      integer :: k
      do k = 1, size(groups)
        if (values%is_present(find_group(values%groups, trim(groups(k))))) call values%refuse_group(trim(groups(k)), only)
      end do
      do k = 1, size(values%groups)
        if (values%groups(k)%number > 0 .and. values%is_present(k)) call values%refuse_group(trim(values%groups(k)%name), only)
      end do
      do k = 2, n_places
        group = joint_group(in_order(k))
        if (values%is_present(find_group(values%groups, group))) call values%refuse_group(group, only)
      end do
      do k = 1, size(of_drive)
        call forbid(values%is_said(values%place_of('drive', trim(of_drive(k)))), 'drive', trim(of_drive(k)), only)
      end do
      call forbid(c%drive%kind == 'free' .and. values%is_given('drive', 'kind'), 'drive', 'kind', &
        'must be constant_speed with &bearing_load')
      do k = 1, size(of_initial)
        call forbid(values%is_said(values%place_of('initial', trim(of_initial(k)))), 'initial', trim(of_initial(k)), only)
      end do
      call forbid(.not. c%joints(in_order(1))%is_carried(), 'joint', 'kind', 'must be quasi_static with &bearing_load')
      call forbid(mod(c%load%period_deg, 360) /= 0, 'bearing_load', 'period_deg', 'must be a multiple of 360')
      call values%demand(c%load%crank_to_rod > 0 .or. .not. c%load%needs_rod(), 'bearing_load', 'crank_to_rod', &
        'where frame, journal or bearing is rod')
    end subroutine check_load

    !> The clearance of a joint, unless it is wrong by itself [m].
    elemental real(dp) function play_of(joint)
      type(joint_case_t), intent(in) :: joint
      play_of = 0
      if (joint%has_clearance() .and. joint%clearance < joint%bearing_radius) play_of = joint%clearance
    end function play_of

    !> Check that an ideal joint has neither contact nor film, and that a joint with clearance has at least one of them.
    subroutine check_joint(joint, place)
      type(joint_case_t), intent(in) :: joint
      integer, intent(in) :: place                !! index in `places`
      character(len=:), allocatable :: group      !! of the joint
      logical :: bearing_turns
      group = joint_group(place)
      if (allocated(c%load) .and. .not. joint%is_carried()) return   ! refused already
      call forbid(place == main_bearing .and. joint%has_clearance(), group, 'kind', &
        'must be ideal or quasi_static: the crank turns about a fixed axis')
      call forbid(place /= main_bearing .and. abs(joint%load_share - 1) > 0, group, 'load_share', &
        'is for place = ''main_bearing'' alone')
      if (.not. joint%has_bearing()) then
        call forbid(has_own_law(place) .or. place == in_order(1) .and. (allocated(joint%contact) .or. &
          allocated(joint%friction) .or. allocated(joint%film) .or. allocated(joint%asperities) .or. allocated(joint%wear) .or. &
          allocated(joint%heat)), &
          group, 'kind', &
          'must be clearance (or quasi_static) with contact, friction or lubrication: an ideal joint has no '// &
          'clearance; remove these groups, for example with --set contact=none')
        call check_ideal(group)
        return
      end if
      if (allocated(joint%film)) call check_oil(joint, law_group('lubrication', place))
      if (allocated(joint%heat)) call check_heat(joint, law_group('lubrication', place), law_group('heat', place))
      call values%demand(joint%clearance > 0, group, 'clearance', 'with kind = '''//joint%kind//'''')
      call values%demand(joint%bearing_radius > 0, group, 'bearing_radius', 'with kind = '''//joint%kind//'''')
      if (joint%bearing_radius > 0) call forbid(joint%bearing_radius <= joint%clearance, group, 'clearance', &
        'must be < bearing_radius = '//short_text(joint%bearing_radius)//': the pin''s radius is the difference')
      call values%demand(joint%bearing_length > 0 .or. .not. allocated(joint%film), group, 'bearing_length', 'with lubrication')
      if (allocated(joint%film) .and. joint%bearing_radius > 0) call forbid( &
        joint%bearing_length/joint%bearing_radius/2 > joint%film%longest_bearing(), group, 'bearing_length', &
        'must be <= '//short_text(joint%film%longest_bearing())//' times the diameter with this film; that of a long '// &
        'bearing is law = ''pinkus_sternlicht''')
      if (joint%is_carried()) call check_carried(joint, place)
      call forbid(joint%has_clearance() .and. .not. (allocated(joint%contact) .or. allocated(joint%film)), group, 'kind', &
        'needs contact or lubrication: without them no force would act on the pin')
      call forbid(allocated(joint%friction) .and. .not. (allocated(joint%contact) .or. joint%is_carried()), &
        law_group('friction', place), 'law', &
        'needs the group contact: dry friction follows the normal force')
      call check_film_history(joint, group, place)
      if (values%problems%concerns(group)) return
      if (allocated(joint%asperities)) then
        call check_asperities(joint, law_group('asperities', place))
      else if (allocated(joint%contact)) then
        call check_contact(joint, group, law_group('contact', place))
      end if
      bearing_turns = places(place)%bearing /= body_piston .or. c%has_loose_guide()
      if (allocated(joint%wear)) call check_wear(joint, bearing_turns, group, law_group('wear', place))
      if (.not. allocated(joint%film)) return
      call check_thinning(joint, law_group('lubrication', place))
      call check_transition(joint, law_group('lubrication', place))
      call check_elastic_film(joint, law_group('lubrication', place), law_group('contact', place))
    end subroutine check_joint

    !> Check that a joint that is ideal by default has no values of a bearing.
    subroutine check_ideal(group)
      character(len=*), intent(in) :: group   !! of the joint
      integer :: i
      if (values%is_given(group, 'kind')) return
      associate (range => values%groups(find_group(values%groups, group)))
        do i = range%first, range%last
          call forbid(values%is_said(i), group, trim(values%keys(i)%name), 'needs kind = ''clearance''; the default is ideal')
        end do
      end associate
    end subroutine check_ideal

    !> Check the groups of a film with memory.
    subroutine check_film_history(joint, group, place)
      type(joint_case_t), intent(in) :: joint
      character(len=*), intent(in) :: group   !! of the joint
      integer, intent(in) :: place            !! index in `places`
      character(len=:), allocatable :: own, oil, supply, bore, cavitation
      integer :: key
      own = law_group('film_history', place)
      oil = law_group('lubrication', place)
      supply = law_group('supply', place)
      bore = law_group('bore', place)
      cavitation = ''
      key = values%place_of(oil, 'cavitation')
      if (allocated(joint%film)) then
        if (values%is_used(key)) cavitation = values%values(key)%text
      end if
      associate (history => joint%history)
        if (.not. allocated(history%march)) then
          call forbid(allocated(history%supply), supply, 'kind', 'needs the group film_history, whose film it feeds')
          call forbid(allocated(history%bore), bore, 'outer_radius', 'needs the group film_history, whose film deforms it')
          call forbid(joint%ambient_over_cavitation > 0, oil, 'ambient_over_cavitation', 'needs the group film_history')
          call forbid(cavitation == 'mass_conserving', oil, 'cavitation', &
            'needs the group film_history, whose film conserves its oil')
          return
        end if
        call forbid(.not. allocated(joint%film), own, 'drive', 'needs the group lubrication: the film of that joint')
        call forbid(history%march%table /= '', own, 'table', 'must not be given with &mechanism: the run gives the load')
        call forbid(mod(history%march%cycle_deg, 360) /= 0, own, 'cycle_deg', 'must be a multiple of 360')
        call forbid(cavitation == 'gumbel' .or. cavitation == 'none', oil, 'cavitation', &
          'must be mass_conserving with film_history, or reynolds for a film without memory, for comparison')
        call forbid(cavitation == 'reynolds' .and. .not. values%is_given(oil, 'cavitation'), oil, 'cavitation', &
          'must be given with film_history: mass_conserving, or reynolds for a film without memory')
        if (values%problems%concerns(group)) return
        call check_history(values, history, joint%bearing_radius, joint%bearing_length, joint%elastic%pressure_viscosity, &
          joint%ambient_over_cavitation, supply, bore)
        if (.not. allocated(history%supply)) return
        associate (feed => history%supply%feed)
          if (.not. (feed%is_wanted() .and. allocated(feed%x))) return
          call forbid(any(feed%y < 0), supply, 'pressure_table', 'must have pressures >= 0, above ambient')
          call forbid(feed%x(size(feed%x)) - feed%x(1) > history%march%cycle_deg*(1 + rounding), supply, 'pressure_table', &
            'must not span more than cycle_deg')
        end associate
      end associate
    end subroutine check_film_history

    !> Check that a film alone carries the load of a pin that is ideal in the mechanism.
    subroutine check_carried(joint, place)
      type(joint_case_t), intent(in) :: joint
      integer, intent(in) :: place   !! index in `places`
      call forbid(.not. allocated(joint%film), joint_group(place), 'kind', &
        'quasi_static needs the group lubrication: a film carries the load')
      call forbid(allocated(joint%friction), law_group('friction', place), 'law', &
        'is not for kind = ''quasi_static'': no contact law acts there; give the group the place of another joint')
      call forbid(place == main_bearing .and. allocated(c%cylinders), joint_group(place), 'kind', &
        'must be ideal with further cylinders: the load of a single bearing of the crankshaft is not known')
      if (.not. allocated(joint%film)) return
      call forbid(allocated(joint%contact) .and. .not. joint%elastic%is_wanted, law_group('contact', place), 'law', &
        'is not for kind = ''quasi_static'' unless elastic_film = .true.: the film carries all of the load')
      call forbid(.not. joint%film%is_quasi_static(), law_group('lubrication', place), 'law', &
        'must give a force that depends on the velocity of the pin alone, with kind = ''quasi_static'': finite_bearing, or '// &
        'closed_form and half_film of pinkus_sternlicht')
    end subroutine check_carried

    !> Check that the viscosity of the film is given by one source.
    subroutine check_oil(joint, group)
      type(joint_case_t), intent(in) :: joint
      character(len=*), intent(in) :: group   !! group of the film
      character(len=*), parameter :: names(2) = [character(len=19) :: 'viscosity', 'kinematic_viscosity']
      character(len=:), allocatable :: key, wanted
      integer :: i, place
      logical :: is_said
      do i = 1, size(names)
        key = trim(names(i))
        place = values%place_of(group, key)
        is_said = values%is_said(place)
        if (joint%oil%is_known()) then
          call forbid(is_said, group, key, 'must not be given: viscosity_law = '''//joint%oil%law//''' computes it')
        else if (values%is_used(place)) then
          call values%demand(is_said, group, key, adjustl(values%by_law(values%keys(place))))
        end if
      end do
      if (joint%oil%is_known()) then
        call joint%oil%conflict(key, wanted)
        call forbid(key /= '', group, key, wanted)
      else
        call forbid(joint%oil%temperature > 0 .and. .not. values%is_given(group, 'viscosity_law'), group, 'temperature', &
          'needs viscosity_law = ''walther'' or ''vogel''; the default is given')
      end if
    end subroutine check_oil

    !> Check that the film that heats up is one of an oil, whose force is proportional to its viscosity, and that heat can leave it.
    subroutine check_heat(joint, own, group)
      type(joint_case_t), intent(in) :: joint
      character(len=*), intent(in) :: own, group   !! groups of the film and of the heat
      call forbid(.not. allocated(joint%film), group, 'heat_capacity', 'needs the group lubrication: it is the film that heats up')
      if (.not. allocated(joint%film)) return
      call forbid(.not. joint%oil%is_known(), own, 'viscosity_law', &
        'must not be given: &heat needs an oil: oil, or viscosity_law = walther or vogel')
      call forbid(.not. joint%film%is_quasi_static(), group, 'heat_capacity', &
        'is for films whose force is proportional to the viscosity: finite_bearing, and closed_form and half_film of '// &
        'pinkus_sternlicht')
      associate (heat => joint%heat)
        call forbid(.not. (joint%film%gives_side_flow() .or. heat%side_flow > 0 .or. heat%conductance > 0), group, 'side_flow', &
          'required with this film, which has no side flow, unless conductance is given: no heat would leave')
        call forbid(joint%oil%law == 'vogel' .and. joint%oil%vogel_temperature > min(heat%inlet_temperature, heat%around()) - 10, &
          own, 'vogel_temperature', 'must be 10 K or more below inlet_temperature and housing_temperature')
      end associate
    end subroutine check_heat

    !> Check that a film that thins with the shear is one of a quasi-static law between rigid walls.
    subroutine check_thinning(joint, own)
      type(joint_case_t), intent(in) :: joint
      character(len=*), intent(in) :: own   !! group of the film
      associate (oil => joint%oil)
        call values%demand(oil%thinning_rate > 0 .or. .not. oil%thinning_ratio < 1, own, 'thinning_rate', 'with thinning_ratio')
        call forbid(oil%thinning_rate > 0 .and. .not. (oil%thinning_ratio < 1 .or. values%is_given(own, 'thinning_ratio')), own, &
          'thinning_rate', 'needs thinning_ratio, by which the viscosity is reduced')
        if (.not. oil%thinning_ratio < 1) return
        call forbid(.not. joint%film%is_quasi_static(), own, 'thinning_ratio', &
          'is for films whose force is proportional to the viscosity: finite_bearing, and closed_form and half_film of '// &
          'pinkus_sternlicht')
        call forbid(joint%elastic%is_wanted, own, 'thinning_ratio', 'cannot be combined with elastic_film')
      end associate
    end subroutine check_thinning

    !> Check that a film and a contact that share the load both exist, and share it over a range of penetrations.
    subroutine check_transition(joint, own)
      type(joint_case_t), intent(in) :: joint
      character(len=*), intent(in) :: own   !! group of the film
      associate (depth => joint%transition%depth)
        if (.not. joint%transition%is_weighted()) then
          call forbid(depth > 0 .and. .not. values%is_given(own, 'transition'), own, 'transition_depth', &
            'needs transition = ''weighted''; the default is switch')
          return
        end if
        call forbid(joint%is_carried(), own, 'transition', 'must be switch with kind = ''quasi_static'': the film carries all '// &
          'of the load')
        if (joint%is_carried()) return
        call forbid(allocated(joint%asperities), own, 'transition', &
          'must be switch with asperities: they carry with the film at every depth')
        call forbid(.not. allocated(joint%contact), own, 'transition', 'needs the group contact: film and contact share the load')
        call values%demand(depth > 0, own, 'transition_depth', 'with transition = ''weighted''')
        call forbid(depth > joint%clearance, own, 'transition_depth', 'must be <= clearance = '//short_text(joint%clearance))
      end associate
    end subroutine check_transition

    !> Check that elastic walls have a stiffness and no loss, that the law of the film between them gives a velocity for a load, and
    !> that no contact law acts.
    subroutine check_elastic_film(joint, own, contact)
      type(joint_case_t), intent(in) :: joint
      character(len=*), intent(in) :: own, contact   !! groups of the film and of the contact
      if (.not. joint%elastic%is_wanted) then
        call forbid(joint%elastic%pressure_viscosity > 0 .and. .not. allocated(joint%history%march), own, 'pressure_viscosity', &
          'needs elastic_film = .true.: the pressures between rigid walls are not realistic')
        return
      end if
      call forbid(.not. allocated(joint%contact), own, 'elastic_film', &
        'needs the group contact, whose geometry is the stiffness of the walls')
      if (.not. allocated(joint%contact)) return
      call forbid(.not. joint%contact%is_elastic(), contact, 'law', 'must be hertz with elastic_film: the film dissipates, '// &
        'the walls do not')
      call forbid(allocated(joint%friction), own, 'elastic_film', &
        'cannot be combined with the group friction: the surfaces never touch')
      call forbid(joint%transition%is_weighted(), own, 'elastic_film', &
        'cannot be combined with transition = ''weighted'': the film carries at every depth')
      call forbid(.not. joint%film%is_quasi_static(), own, 'elastic_film', &
        'is for films of wedge and squeeze: finite_bearing, and closed_form and half_film of pinkus_sternlicht')
    end subroutine check_elastic_film

    !> Check that asperities are combined with a film and not with a contact law.
    subroutine check_asperities(joint, group)
      type(joint_case_t), intent(in) :: joint
      character(len=*), intent(in) :: group   !! group of the asperities
      real(dp), parameter :: roughest = 0.125_dp   !! largest roughness over clearance
      call forbid(.not. allocated(joint%film), group, 'roughness', 'needs the group lubrication: asperities touch through a film')
      call forbid(allocated(joint%contact), group, 'roughness', &
        'cannot be combined with the group contact: asperities are the contact of rough surfaces')
      call forbid(joint%asperities%roughness > roughest*joint%clearance, group, 'roughness', &
        'must be <= clearance/8 = '//short_text(roughest*joint%clearance)//': a centred pin may not touch')
    end subroutine check_asperities

    !> Check that wear has a rate, and a contact that wears.
    subroutine check_wear(joint, bearing_turns, group, wear_group)
      type(joint_case_t), intent(in) :: joint
      logical, intent(in) :: bearing_turns
      character(len=*), intent(in) :: group, wear_group   !! groups of the joint and of its wear
      call forbid(.not. any(joint%wear%rate > 0), wear_group, 'rate', 'must be > 0 for the pin or the bore')
      call forbid(.not. (joint%can_touch() .or. allocated(joint%asperities)), wear_group, 'rate', &
        'needs surfaces that touch: the group contact without elastic_film, or asperities')
      call values%demand(joint%bearing_length > 0, group, 'bearing_length', 'with wear')
      call check_worn_bore(joint, wear_group, bearing_turns)
    end subroutine check_wear

    !> Check that a bore whose shape changes belongs to a dry joint on a foundation, in a piston that does not tilt.
    subroutine check_worn_bore(joint, group, turns)
      type(joint_case_t), intent(in) :: joint
      character(len=*), intent(in) :: group   !! group of the wear
      logical, intent(in) :: turns            !! the bore turns
      integer, parameter :: least_bins = 36
      class(friction_law_t), allocatable :: friction
      if (joint%wear%bore == 'round') then
        call forbid(joint%wear%extrapolation > 1, group, 'extrapolation', 'is for bore = ''worn'' alone')
        call forbid(joint%wear%cycles_per_update > 1, group, 'cycles_per_update', 'is for bore = ''worn'' alone')
        return
      end if
      call forbid(allocated(joint%film), group, 'bore', 'must be round with lubrication: the films are those of round bores')
      if (allocated(joint%film) .or. .not. allocated(joint%contact)) return
      call forbid(.not. joint%contact%geometry%has_foundation(), group, 'bore', 'worn needs &contact geometry = ''winkler''')
      call forbid(turns, group, 'bore', 'worn is for the piston pin in a piston that does not tilt')
      call forbid(.not. joint%wear%rate(of_bore) > 0, group, 'rate', 'must be > 0 for the bore with bore = ''worn''')
      call forbid(joint%wear%bins < least_bins, group, 'bins', 'must be >= 36 with bore = ''worn''')
      call forbid(c%run%is_until_periodic() .or. c%run%lyapunov_revolutions > 0, group, 'bore', &
        'worn cannot be combined with &run until = ''periodic'' or lyapunov_revolutions: the bore changes')
      if (.not. allocated(joint%friction)) return
      allocate (friction, source=joint%friction)
      call friction%prepare()
      call forbid(friction%set_valued, group, 'bore', &
        'worn cannot be combined with a friction law in which the surfaces stick; ambrosio or lugre, for example, can')
    end subroutine check_worn_bore

    !> Check that the loss of a contact is given by one key, and that its geometry is possible in its bearing.
    subroutine check_contact(joint, group, contact_group)
      type(joint_case_t), intent(in) :: joint
      character(len=*), intent(in) :: group, contact_group   !! groups of the joint and of its contact
      character(len=:), allocatable :: key, wanted
      if (values%is_said(values%place_of(contact_group, 'dissipation'))) &
        call values%check_family(contact_group, 'dissipation')
      associate (geometry => joint%contact%geometry)
        call values%demand(joint%bearing_length > 0 .or. .not. geometry%needs_length(), group, 'bearing_length', &
          'with contact geometry = '''//trim(geometry%name)//'''')
        if (geometry%needs_length() .and. .not. joint%bearing_length > 0) return
        call geometry%bearing_conflict(joint%bearing(rod_length=0.0_dp), key, wanted)
        call forbid(key /= '', group, key, wanted)
      end associate
    end subroutine check_contact

    !> Check that at the beginning of a contact friction does not exceed static friction at the sliding speeds of an ideal joint.
    !> These are at most the sum of the angular speeds of both bodies times the pin radius; that of the rod is at most the crank
    !> speed times the ratio of crank to rod length.
    subroutine check_friction(joint, place)
      type(joint_case_t), intent(in) :: joint
      integer, intent(in) :: place   !! index in `places`
      real(dp) :: turning(n_bodies), speed, limit
      if (.not. (joint%has_clearance() .and. allocated(joint%friction))) return
      associate (m => c%mechanism, bearing => joint%bearing(c%mechanism%rod_length))
        turning(body_crank) = 1
        turning([body_big_end, body_small_end]) = m%crank_length/m%rod_length
        turning(body_piston) = 0
        speed = turning(places(place)%pin_body) + turning(places(place)%bearing)
        speed = speed*abs(c%initial%crank_speed)*bearing%pin_radius()
      end associate
      limit = joint%friction%touch_down_limit()
      if (speed > limit) call values%refuse(law_group('friction', place), 'damping_speed', 'a constant bristle_damping gives '// &
        'more than the static friction at touch-down from '//short_text(limit)//' m/s on, and this joint slides with '// &
        short_text(speed)//' m/s: must be > 0')
    end subroutine check_friction

    !> Check that a law for all joints acts in one of them, where joints have laws of their own. It gives way to those that an
    !> override has begun, with its values.
    subroutine check_shared_laws()
      character(len=len(values%groups%name)) :: name, own
      logical :: acts, gives_way
      integer :: k, i
      if (.not. any(c%joints%has_bearing())) return
      do k = 1, size(values%groups)
        if (.not. (values%groups(k)%is_law .and. values%is_present(k))) cycle
        name = values%groups(k)%name
        acts = .false.
        gives_way = .false.
        do i = 1, n_places
          if (.not. c%joints(i)%has_bearing()) cycle
          own = law_group(trim(name), i)
          acts = acts .or. own == name
          gives_way = gives_way .or. values%line(find_group(values%groups, own)) == behind_file
        end do
        if (acts) cycle
        if (.not. gives_way) call values%refuse_group(trim(name), &
          'acts nowhere, since every joint has a group of its own (place = ...): set that one')
        values%is_present(k) = .false.
      end do
    end subroutine check_shared_laws

    !> Whether the case has a law for the joint at this place alone.
    logical function has_own_law(place)
      integer, intent(in) :: place   !! index in `places`
      has_own_law = any(values%is_present .and. index(values%groups%name, trim(places(place)%name)//'.') == 1 .and. &
                        values%groups%name /= trim(places(place)%name)//'.joint')
    end function has_own_law

    !> Name of the group in which the law of a joint is given.
    function law_group(name, place) result(group)
      character(len=*), intent(in) :: name
      integer, intent(in) :: place   !! index in `places`
      character(len=:), allocatable :: group
      group = values%law_group(name, trim(places(place)%name))
    end function law_group

    !> Check that the initial positions of the pins are admissible.
    subroutine check_start()
      real(dp) :: distance(n_places)
      integer :: place
      associate (start => c%initial, m => c%mechanism)
        distance = norm2(start%eccentricity, 1)
        do place = 1, n_places
          call check_pin(c%joints(in_order(place)), joint_group(in_order(place)), name_prefix(in_order(place)), &
            distance(in_order(place)), start%eccentricity_rate(:, in_order(place)))
        end do
        if (values%problems%concerns('mechanism') .or. values%problems%concerns('initial') .or. allocated(c%load)) return
        place = in_order(max(1, findloc(distance(in_order) > 0, .true., 1)))
        call forbid(sum(distance, c%joints%has_clearance()) >= m%rod_length - m%crank_length, 'initial', &
          name_prefix(place)//'eccentricity', &
          'must be shorter than rod_length - crank_length = '//short_text(m%rod_length - m%crank_length))
      end associate
    end subroutine check_start

    !> Check that a pin starts inside its bearing, or, with a contact law, in its wall but not beyond it.
    subroutine check_pin(joint, group, prefix, distance, rate)
      type(joint_case_t), intent(in) :: joint
      character(len=*), intent(in) :: group    !! group of the joint
      character(len=*), intent(in) :: prefix   !! prefix of the keys
      real(dp), intent(in) :: distance, rate(2)
      associate (key => prefix//'eccentricity')
        if (joint%has_bearing()) then
          if (values%problems%concerns(group)) return
          if (distance >= joint%bearing_radius) then
            call values%refuse('initial', key, 'must be shorter than bearing_radius = '//short_text(joint%bearing_radius)// &
              ': the pin would leave its bearing')
          else if (.not. (joint%can_touch() .or. allocated(joint%asperities)) .and. distance >= joint%clearance*(1 - rounding)) then
            call values%refuse('initial', key, 'must be shorter than the clearance, '//short_text(joint%clearance)// &
              ', where there is no contact')
          end if
          call forbid(joint%is_carried() .and. norm2(rate) > 0, 'initial', key//'_rate', &
            'must be 0 with kind = ''quasi_static'': it follows from the load')
        else
          call forbid(distance > 0, 'initial', key, 'must be 0 in an ideal joint')
          call forbid(norm2(rate) > 0, 'initial', key//'_rate', 'must be 0 in an ideal joint')
        end if
      end associate
    end subroutine check_pin

    !> Check that pressure fields are requested only of films with a pressure.
    subroutine check_film_times()
      logical :: has_film
      integer :: place
      if (c%output%film_times == '') return
      has_film = .false.
      do place = 1, n_places
        if (allocated(c%joints(place)%film)) has_film = has_film .or. c%joints(place)%film%gives_pressure() .or. &
          allocated(c%joints(place)%history%march)
      end do
      call forbid(.not. allocated(c%output%snapshot_times), 'output', 'film_times', &
        'must be times >= 0 in rising order with commas, or from:to:count')
      call forbid(.not. has_film, 'output', 'film_times', 'needs a film with a pressure: pinkus_sternlicht or finite_bearing')
      if (.not. allocated(c%output%snapshot_times)) return
      if (maxval(c%output%snapshot_times) > known_end()*(1 + rounding)) call forbid(.true., 'output', 'film_times', &
        'must not be after the end of the run at '//short_text(known_end())//' s')
    end subroutine check_film_times

    !> Check that there is one gas model at most, with an allowed period.
    subroutine check_gas()
      if (.not. allocated(c%measured)) return
      call forbid(allocated(c%combustion), 'cylinder_pressure', 'table', &
        'cannot be combined with the group combustion: one pressure acts on the piston')
      call forbid(c%measured%is_external() .and. c%measured%curve%is_wanted(), 'cylinder_pressure', 'table', &
        'must not be given with kind = ''external''')
      call forbid(c%measured%is_external() .and. c%run%is_until_periodic(), 'cylinder_pressure', 'kind', &
        'must be table with &run until = ''periodic'': a pressure from outside need not repeat')
      call forbid(all(c%measured%period_deg /= measured_pressure_periods), 'cylinder_pressure', 'period_deg', 'must be 360 or 720')
    end subroutine check_gas

    !> Check that the keys of a variable drive match its kind, and that there is one flywheel at most.
    subroutine check_drive()
      associate (drive => c%drive)
        call forbid(drive%table%is_wanted() .and. drive%kind /= 'free', 'drive', 'torque_table', &
          'needs kind = ''free'': at constant speed the drive supplies whatever torque is needed')
        call forbid(drive%ramp_time > 0 .and. drive%kind /= 'constant_speed', 'drive', 'ramp_time', &
          'needs kind = ''constant_speed'': the loads make the speed of a free crank')
        call forbid(abs(drive%ramp_from) > 0 .and. .not. drive%ramp_time > 0, 'drive', 'ramp_from', &
          'needs ramp_time, the time in which the speed rises from here to crank_speed')
        call forbid(drive%ramp_time > 0 .and. c%integrator%crank_revolutions > 0, 'drive', 'ramp_time', &
          'needs revolutions or end_time instead of crank_revolutions')
        call forbid(drive%flywheel_inertia > 0 .and. allocated(c%crankshaft), 'drive', 'flywheel_inertia', &
          'must be 0 with the group crankshaft, which has its own flywheel_inertia')
      end associate
    end subroutine check_drive

    !> Check that the end of the run is given once and is reached.
    subroutine check_run()
      real(dp) :: held_end   ! time in which a held crank makes crank_revolutions [s]
      associate (run => c%integrator, is_held => c%drive%kind == 'constant_speed')
        if (.not. c%run%is_until_periodic()) call values%check_family('integrator', 'revolutions')
        call forbid(run%revolutions > 0 .and. .not. (turns .or. c%run%is_until_periodic()), 'integrator', 'revolutions', &
          'needs crank_speed other than 0; give end_time')
        call forbid(run%crank_revolutions > 0 .and. .not. turns .and. is_held, 'integrator', 'crank_revolutions', &
          'needs crank_speed other than 0: the crank is held at rest')
        call forbid(run%crank_revolutions > 0 .and. .not. turns .and. run%end_time <= 0, 'integrator', 'crank_revolutions', &
          'needs end_time beside it with crank_speed = 0: the latest end, should the crank not make them')
        if (is_held .and. turns) then
          held_end = run%crank_revolutions*two_pi/abs(c%initial%crank_speed)
          if (run%end_time > 0 .and. run%end_time < held_end) call forbid(.true., 'integrator', 'end_time', &
            'must be >= '//short_text(held_end)//' s, when the held crank has made crank_revolutions')
        end if
        call forbid(run%contact_entry == 'step_rejection' .and. run%max_penetration <= 0, 'integrator', 'max_penetration', &
          'must be > 0 for contact_entry = ''step_rejection''')
      end associate
    end subroutine check_run

    !> Check that in a run until the motion is periodic the crank turns, and that enough revolutions are allowed.
    subroutine check_periods()
      associate (run => c%run, is_cut => c%output%window == 'last_period')
        call forbid(run%lyapunov_revolutions > 0 .and. .not. (turns .and. (c%has_play() .or. c%drive%kind == 'free')), 'run', &
          'lyapunov_revolutions', 'needs crank_speed other than 0, and clearance at a joint or a free crank')
        if (.not. run%is_until_periodic()) then
          call forbid(is_cut, 'output', 'window', 'is for &run until = ''periodic'' alone')
          return
        end if
        call forbid(.not. turns, 'run', 'until', 'needs crank_speed other than 0')
        call forbid(run%period_revolutions < c%forced_revolutions(), 'run', 'period_revolutions', &
          'must be >= '//integer_text(c%forced_revolutions())//', what the gas or the load takes to repeat')
        call forbid(is_cut .and. c%output%start_time > 0, 'output', 'start_time', 'must be 0 with window = ''last_period''')
        call forbid(is_cut .and. run%most_revolutions <= run%period_revolutions, 'run', 'most_revolutions', &
          'must be > period_revolutions with window = ''last_period''')
      end associate
    end subroutine check_periods

    !> The end of the run, or its latest end, if the case says it [s]; the largest number if it depends on the motion.
    pure real(dp) function known_end()
      known_end = huge(known_end)
      if (c%run%is_until_periodic()) return
      if (c%integrator%end_time > 0) known_end = c%integrator%end_time
      if (.not. turns) return
      if (c%integrator%revolutions > 0) known_end = min(known_end, c%integrator%revolutions*two_pi/abs(c%initial%crank_speed))
      if (c%integrator%crank_revolutions > 0 .and. c%drive%kind == 'constant_speed') known_end = &
        min(known_end, c%integrator%crank_revolutions*two_pi/abs(c%initial%crank_speed))
    end function known_end

    !> Check that the spacing of the rows is given, and that there are not too many rows.
    subroutine check_output()
      real(dp) :: samples, speed, end_time
      character(len=*), parameter :: letters = 'abcdefghijklmnopqrstuvwxyz0123456789_, '
      associate (output => c%output)
        if (output%sampling == 'crank_angle') then
          call forbid(output%interval > 0, 'output', 'interval', 'must not be given with sampling = ''crank_angle''')
          call forbid(output%every_step, 'output', 'every_step', 'must be .false. with sampling = ''crank_angle''')
        else
          call forbid(abs(output%angle_origin_deg) > 0, 'output', 'angle_origin_deg', 'is for sampling = ''crank_angle'' alone')
          call forbid(output%interval <= 0 .and. .not. turns, 'output', 'interval', 'required with crank_speed = 0')
        end if
        if (output%start_time >= known_end()) call forbid(.true., 'output', 'start_time', &
          'must be before the end of the run at '//short_text(known_end()))
        call forbid(verify(output%columns, letters) > 0 .or. output%columns == '', 'output', 'columns', &
          'must be ''standard'' or names of columns without their units')
        call check_film_times()
        speed = abs(c%initial%crank_speed)
        end_time = c%integrator%end_time
        if (turns) end_time = max(end_time, max(c%integrator%revolutions, c%integrator%crank_revolutions)*two_pi/speed)
        if (c%run%is_until_periodic() .and. turns) end_time = c%run%most_revolutions*two_pi/speed
        if (output%window == 'last_period' .and. turns) end_time = c%run%period_revolutions*two_pi/speed
        samples = end_time*speed/two_pi*output%samples_per_revolution
        if (output%interval > 0) samples = end_time/output%interval
        if (samples > most_samples) call values%refuse('output', &
          trim(merge('interval              ', 'samples_per_revolution', output%interval > 0)), 'asks for '// &
          short_text(samples, 2)//' rows in '//short_text(end_time)//' s: at most '//short_text(most_samples)//' are written')
      end associate
    end subroutine check_output
  end subroutine check_rules
end module case_rules
