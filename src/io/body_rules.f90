!> Rules that the values of a case with a guide that is not ideal, with piston rings or elastic members must obey together.
module body_rules
  use kinds, only: dp
  use constants, only: pi, two_pi
  use number_text, only: short_text
  use text_tools, only: integer_text
  use case_definition, only: case_t
  use case_schema, only: find_group, real_kind, word_kind
  use case_values, only: case_values_t
  use film_rules, only: check_oil
  use friction_law, only: friction_law_t
  use piston_skirt, only: skirt_t, corner_t, n_corners
  use ring_case, only: most_piston_rings
  use guide_case, only: guide_case_t
  use skirt_film, only: skirt_film_t
  use chain_motion, only: tilting_t, motion_t, accelerations_t, turn_crank, piston_pin, n_pins
  use chain_bodies, only: rod_t, crank_t, piston_t, bodies_t, new_bodies, drive_t
  use chain_loads, only: loads_t, unloaded
  use elastic_rod, only: elastic_rod_t, largest_shank
  use train_builder, only: inertia_beside
  use assembled_chain, only: accelerate_assembled
  implicit none
  private
  public :: check_guide, check_rings, check_elastic, bore_reach

contains

  !> Largest distance of the pin's bearing from the cylinder's axis that the bore allows [m].
  pure real(dp) function bore_reach(c)
    type(case_t), intent(in) :: c
    bore_reach = 0
    if (.not. c%has_loose_guide()) return
    associate (guide => c%guide)   ! the piston is tilted until top and bottom of the skirt touch opposite walls
      bore_reach = guide%bore_clearance + abs(guide%piston_com(2))
      if (guide%skirt_top + guide%skirt_bottom > 0) &
        bore_reach = bore_reach + abs(guide%piston_com(1))*2*guide%bore_clearance/(guide%skirt_top + guide%skirt_bottom)
    end associate
  end function bore_reach

  !> Check that a guide has the keys of its kind, that its friction does not jam the piston, and that the piston starts in its bore.
  subroutine check_guide(c, values)
    type(case_t), intent(in) :: c
    type(case_values_t), intent(inout) :: values
    character(len=*), parameter :: sizes(6) = [character(len=14) :: 'bore_clearance', 'skirt_top', 'skirt_bottom', &
      'piston_radius', 'piston_inertia', 'stiffness']
    character(len=*), parameter :: starts(4) = [character(len=18) :: 'piston_offset', 'piston_offset_rate', 'piston_tilt', &
      'piston_tilt_rate']
    integer :: i
    if (c%has_loose_guide()) then
      do i = 1, merge(size(sizes), size(sizes) - 1, c%has_skirt_corners())
        call values%demand(values%is_said(values%place_of('guide', trim(sizes(i)))), 'guide', trim(sizes(i)), &
          'with kind = '''//c%guide%kind//'''')
      end do
      if (c%has_skirt_corners() .and. .not. values%problems%concerns('guide')) call values%forbid(.not. c%guide%stiffness > 0, &
        'guide', 'stiffness', 'must be > 0 with kind = ''clearance''')
      if (values%is_said(values%place_of('guide', 'dissipation'))) call values%check_family('guide', 'dissipation')
      if (.not. values%problems%concerns('guide')) call check_piston_start(c, values)
    else
      do i = 1, size(starts)
        call values%forbid(values%is_said(values%place_of('initial', trim(starts(i)))), 'initial', trim(starts(i)), &
          'must be 0 without clearance in the bore (&guide kind = ''clearance'')')
      end do
      if (allocated(c%guide)) call values%forbid(values%is_said(values%place_of('guide', 'bore_clearance')) .and. &
        .not. values%is_given('guide', 'kind'), 'guide', 'bore_clearance', 'needs kind = ''clearance''; the default is friction')
    end if
    call check_skirt_film(c, values)
    if (.not. allocated(c%guide)) return
    if (allocated(c%guide%friction)) call check_guide_friction(c, values)
  end subroutine check_guide

  !> Check that a lubricated skirt has oil and rough surfaces and nothing of dry corners, and that it starts in its bore.
  subroutine check_skirt_film(c, values)
    type(case_t), intent(in) :: c
    type(case_values_t), intent(inout) :: values
    character(len=*), parameter :: groups(2) = [character(len=17) :: 'guide.lubrication', 'guide.asperities'], &
      of_corners(5) = [character(len=11) :: 'contact_law', 'restitution', 'exponent', 'law', 'coefficient'], &
      needed = 'needs the groups lubrication and asperities with place = ''guide'''
    logical :: is_wanted, acts
    integer :: i, place
    is_wanted = .false.
    if (allocated(c%guide)) is_wanted = c%guide%is_lubricated()
    do i = 1, size(groups)
      associate (is_there => values%is_present(find_group(values%groups, trim(groups(i)))))
        if (is_wanted .and. .not. is_there) call values%refuse('guide', 'kind', needed)
        if (is_there .and. .not. is_wanted) call values%refuse_group(trim(groups(i)), 'needs &guide kind = ''lubricated''')
      end associate
    end do
    if (.not. is_wanted) return
    do i = 1, size(of_corners)
      place = values%place_of('guide', trim(of_corners(i)))
      if (place == 0) cycle
      associate (key => values%keys(place), value => values%values(place))
        acts = value%given(1)   ! a resolved case has defaults, and 0 for no friction
        if (key%kind == word_kind) acts = acts .and. value%text /= trim(key%default)
        if (key%kind == real_kind) acts = values%is_said(place)
        if (key%kind == real_kind) acts = acts .and. abs(value%reals(1)) > 0
      end associate
      call values%forbid(acts, 'guide', trim(of_corners(i)), &
        'is for kind = ''clearance'': a lubricated skirt has no dry corners')
    end do
    call check_profile(c, values)
    if (values%problems%concerns('guide') .or. .not. allocated(c%skirt_film%asperities)) return
    call check_oil(c%skirt_film%oil%oil, trim(groups(1)), values)
    call values%forbid(c%skirt_film%oil%oil%thinning_ratio < 1, trim(groups(1)), 'thinning_ratio', &
      'must be 1 in the oil of a skirt')
    call values%forbid(c%skirt_film%asperities%roughness >= c%guide%bore_clearance, 'guide.asperities', 'roughness', &
      'must be < bore_clearance = '//short_text(c%guide%bore_clearance))
    do i = 1, size(groups)
      if (values%problems%concerns(trim(groups(i)))) return
    end do
    if (.not. values%problems%concerns('initial')) call check_first_gap(c, values)
  end subroutine check_skirt_film

  !> Check that a table of the skirt's profile stands instead of a barrel and covers the skirt.
  subroutine check_profile(c, values)
    type(case_t), intent(in) :: c
    type(case_values_t), intent(inout) :: values
    if (.not. c%guide%profile%is_wanted()) return
    call values%forbid(c%guide%barrel > 0, 'guide', 'barrel', 'is in profile_table: one of both')
    call values%forbid(values%is_said(values%place_of('guide', 'barrel_height')), 'guide', 'barrel_height', &
      'is in profile_table: one of both')
    if (.not. allocated(c%guide%profile%x)) return
    associate (z => c%guide%profile%x)
      call values%forbid(z(1) > -c%guide%skirt_bottom .or. z(size(z)) < c%guide%skirt_top, 'guide', 'profile_table', &
        'must cover the skirt, heights from -skirt_bottom = '//short_text(-c%guide%skirt_bottom)//' m to skirt_top = '// &
        short_text(c%guide%skirt_top)//' m')
    end associate
  end subroutine check_profile

  !> Check that there is a gap everywhere between a lubricated skirt and the bore at the start.
  subroutine check_first_gap(c, values)
    type(case_t), intent(in) :: c
    type(case_values_t), intent(inout) :: values
    type(guide_case_t) :: guide
    type(skirt_film_t) :: film
    real(dp) :: gap
    guide = c%guide
    guide%film = c%skirt_film
    call film%prepare(guide)
    gap = film%film%least_relief_gap(c%initial%piston_offset, c%initial%piston_tilt)
    call values%forbid(gap < 0, 'initial', 'piston_offset', 'must leave a gap between skirt and bore: with piston_tilt it is '// &
      short_text(gap)//' m')
  end subroutine check_first_gap

  !> Check that rings have oil and a bore, and that the pressure of the gas does not rise from ring to ring.
  subroutine check_rings(c, values)
    type(case_t), intent(in) :: c
    type(case_values_t), intent(inout) :: values
    character(len=*), parameter :: oil = 'rings.lubrication', surfaces = 'rings.asperities'
    character(len=6) :: group, first   ! names of groups
    real(dp) :: above
    integer :: i, n
    if (.not. allocated(c%rings%rings)) then
      if (values%is_present(find_group(values%groups, oil))) call values%refuse_group(oil, 'needs the group ring')
      if (values%is_present(find_group(values%groups, surfaces))) call values%refuse_group(surfaces, 'needs the group ring')
      return
    end if
    above = 1
    n = 0
    first = ''
    do i = 1, most_piston_rings
      group = 'ring_'//integer_text(i)
      if (find_group(values%groups, group) == 0) exit
      if (.not. values%is_present(find_group(values%groups, group))) cycle
      if (n == 0) first = group
      n = n + 1
      associate (ring => c%rings%rings(n))
        call values%forbid(ring%gas_above > above, group, 'gas_above', 'must be <= gas_below of the ring above it = '// &
          short_text(above))
        call values%forbid(ring%gas_behind > ring%gas_above, group, 'gas_behind', 'must be <= gas_above = '// &
          short_text(ring%gas_above))
        call values%forbid(ring%gas_below > ring%gas_behind, group, 'gas_below', 'must be <= gas_behind = '// &
          short_text(ring%gas_behind))
        above = ring%gas_below
        if (ring%has_film()) then
          if (.not. allocated(c%rings%asperities)) call values%refuse(group, 'model', 'needs the group asperities with '// &
            'place = ''rings'': a smooth ring would touch the bore')
          call values%forbid(2*abs(ring%crown_offset) >= ring%height, group, 'crown_offset', &
            'must be shorter than half of height = '//short_text(ring%height))
        else
          call values%forbid(abs(ring%crown_offset) > 0, group, 'crown_offset', 'needs model = ''film''')
        end if
      end associate
    end do
    if (.not. (allocated(c%combustion) .or. allocated(c%measured))) &
      call values%refuse_group(first, 'needs the bore of &combustion or &cylinder_pressure')
    if (.not. values%is_present(find_group(values%groups, oil))) then
      call values%refuse_group(first, 'needs the group lubrication with place = ''rings'', its oil')
      return
    end if
    call check_oil(c%rings%oil%oil, oil, values)
    call values%forbid(c%rings%oil%oil%thinning_ratio < 1, oil, 'thinning_ratio', 'must be 1 in the oil of piston rings')
  end subroutine check_rings

  !> Check that the friction law has no sticking, which the guide does not support, and that friction does not jam a piston with an
  !> ideal pin: an axial force causes a side force of at most tan A times its size, where A is at most arcsin (R + |d|)/L.
  subroutine check_guide_friction(c, values)
    type(case_t), intent(in) :: c
    type(case_values_t), intent(inout) :: values
    real(dp) :: most, speed, reach
    logical :: is_loose(n_pins)
    class(friction_law_t), allocatable :: law
    allocate (law, source=c%guide%friction)
    call law%prepare()
    call values%forbid(law%coefficient > 0 .and. law%set_valued, 'guide', 'v1', &
      'must be > 0: friction on the guide is a function of the speed')
    if (values%problems%concerns('guide') .or. values%problems%concerns('mechanism')) return
    is_loose = c%loose_pins()
    if (c%has_loose_guide() .or. is_loose(piston_pin)) return
    associate (m => c%mechanism)
      speed = 2*m%crank_length*max(abs(c%initial%crank_speed), two_pi)
      reach = m%crank_length + abs(m%axis_offset)
      most = sqrt((m%rod_length - reach)*(m%rod_length + reach))/reach
    end associate
    call values%forbid(c%guide%most_friction(speed) >= most, 'guide', 'coefficient', 'friction over normal force must stay < '// &
      short_text(most)//', the least cotangent of the rod angle: more would jam the piston')
  end subroutine check_guide_friction

  !> Check that the piston starts in its bore, or with corners in the wall but not beyond it.
  subroutine check_piston_start(c, values)
    type(case_t), intent(in) :: c
    type(case_values_t), intent(inout) :: values
    type(skirt_t) :: skirt
    type(corner_t) :: corner(n_corners)
    type(tilting_t) :: at
    skirt = c%guide%skirt()
    at%offset = c%initial%piston_offset
    at%tilt = c%initial%piston_tilt
    at%offset_rate = 0
    at%tilt_rate = 0
    call skirt%place_corners(at, corner)
    if (skirt%admits(at)) then
      call values%forbid(maxval(corner%depth) > c%guide%piston_radius, 'initial', 'piston_tilt', &
        'must not put a corner of the skirt into the bore''s wall by more than piston_radius = '//short_text(c%guide%piston_radius))
    else if (abs(at%tilt) < 1) then
      call values%refuse('initial', 'piston_offset', 'must be shorter than bore_clearance + piston_radius = '// &
        short_text(c%guide%bore_clearance + c%guide%piston_radius))
    else
      call values%refuse('initial', 'piston_tilt', 'must be > -1 and < 1')
    end if
  end subroutine check_piston_start

  !> Check that an elastic rod has mass between its pins, a shank that fits between them, and a positive definite mass matrix in its
  !> undeformed state.
  subroutine check_elastic(c, values)
    type(case_t), intent(in) :: c
    type(case_values_t), intent(inout) :: values
    type(elastic_rod_t) :: rod
    type(rod_t) :: rigid
    real(dp) :: own, least   ! moment of inertia about the crank pin without rod_inertia, and that of the transverse modes
    if (.not. allocated(c%elastic_rod) .or. values%problems%concerns('mechanism')) return
    associate (m => c%mechanism)
      rigid = rod_t(m%rod_length, m%rod_mass, m%rod_inertia, m%rod_com)
      call values%forbid(m%rod_mass <= 0, 'mechanism', 'rod_mass', 'must be > 0 with an elastic rod')
      call values%forbid(m%rod_com(1) <= 0 .or. m%rod_com(1) >= m%rod_length, 'mechanism', 'rod_com', &
        'must be between the pins, > 0 and < rod_length = '//short_text(m%rod_length)//', with an elastic rod')
      if (values%problems%concerns('mechanism')) return
      call values%forbid(c%elastic_rod%shank_mass > largest_shank(rigid)*(1 + 1e-12_dp), 'elastic_rod', 'shank_mass', &
        'must be <= '//short_text(largest_shank(rigid))//': a heavier uniform shank leaves a lump of negative mass on one of '// &
        'the pins, with this rod_mass and rod_com')
      if (values%problems%concerns('elastic_rod')) return
      rod = c%elastic_rod
      call rod%prepare(rigid)
      own = m%rod_mass*sum(m%rod_com**2)
      least = sum(rod%t(:rod%n_bending)**2)/rod%bending_mass
      call values%forbid(m%rod_inertia + own <= least, 'mechanism', 'rod_inertia', 'must be > '//short_text(least - own)// &
        ' with an elastic rod of this shank: its transverse modes alone have more')
      if (values%problems%concerns('mechanism')) return
      call values%forbid(.not. is_definite(c, rigid, rod), 'elastic_rod', 'transverse_modes', &
        'mass matrix not positive definite with these shapes: must be fewer, or rod_inertia or crank_inertia larger, or '// &
        'rod_com nearer to the line of the pins')
    end associate
  end subroutine check_elastic

  !> Whether the mass matrix of the undeformed chain is positive definite at every crank angle.
  logical function is_definite(c, rigid, rod) result(definite)
    type(case_t), intent(in) :: c
    type(rod_t), intent(in) :: rigid
    type(elastic_rod_t), intent(in) :: rod
    integer, parameter :: angles = 24
    type(bodies_t) :: bodies
    type(motion_t) :: motion
    type(loads_t) :: loads
    type(accelerations_t) :: accelerations
    real(dp) :: crank_moment
    logical :: reachable
    integer :: i
    associate (m => c%mechanism)
      bodies = new_bodies(crank_t(m%crank_length, m%crank_mass, m%crank_inertia, m%crank_com), rigid, &
        piston_t(m%piston_mass, axis_offset=m%axis_offset), [0.0_dp, 0.0_dp])
    end associate
    loads = unloaded
    motion%crank_pin = 0
    motion%crank_pin_rate = 0
    motion%offset = 0
    motion%offset_rate = 0
    motion%shape = 0
    motion%shape_rate = 0
    definite = .true.
    do i = 1, angles
      call turn_crank(motion, 2*pi*i/angles, 0.0_dp)
      call rod%follow(bodies%crank%length, bodies%piston%axis_offset, motion, reachable)
      call accelerate_assembled(bodies, drive_t(c%drive%kind == 'free' .or. allocated(c%crankshaft), 0.0_dp, 0.0_dp, 0.0_dp, &
        inertia_beside(c)), c%loose_pins(), loads, motion, accelerations, crank_moment, rod, definite)
      if (.not. definite) return
    end do
  end function is_definite
end module body_rules
