!> Rules that the joints of a case must obey: bearings, contacts, wear, and which laws act where.
module joint_rules
  use kinds, only: dp
  use case_definition, only: case_t
  use joint_case, only: joint_case_t
  use joint_places, only: places, n_places, in_order, joint_group, main_bearing, crank_pin
  use train_case, only: most_cylinders
  use value_reader, only: read_numbers
  use text_tools, only: integer_text
  use chain_motion, only: n_bodies, body_crank, body_big_end, body_small_end, body_piston, body_frame
  use archard_wear, only: of_bore
  use friction_law, only: friction_law_t
  use case_schema, only: find_group
  use case_values, only: case_values_t
  use problem_list, only: behind_file
  use film_rules, only: check_oil, check_heat, check_thinning, check_transition, check_elastic_film
  use history_rules, only: check_film_history
  use number_text, only: short_text
  implicit none
  private
  public :: check_joints

contains

  !> Note the errors of all joints and of their laws.
  subroutine check_joints(c, values)
    type(case_t), intent(in) :: c
    type(case_values_t), intent(inout) :: values
    integer :: i
    do i = 1, n_places
      call check_joint(c, c%joints(in_order(i)), in_order(i), values)
    end do
    do i = 1, n_places
      call check_friction(c, c%joints(in_order(i)), in_order(i), values)
    end do
    call check_shared_laws(c, values)
  end subroutine check_joints

  !> Check that an ideal joint has neither contact nor film, and that a joint with clearance has at least one of them.
  subroutine check_joint(c, joint, place, values)
    type(case_t), intent(in) :: c
    type(joint_case_t), intent(in) :: joint
    integer, intent(in) :: place                !! index in `places`
    type(case_values_t), intent(inout) :: values
    character(len=:), allocatable :: group, film   !! of the joint and of its film
    logical :: bearing_turns
    group = joint_group(place)
    film = values%law_group('lubrication', place)
    if (allocated(c%load) .and. .not. joint%is_carried()) return   ! refused already
    call values%forbid(place == main_bearing .and. joint%has_clearance(), group, 'kind', &
      'must be ideal or quasi_static: the crank turns about a fixed axis')
    call values%forbid(place /= main_bearing .and. abs(joint%load_share - 1) > 0, group, 'load_share', &
      'is for place = ''main_bearing'' alone')
    call check_numbers(c, joint, place, group, values)
    if (.not. joint%has_bearing()) then
      call values%forbid(has_own_law(place, values) .or. place == in_order(1) .and. (allocated(joint%contact) .or. &
        allocated(joint%friction) .or. allocated(joint%film) .or. allocated(joint%asperities) .or. allocated(joint%wear) .or. &
        allocated(joint%heat)), group, 'kind', &
        'must be clearance (or quasi_static) with contact, friction or lubrication: an ideal joint has no '// &
        'clearance; remove these groups, for example with --set contact=none')
      call check_ideal(group, values)
      return
    end if
    if (allocated(joint%film)) call check_oil(joint%oil, film, values)
    if (allocated(joint%heat)) call check_heat(joint, film, values%law_group('heat', place), values)
    call values%demand(joint%clearance > 0, group, 'clearance', 'with kind = '''//joint%kind//'''')
    call values%demand(joint%bearing_radius > 0, group, 'bearing_radius', 'with kind = '''//joint%kind//'''')
    if (joint%bearing_radius > 0) call values%forbid(joint%bearing_radius <= joint%clearance, group, 'clearance', &
      'must be < bearing_radius = '//short_text(joint%bearing_radius)//': the pin''s radius is the difference')
    call values%demand(joint%bearing_length > 0 .or. .not. allocated(joint%film), group, 'bearing_length', 'with lubrication')
    if (allocated(joint%film) .and. joint%bearing_radius > 0) call values%forbid( &
      joint%bearing_length/joint%bearing_radius/2 > joint%film%longest_bearing(), group, 'bearing_length', &
      'must be <= '//short_text(joint%film%longest_bearing())//' times the diameter with this film; that of a long '// &
      'bearing is law = ''pinkus_sternlicht''')
    if (joint%is_carried()) call check_carried(c, joint, place, values)
    call values%forbid(joint%has_clearance() .and. .not. (allocated(joint%contact) .or. allocated(joint%film)), group, 'kind', &
      'needs contact or lubrication: without them no force would act on the pin')
    call values%forbid(allocated(joint%friction) .and. .not. (allocated(joint%contact) .or. joint%is_carried()), &
      values%law_group('friction', place), 'law', &
      'needs the group contact: dry friction follows the normal force')
    call check_film_history(joint, group, place, values)
    if (values%problems%concerns(group)) return
    if (allocated(joint%asperities)) then
      call check_asperities(joint, values%law_group('asperities', place), values)
    else if (allocated(joint%contact)) then
      call check_contact(joint, group, values%law_group('contact', place), values)
    end if
    bearing_turns = places(place)%bearing /= body_piston .or. c%has_loose_guide()
    if (allocated(joint%wear)) call check_wear(c, joint, bearing_turns, group, values%law_group('wear', place), values)
    if (.not. allocated(joint%film)) return
    call check_thinning(joint, film, values)
    call check_transition(joint, film, values)
    call check_elastic_film(joint, film, values%law_group('contact', place), values)
  end subroutine check_joint

  !> Check the numbers of the bearings of several cylinders.
  subroutine check_numbers(c, joint, place, group, values)
    type(case_t), intent(in) :: c
    type(joint_case_t), intent(in) :: joint
    integer, intent(in) :: place              !! index in `places`
    character(len=*), intent(in) :: group     !! of the joint
    type(case_values_t), intent(inout) :: values
    real(dp) :: found(most_cylinders + 1)
    character(len=:), allocatable :: why
    integer :: n, most, i
    logical :: is_right
    if (c%has_numbers(place)) call values%forbid(abs(joint%load_share - 1) > 0, group, 'load_share', &
      'must be 1 with further cylinders: the throws of the shaft give the load')
    if (joint%numbers == '') return
    call values%forbid(all(place /= [main_bearing, crank_pin]), group, 'numbers', &
      'is for place = ''main_bearing'' or ''crank_pin'' alone')
    if (all(place /= [main_bearing, crank_pin])) return
    call values%forbid(.not. joint%is_carried(), group, 'numbers', &
      'needs kind = ''quasi_static'': only the full cylinder has joints with clearance')
    call values%forbid(.not. allocated(c%cylinders), group, 'numbers', 'needs the groups cylinder: there is one cylinder alone')
    if (values%problems%concerns(group) .or. joint%numbers == 'all') return
    most = c%n_bearings(place)
    call read_numbers(joint%numbers, ',', found, n, is_right)
    if (is_right) is_right = all(found(:n) > 0.5_dp) .and. all(found(:n) < most + 0.5_dp)
    if (is_right) is_right = all([(joint%wants_number(nint(found(i))), i=1, n)])
    why = ': there are '//integer_text(most)//' cylinders'
    if (place == main_bearing) why = ': the shaft has '//integer_text(most - 1)//' throws'
    call values%forbid(.not. is_right, group, 'numbers', 'must be all or numbers from 1 to '//integer_text(most)//why)
    if (is_right) call values%forbid(any([(any(nint(found(:i - 1)) == nint(found(i))), i=1, n)]), group, 'numbers', &
      'must not have the same number twice')
  end subroutine check_numbers

  !> Check that a joint that is ideal by default has no values of a bearing.
  subroutine check_ideal(group, values)
    character(len=*), intent(in) :: group   !! of the joint
    type(case_values_t), intent(inout) :: values
    integer :: i
    if (values%is_given(group, 'kind')) return
    associate (range => values%groups(find_group(values%groups, group)))
      do i = range%first, range%last
        call values%forbid(values%is_said(i), group, trim(values%keys(i)%name), 'needs kind = ''clearance''; the default is ideal')
      end do
    end associate
  end subroutine check_ideal

  !> Whether the case has a law for the joint at this place alone.
  logical function has_own_law(place, values)
    integer, intent(in) :: place   !! index in `places`
    type(case_values_t), intent(in) :: values
    has_own_law = any(values%is_present .and. index(values%groups%name, trim(places(place)%name)//'.') == 1 .and. &
                      values%groups%name /= trim(places(place)%name)//'.joint')
  end function has_own_law

  !> Check that a film alone carries the load of a pin that is ideal in the mechanism.
  subroutine check_carried(c, joint, place, values)
    type(case_t), intent(in) :: c
    type(joint_case_t), intent(in) :: joint
    integer, intent(in) :: place   !! index in `places`
    type(case_values_t), intent(inout) :: values
    call values%forbid(.not. allocated(joint%film), joint_group(place), 'kind', &
      'quasi_static needs the group lubrication: a film carries the load')
    call values%forbid(allocated(joint%friction), values%law_group('friction', place), 'law', &
      'is not for kind = ''quasi_static'': no contact law acts there; give the group the place of another joint')
    if (.not. allocated(joint%film)) return
    call values%forbid(allocated(joint%contact) .and. .not. joint%elastic%is_wanted, values%law_group('contact', place), 'law', &
      'is not for kind = ''quasi_static'' unless elastic_film = .true.: the film carries all of the load')
    call values%forbid(.not. joint%film%is_quasi_static(), values%law_group('lubrication', place), 'law', &
      'must give a force that depends on the velocity of the pin alone, with kind = ''quasi_static'': finite_bearing, or '// &
      'closed_form and half_film of pinkus_sternlicht')
  end subroutine check_carried

  !> Check that asperities are combined with a film and not with a contact law.
  subroutine check_asperities(joint, group, values)
    type(joint_case_t), intent(in) :: joint
    character(len=*), intent(in) :: group   !! group of the asperities
    type(case_values_t), intent(inout) :: values
    real(dp), parameter :: roughest = 0.125_dp   !! largest roughness over clearance
    call values%forbid(.not. allocated(joint%film), group, 'roughness', &
      'needs the group lubrication: asperities touch through a film')
    call values%forbid(allocated(joint%contact), group, 'roughness', &
      'cannot be combined with the group contact: asperities are the contact of rough surfaces')
    call values%forbid(joint%asperities%roughness > roughest*joint%clearance, group, 'roughness', &
      'must be <= clearance/8 = '//short_text(roughest*joint%clearance)//': a centred pin may not touch')
  end subroutine check_asperities

  !> Check that wear has a rate, and a contact that wears.
  subroutine check_wear(c, joint, bearing_turns, group, wear_group, values)
    type(case_t), intent(in) :: c
    type(joint_case_t), intent(in) :: joint
    logical, intent(in) :: bearing_turns
    character(len=*), intent(in) :: group, wear_group   !! groups of the joint and of its wear
    type(case_values_t), intent(inout) :: values
    call values%forbid(.not. any(joint%wear%rate > 0), wear_group, 'rate', 'must be > 0 for the pin or the bore')
    call values%forbid(.not. (joint%can_touch() .or. allocated(joint%asperities)), wear_group, 'rate', &
      'needs surfaces that touch: the group contact without elastic_film, or asperities')
    call values%demand(joint%bearing_length > 0, group, 'bearing_length', 'with wear')
    call check_worn_bore(c, joint, wear_group, bearing_turns, values)
  end subroutine check_wear

  !> Check that a bore whose shape changes belongs to a dry joint on a foundation, in a piston that does not tilt.
  subroutine check_worn_bore(c, joint, group, turns, values)
    type(case_t), intent(in) :: c
    type(joint_case_t), intent(in) :: joint
    character(len=*), intent(in) :: group   !! group of the wear
    logical, intent(in) :: turns            !! the bore turns
    type(case_values_t), intent(inout) :: values
    integer, parameter :: least_bins = 36
    class(friction_law_t), allocatable :: friction
    if (joint%wear%bore == 'round') then
      call values%forbid(joint%wear%extrapolation > 1, group, 'extrapolation', 'is for bore = ''worn'' alone')
      call values%forbid(joint%wear%cycles_per_update > 1, group, 'cycles_per_update', 'is for bore = ''worn'' alone')
      return
    end if
    call values%forbid(allocated(joint%film), group, 'bore', 'must be round with lubrication: the films are those of round bores')
    if (allocated(joint%film) .or. .not. allocated(joint%contact)) return
    call values%forbid(.not. joint%contact%geometry%has_foundation(), group, 'bore', 'worn needs &contact geometry = ''winkler''')
    call values%forbid(turns, group, 'bore', 'worn is for the piston pin in a piston that does not tilt')
    call values%forbid(.not. joint%wear%rate(of_bore) > 0, group, 'rate', 'must be > 0 for the bore with bore = ''worn''')
    call values%forbid(joint%wear%bins < least_bins, group, 'bins', 'must be >= 36 with bore = ''worn''')
    call values%forbid(c%run%is_until_periodic() .or. c%run%lyapunov_revolutions > 0, group, 'bore', &
      'worn cannot be combined with &run until = ''periodic'' or lyapunov_revolutions: the bore changes')
    if (.not. allocated(joint%friction)) return
    allocate (friction, source=joint%friction)
    call friction%prepare()
    call values%forbid(friction%set_valued, group, 'bore', &
      'worn cannot be combined with a friction law in which the surfaces stick; ambrosio or lugre, for example, can')
  end subroutine check_worn_bore

  !> Check that the loss of a contact is given by one key, and that its geometry is possible in its bearing.
  subroutine check_contact(joint, group, contact_group, values)
    type(joint_case_t), intent(in) :: joint
    character(len=*), intent(in) :: group, contact_group   !! groups of the joint and of its contact
    type(case_values_t), intent(inout) :: values
    character(len=:), allocatable :: key, wanted
    if (values%is_said(values%place_of(contact_group, 'dissipation'))) &
      call values%check_family(contact_group, 'dissipation')
    associate (geometry => joint%contact%geometry)
      call values%demand(joint%bearing_length > 0 .or. .not. geometry%needs_length(), group, 'bearing_length', &
        'with contact geometry = '''//trim(geometry%name)//'''')
      if (geometry%needs_length() .and. .not. joint%bearing_length > 0) return
      call geometry%bearing_conflict(joint%bearing(rod_length=0.0_dp), key, wanted)
      call values%forbid(key /= '', group, key, wanted)
    end associate
  end subroutine check_contact

  !> Check that at the beginning of a contact friction does not exceed static friction at the sliding speeds of an ideal joint.
  !> These are at most the sum of the angular speeds of both bodies times the pin radius; that of the rod is at most the crank
  !> speed times the ratio of crank to rod length.
  subroutine check_friction(c, joint, place, values)
    type(case_t), intent(in) :: c
    type(joint_case_t), intent(in) :: joint
    integer, intent(in) :: place   !! index in `places`
    type(case_values_t), intent(inout) :: values
    real(dp) :: turning(body_frame:n_bodies), speed, limit
    if (.not. (joint%has_clearance() .and. allocated(joint%friction))) return
    associate (m => c%mechanism, bearing => joint%bearing(c%mechanism%rod_length))
      turning = 0
      turning(body_crank) = 1
      turning([body_big_end, body_small_end]) = m%crank_length/m%rod_length
      speed = turning(places(place)%pin_body) + turning(places(place)%bearing)
      speed = speed*abs(c%initial%crank_speed)*bearing%pin_radius()
    end associate
    limit = joint%friction%touch_down_limit()
    if (speed > limit) call values%refuse(values%law_group('friction', place), 'damping_speed', &
      'a constant bristle_damping gives more than the static friction at touch-down from '//short_text(limit)// &
      ' m/s on, and this joint slides with '//short_text(speed)//' m/s: must be > 0')
  end subroutine check_friction

  !> Check that a law for all joints acts in one of them, where joints have laws of their own. One that acts nowhere is taken out of
  !> the case: it gives way to those that an override has begun, with its values, or is wrong.
  subroutine check_shared_laws(c, values)
    type(case_t), intent(in) :: c
    type(case_values_t), intent(inout) :: values
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
        own = values%law_group(trim(name), i)
        acts = acts .or. own == name
        gives_way = gives_way .or. values%line(find_group(values%groups, own)) == behind_file
      end do
      if (acts) cycle
      if (.not. gives_way) call values%refuse_group(trim(name), &
        'acts nowhere, since every joint has a group of its own (place = ...): set that one')
      values%is_present(k) = .false.
    end do
  end subroutine check_shared_laws
end module joint_rules
