!> A joint with clearance: its geometry, its motion, its phase, and the list of elements that carry its load.
!>
!> Without contact between pin and bearing the joint is free, or a film carries the load; in contact the contact law acts (Reis
!> 2013, fig. 3.9). One element acts in each phase, and one may act in several; in free flight none does.
module clearance_joint
  use kinds, only: dp
  use bearing_size, only: bearing_t, crossing_speed
  use state_layout, only: layout_t, coordinates_t, slice_t
  use run_state, only: run_state_t
  use chain_motion, only: motion_t, accelerations_t, angular_acceleration, small_end, body_crank, body_big_end, body_small_end, &
    body_piston, body_pin, body_frame, n_bodies
  use joint_places, only: place_t, places, piston_pin, name_prefix, pin_title, n_spots
  use chain_bodies, only: bodies_t
  use ideal_chain, only: ideal_rod
  use chain_loads, only: loads_t, bearing_moment
  use archard_wear, only: wear_law_t
  use film_law, only: film_motion_t
  use joint_evaluation, only: joint_evaluation_t, joint_rates_t, most_element_states, find_polar, find_sliding
  use load_element, only: load_element_t, n_motions, n_slopes, n_kinds, of_contact, of_friction, &
    of_film
  use film_figures, only: film_figures_t, film_figures_of, film_losses_t, film_losses_of
  use film_heat, only: film_heat_t, coldest, hottest
  implicit none
  private
  public :: clearance_joint_t, most_joints, most_bearings, most_joint_states, n_joint_slopes
  public :: phase_free, phase_film, phase_contact, n_phases, contact_changes

  integer, parameter :: most_joints = 3     !! with clearance
  integer, parameter :: most_bearings = n_spots   !! with those whose pins are ideal in the mechanism
  integer, parameter :: most_elements = 2                                       !! of a joint
  integer, parameter :: most_joint_states = most_elements*most_element_states + 1   !! of all its elements, and a temperature
  integer, parameter :: n_joint_slopes = n_motions + most_joint_states          !! columns of its slopes

  !> States of the joint: the values of the column `phase`.
  integer, parameter :: phase_free = 0, phase_film = 1, phase_contact = 2
  integer, parameter :: n_phases = 3

  !> The first event of a joint with a contact law. The events of its elements follow, one element after the other.
  integer, parameter :: contact_changes = 1

  !> One place in the list of elements.
  type :: slot_t
    class(load_element_t), allocatable :: element
  end type slot_t

  type :: clearance_joint_t
    integer :: place = piston_pin           !! index in `places`
    type(place_t) :: site = places(piston_pin)   !! that place
    integer :: spot = piston_pin            !! the bearing there: see `joint_places`
    logical :: bearing_turns = .false.      !! false for a bearing in a piston that does not tilt
    type(bearing_t) :: bearing
    real(dp) :: pin_radius = 0              !! of the pin [m]
    type(wear_law_t), allocatable :: wear   !! wear of pin and bore is counted
    type(film_heat_t), allocatable :: heat  !! the film heats up
    ! the elements
    integer :: n_elements = 0
    type(slot_t) :: slots(most_elements)
    integer :: acting(0:n_phases - 1) = 0   !! number of the element that acts in each phase; 0: none
    integer :: n_states = 0                 !! number of their states, one element after the other, then the temperature
    integer :: n_events = 0                 !! number of event functions of the joint
    logical :: integrates_friction = .false.  !! the work of friction is integrated
    logical :: has_own_rates = .false.      !! elements have states, or the work of friction is integrated
    logical :: limits_states = .false.      !! there are states that must not reach a magnitude
    logical :: needs_ideal_motion(0:n_phases - 1) = .false.   !! in each phase: the film needs the motion of an ideal mechanism
    logical :: has_own_gap = .false.        !! the gap is not that of a round pin in a round bore
    logical :: has_slopes = .true.          !! the slopes of all elements are in closed form
    logical :: reports_film = .false.       !! report the results of the film in the summary
    ! state
    type(coordinates_t) :: at               !! indices of the eccentricity in the state; that of its rate is 0 if a film carries the
                                            !! pin (`carried_bearing`)
    integer :: phase = phase_free
    real(dp) :: impact_speed = 0            !! penetration rate at the beginning of the present contact [m/s]
    real(dp) :: reach(0:n_phases - 1) = 0   !! largest admissible eccentricity in each phase: see `find_reach` [m]
    real(dp) :: max_penetration = 0  !! largest penetration at the end of the step in which a contact begins, for contact entry by
                                     !! step rejection [m]
    real(dp) :: start_eccentricity(2) = 0   !! initial value [m]
    real(dp) :: start_rate(2) = 0           !! initial value [m/s]
  contains
    procedure :: set_place
    procedure :: let_pin_float
    procedure :: add
    procedure :: heat_up
    procedure :: claim
    procedure :: own_speed
    procedure :: set_start
    procedure :: declare
    procedure :: set_own_rates
    procedure :: set_heat_rates
    procedure, non_overridable :: read_place
    procedure, non_overridable :: read_temperature
    procedure, non_overridable :: admits_temperature
    procedure :: reset_states
    procedure :: work_of_friction
    procedure, non_overridable :: read_state
    procedure, non_overridable :: admits
    procedure, non_overridable :: loads
    procedure, non_overridable :: load_chain
    procedure, non_overridable :: find_speeds
    procedure :: relative_rates
    procedure, non_overridable :: complete
    procedure, non_overridable :: find_gap
    procedure, non_overridable :: find_contact_state
    procedure :: slopes
    procedure :: phase_apart
    procedure :: begin_contact
    procedure :: end_contact
    procedure :: begin_at
    procedure :: find_reach
    procedure :: is_singular
    procedure :: has_worn_bore
    procedure :: film_figures => figures_of_joint
    procedure :: thins
    procedure :: viscosity
    procedure :: powers
    procedure :: has_kind
    procedure :: shares_load
    procedure :: work_rates
    procedure :: rubs
    procedure :: sliding_load
    procedure :: holding_ratio
  end type clearance_joint_t

contains

  !> Set the joint to a place of the chain.
  subroutine set_place(self, place)
    class(clearance_joint_t), intent(inout) :: self
    integer, intent(in) :: place   !! index in `places`
    self%place = place
    self%site = places(place)
    self%spot = place
    self%bearing_turns = all(self%site%bearing /= [body_piston, body_frame])
  end subroutine set_place

  !> Let the pin of the joint, at the piston pin, be a floating one: its journal turns with the pin.
  subroutine let_pin_float(self)
    class(clearance_joint_t), intent(inout) :: self
    self%site%pin_body = body_pin
    if (self%site%bearing == body_small_end) self%site%pin = small_end
  end subroutine let_pin_float

  !> Add an element, which has been prepared and acts in the given phases.
  subroutine add(self, element, phases)
    class(clearance_joint_t), intent(inout) :: self
    class(load_element_t), allocatable, intent(inout) :: element   !! not allocated afterwards
    integer, intent(in) :: phases(:)
    self%n_elements = self%n_elements + 1
    self%acting(phases) = self%n_elements
    if (any(phases == phase_contact)) self%n_events = self%n_events + contact_changes
    element%events = slice_t(self%n_events + 1, self%n_events + element%n_events())
    self%n_events = element%events%last
    self%n_states = self%n_states + element%n_states
    self%integrates_friction = self%integrates_friction .or. element%integrates_friction
    self%has_own_rates = self%n_states > 0 .or. self%integrates_friction
    if (allocated(element%film)) self%needs_ideal_motion(phases) = element%film%needs_ideal_motion
    self%limits_states = self%limits_states .or. element%state_reach > 0
    self%has_own_gap = self%has_own_gap .or. element%has_own_gap
    self%has_slopes = self%has_slopes .and. element%has_slopes
    call move_alloc(element, self%slots(self%n_elements)%element)
    call self%find_reach()
  end subroutine add

  !> Let the film of the elements, which have been added, heat up.
  subroutine heat_up(self, heat)
    class(clearance_joint_t), intent(inout) :: self
    type(film_heat_t), intent(in) :: heat
    self%heat = heat
    self%n_states = self%n_states + 1
    self%has_own_rates = .true.
  end subroutine heat_up

  !> Claim the eccentricity, and what the elements need, in the state vector. The scale of the eccentricity is the clearance, that
  !> of its rate the clearance divided by the time in which the crank turns by one radian (errors: data/manual/choices.md).
  !>
  !> Where the crank hardly turns the pin has a speed scale of its own, `own_speed`. The scale of the rate is then a hundredth
  !> of the speed that crosses the clearance, since a pin that starts at rest is slow at first and may remain slow.
  subroutine claim(self, layout, crank_speed, span)
    class(clearance_joint_t), intent(inout) :: self
    type(layout_t), intent(inout) :: layout
    real(dp), intent(in) :: crank_speed   !! natural size of the crank speed [rad/s]
    real(dp), intent(in) :: span          !! duration of the simulation [s]
    type(slice_t) :: one
    integer :: k, i
    call layout%claim_positions(2, self%bearing%clearance, max(self%bearing%clearance*crank_speed, norm2(self%start_rate), &
      0.01_dp*crossing_speed(self%bearing%clearance, span)), self%at, grows=.false.)
    do k = 1, self%n_elements
      associate (element => self%slots(k)%element)
        do i = 1, element%n_states
          call layout%claim_states(1, element%state_scale(i), one)
          element%states = slice_t(one%last - i + 1, one%last)
        end do
        if (element%integrates_friction) call layout%claim_quadratures(1, 0.0_dp, element%friction_work)
      end associate
    end do
    if (allocated(self%heat)) call self%heat%claim(layout)
  end subroutine claim

  !> Natural size of the pin's speed in its bearing where it does not follow from the crank speed [m/s]: the initial speed, or
  !> the speed that crosses the clearance in the time simulated.
  pure real(dp) function own_speed(self, span)
    class(clearance_joint_t), intent(in) :: self
    real(dp), intent(in) :: span   !! [s]
    own_speed = max(norm2(self%start_rate), crossing_speed(self%bearing%clearance, span))
  end function own_speed

  !> Set the initial values of the joint's states in the state vector.
  pure subroutine set_start(self, y)
    class(clearance_joint_t), intent(in) :: self
    real(dp), intent(inout) :: y(:)
    integer :: k
    y(self%at%position:self%at%position + 1) = self%start_eccentricity
    y(self%at%rate:self%at%rate + 1) = self%start_rate
    do k = 1, self%n_elements
      associate (element => self%slots(k)%element)
        y(element%states%first:element%states%last) = element%start(:element%n_states)
      end associate
    end do
    if (allocated(self%heat)) y(self%heat%at%first) = self%heat%start
  end subroutine set_start

  !> Declare the joint's state, which is in part in the state vector. A position in a bearing of another clearance keeps its
  !> penetration in contact, else its ratio to the clearance.
  subroutine declare(self, list, y)
    class(clearance_joint_t), intent(inout) :: self
    type(run_state_t), intent(inout) :: list
    real(dp), intent(inout) :: y(:)
    character(len=:), allocatable :: pre, pin
    real(dp) :: clearance, distance, outward
    integer :: k
    pre = name_prefix(self%place)
    pin = pin_title(self%place)
    clearance = self%bearing%clearance
    associate (e => y(self%at%position:self%at%position + 1), rate => y(self%at%rate:self%at%rate + 1))
      call list%add(pre//'phase', self%phase, pin//': 0 free flight, 1 film, 2 contact')
      call list%add(pre//'clearance', clearance, 'm', 'clearance of this position')
      call list%add(pre//'eccentricity', e, 'm', 'centre of the '//pin//' from the centre of its bearing (x, y)')
      call list%add(pre//'eccentricity_rate', rate, 'm/s', 'its rate')
      call list%add(pre//'impact_speed', self%impact_speed, 'm/s', 'speed at which the present or last contact began')
      do k = 1, self%n_elements
        associate (element => self%slots(k)%element)
          if (element%n_states > 0) call list%add(pre//trim(element%state_name), &
            y(element%states%first:element%states%last), trim(element%state_unit), '')
          if (element%may_stick) call list%add(pre//'sliding', element%sliding, 'sense of sliding; 0 while the surfaces stick')
          list%of_totals = .true.
          if (element%integrates_friction) &
            call list%add(pre//'friction_work', y(element%friction_work%first), 'J', 'work of friction on the bodies')
          list%of_totals = .false.
        end associate
      end do
      if (allocated(self%heat)) call self%heat%declare(pre, list, y)
      if (.not. list%sets) return
      distance = norm2(e)
      if (self%phase == phase_contact .and. self%acting(phase_contact) > 0) then
        if (distance < clearance*(1 - 1e-6_dp)) call list%refuse(pre//'phase', 'is 2, but the '//pin//' is away from the wall')
        if (distance > 0) e = e*(1 + (self%bearing%clearance - clearance)/distance)
      else
        if (self%phase /= self%phase_apart()) call list%refuse(pre//'phase', 'the '//pin//' of the case does not have this phase')
        self%phase = self%phase_apart()
        if (abs(clearance - self%bearing%clearance) > 0) e = e*(self%bearing%clearance/clearance)
      end if
      outward = dot_product(e, rate)
      call self%begin_at(norm2(e), outward)
    end associate
  end subroutine declare

  !> Rates of the states of the elements, of the work of friction, and of the heat of the film. Those of an element are 0 while it
  !> does not act, that of the work without contact.
  pure subroutine set_own_rates(self, joint, y, dydt)
    class(clearance_joint_t), intent(in) :: self
    type(joint_evaluation_t), intent(in) :: joint
    real(dp), intent(in) :: y(*)   !! the whole state vector
    real(dp), intent(inout) :: dydt(*)
    integer :: k, i
    do k = 1, self%n_elements
      associate (element => self%slots(k)%element, acts => k == self%acting(self%phase))
        do i = 1, element%n_states
          dydt(element%states%first + i - 1) = 0
          if (acts) dydt(element%states%first + i - 1) = joint%rates(i)
        end do
        if (.not. element%integrates_friction) cycle
        dydt(element%friction_work%first) = 0
        if (joint%touches) dydt(element%friction_work%first) = joint%friction_force*joint%sliding_speed
      end associate
    end do
    if (allocated(self%heat)) call self%set_heat_rates(whole_of(self, joint, y), y, dydt)
  end subroutine set_own_rates

  !> Rates of the heat of the film, from the joint with all its loads, also those that the present phase does not have.
  pure subroutine set_heat_rates(self, whole, y, dydt)
    class(clearance_joint_t), intent(in) :: self
    type(joint_evaluation_t), intent(in) :: whole
    real(dp), intent(in) :: y(*)
    real(dp), intent(inout) :: dydt(*)
    type(film_losses_t) :: losses
    real(dp) :: friction
    call find_losses(self, whole, losses, friction)
    call self%heat%set_rates(losses%power + losses%neglected_power + friction, losses%side_flow, y, dydt)
  end subroutine set_heat_rates

  !> Losses of the film, and power of the friction where the surfaces touch [W].
  pure subroutine find_losses(self, whole, losses, friction)
    type(clearance_joint_t), intent(in) :: self
    type(joint_evaluation_t), intent(in) :: whole
    type(film_losses_t), intent(out) :: losses
    real(dp), intent(out) :: friction
    integer :: k
    friction = 0
    k = self%acting(self%phase)
    if (k == 0) return
    associate (element => self%slots(k)%element)
      if (allocated(element%film)) losses = film_losses_of(element, whole)
      if (element%rubs) friction = -whole%friction_force*whole%sliding_speed
    end associate
  end subroutine find_losses

  !> The joint as the right-hand side computes it, with what `complete` sets.
  pure type(joint_evaluation_t) function whole_of(self, joint, y) result(whole)
    type(clearance_joint_t), intent(in) :: self
    type(joint_evaluation_t), intent(in) :: joint
    real(dp), intent(in) :: y(*)
    whole = joint
    associate (element => self%slots(self%acting(self%phase))%element)
      whole%states(:element%n_states) = y(element%states%first:element%states%last)
    end associate
    call self%find_gap(y, whole)
    call find_sliding(self%pin_radius, whole)
  end function whole_of

  !> Set the states to 0 that are 0 at the beginning of each contact, those of friction laws.
  pure subroutine reset_states(self, y)
    class(clearance_joint_t), intent(in) :: self
    real(dp), intent(inout) :: y(:)
    integer :: k
    do k = 1, self%n_elements
      associate (element => self%slots(k)%element)
        if (element%starts_again) y(element%states%first:element%states%last) = 0
      end associate
    end do
  end subroutine reset_states

  !> Work of friction so far [J] if it is integrated, else 0. It is negative where friction takes energy from the bodies.
  pure real(dp) function work_of_friction(self, y) result(work)
    class(clearance_joint_t), intent(in) :: self
    real(dp), intent(in) :: y(:)
    integer :: k
    work = 0
    do k = 1, self%n_elements
      if (self%slots(k)%element%integrates_friction) work = work + y(self%slots(k)%element%friction_work%first)
    end do
  end function work_of_friction

  !> Read the state of the joint from the state vector, and set the discrete state of the contact.
  pure subroutine read_state(self, y, joint)
    class(clearance_joint_t), intent(in) :: self
    real(dp), intent(in) :: y(*)
    type(joint_evaluation_t), intent(inout) :: joint
    call self%read_place(y, joint)
    if (allocated(self%heat)) call self%read_temperature(y, joint)
  end subroutine read_state

  !> The same without the temperature of the film.
  pure subroutine read_place(self, y, joint)
    class(clearance_joint_t), intent(in) :: self
    real(dp), intent(in) :: y(*)
    type(joint_evaluation_t), intent(inout) :: joint
    joint%eccentricity(1) = y(self%at%position)
    joint%eccentricity(2) = y(self%at%position + 1)
    joint%eccentricity_rate(1) = y(self%at%rate)
    joint%eccentricity_rate(2) = y(self%at%rate + 1)
    joint%touches = self%phase == phase_contact
    joint%impact_speed = self%impact_speed
    joint%viscosity_ratio = 1
  end subroutine read_place

  !> Set the temperature of the film, which heats up, and its viscosity where that is admissible.
  pure subroutine read_temperature(self, y, joint)
    class(clearance_joint_t), intent(in) :: self
    real(dp), intent(in) :: y(*)
    type(joint_evaluation_t), intent(inout) :: joint
    joint%temperature = self%heat%temperature(y)
    if (self%admits_temperature(joint)) joint%viscosity_ratio = self%heat%viscosity_ratio(joint%temperature)
  end subroutine read_temperature

  !> Whether the temperature of the film is admissible.
  pure logical function admits_temperature(self, joint)
    class(clearance_joint_t), intent(in) :: self
    type(joint_evaluation_t), intent(in) :: joint
    admits_temperature = .true.
    if (allocated(self%heat)) admits_temperature = joint%temperature > coldest .and. joint%temperature < hottest
  end function admits_temperature

  !> Whether the state is admissible but for the temperature: the eccentricity within its reach, and the states of the elements
  !> within theirs.
  pure logical function admits(self, y, joint)
    class(clearance_joint_t), intent(in) :: self
    real(dp), intent(in) :: y(*)
    type(joint_evaluation_t), intent(in) :: joint
    admits = joint%eccentricity(1)**2 + joint%eccentricity(2)**2 < self%reach(self%phase)**2
    if (self%limits_states) admits = admits .and. admits_states(self, y)
  end function admits

  !> Whether the states of the elements are within their reach.
  pure logical function admits_states(self, y)
    type(clearance_joint_t), intent(in) :: self
    real(dp), intent(in) :: y(*)
    integer :: k
    admits_states = .true.
    do k = 1, self%n_elements
      associate (element => self%slots(k)%element)
        if (element%state_reach > 0) admits_states = admits_states .and. &
          sum(y(element%states%first:element%states%last)**2) < element%state_reach**2
      end associate
    end do
  end function admits_states

  !> Compute the loads of the element that acts and their power on the bodies, and add them to the loads of the chain. Components
  !> that the element does not have are not set.
  pure subroutine loads(self, bodies, motion, y, joint, all)
    class(clearance_joint_t), intent(in) :: self
    type(bodies_t), intent(in) :: bodies
    type(motion_t), intent(in) :: motion
    real(dp), intent(in) :: y(*)          !! the whole state vector, for the states of the elements
    type(joint_evaluation_t), intent(inout) :: joint
    type(loads_t), intent(inout) :: all
    integer :: k
    joint%sticks = .false.
    k = self%acting(self%phase)
    if (k > 0) then
      call self%find_speeds(motion, joint)
      if (self%needs_ideal_motion(self%phase)) call find_ideal_motion(self, bodies, motion, joint)
      call self%slots(k)%element%find_loads(y, joint)
      joint%power = (joint%force(1)*joint%eccentricity_rate(1) + joint%force(2)*joint%eccentricity_rate(2)) &
        + joint%moment*joint%pin_angular_speed
      if (self%bearing_turns) &
        joint%power = joint%power + bearing_moment(joint%eccentricity, joint%force, joint%moment)*joint%bearing_speed
    else
      joint%force = 0
      joint%moment = 0
      joint%power = 0
    end if
    call self%load_chain(joint, joint%force, joint%moment, all)
  end subroutine loads

  !> Set the loads of the chain's pin from a force [N] and a moment [N m] on the pin.
  pure subroutine load_chain(self, joint, force, moment, all)
    class(clearance_joint_t), intent(in) :: self
    type(joint_evaluation_t), intent(in) :: joint
    real(dp), intent(in) :: force(2), moment
    type(loads_t), intent(inout) :: all
    associate (pin => self%site%pin)
      if (self%site%sense > 0) then
        all%force(1, pin) = force(1)
        all%force(2, pin) = force(2)
        all%moment(pin) = moment
      else   ! the chain's force is that on the body of the bearing
        all%force(:, pin) = -force
        all%moment(pin) = bearing_moment(joint%eccentricity, force, moment)
      end if
    end associate
  end subroutine load_chain

  !> Set the angular speeds of pin and bearing.
  pure subroutine find_speeds(self, motion, joint)
    class(clearance_joint_t), intent(in) :: self
    type(motion_t), intent(in) :: motion
    type(joint_evaluation_t), intent(inout) :: joint
    joint%pin_angular_speed = motion%turning(self%site%pin_body)
    joint%bearing_speed = 0
    if (self%bearing_turns) joint%bearing_speed = motion%turning(self%site%bearing)
  end subroutine find_speeds

  !> Set the speeds of a mechanism with ideal joints at (q, q'), at constant crank speed.
  pure subroutine find_ideal_motion(self, bodies, motion, joint)
    type(clearance_joint_t), intent(in) :: self
    type(bodies_t), intent(in) :: bodies
    type(motion_t), intent(in) :: motion
    type(joint_evaluation_t), intent(inout) :: joint
    real(dp) :: rod_speed, rod_acceleration, turning(n_bodies)
    call ideal_rod(bodies, motion, rod_speed, rod_acceleration)
    turning(body_crank) = motion%crank_speed
    turning(body_big_end:body_small_end) = -rod_speed
    turning(body_piston) = 0
    joint%ideal_speed = turning(self%site%pin_body) + turning(self%site%bearing)
    joint%ideal_acceleration = -rod_acceleration
    joint%frequency = abs(motion%crank_speed)
  end subroutine find_ideal_motion

  !> Accelerations of pin and bearing relative to each other.
  pure type(joint_rates_t) function relative_rates(self, accelerations) result(rates)
    class(clearance_joint_t), intent(in) :: self
    type(accelerations_t), intent(in) :: accelerations
    rates%eccentricity = self%site%sense*accelerations%pin(:, self%site%pin)
    rates%pin = angular_acceleration(accelerations, self%site%pin_body)
    rates%bearing = 0
    if (self%bearing_turns) rates%bearing = angular_acceleration(accelerations, self%site%bearing)
  end function relative_rates

  !> Set what `loads` does not: the relative motion of pin and bearing in any phase, and the states of the element that acts. If
  !> the motion of the bodies is not known, angular speeds and sliding speed are not set.
  pure subroutine complete(self, motion, is_known, y, joint)
    class(clearance_joint_t), intent(in) :: self
    type(motion_t), intent(in) :: motion
    logical, intent(in) :: is_known
    real(dp), intent(in) :: y(*)
    type(joint_evaluation_t), intent(inout) :: joint
    integer :: k
    if (.not. (is_known .and. joint%touches)) call self%find_gap(y, joint)   ! else `loads` has
    k = self%acting(self%phase)
    if (k > 0 .and. self%n_states > 0) then
      associate (states => self%slots(k)%element%states)
        joint%states(:states%last - states%first + 1) = y(states%first:states%last)
      end associate
    end if
    if (.not. is_known) return
    call self%find_speeds(motion, joint)
    call find_sliding(self%pin_radius, joint)
  end subroutine complete

  !> Set the position of the pin in its bearing and the gap.
  pure subroutine find_gap(self, y, joint)
    class(clearance_joint_t), intent(in) :: self
    real(dp), intent(in) :: y(*)
    type(joint_evaluation_t), intent(inout) :: joint
    call find_polar(self%bearing%clearance, joint)
    if (self%has_own_gap) call find_own_gap(self, y, joint)
  end subroutine find_gap

  !> Set the gap of elements that have one of their own.
  pure subroutine find_own_gap(self, y, joint)
    type(clearance_joint_t), intent(in) :: self
    real(dp), intent(in) :: y(*)
    type(joint_evaluation_t), intent(inout) :: joint
    integer :: k
    do k = 1, self%n_elements
      call self%slots(k)%element%find_gap(y, joint)
    end do
  end subroutine find_own_gap

  !> The position and velocity of the pin in its bearing, without angular and sliding speeds, and the normal force of the
  !> contact: all that follows from the state without the motion of the bodies.
  pure subroutine find_contact_state(self, y, joint, normal_force)
    class(clearance_joint_t), intent(in) :: self
    real(dp), intent(in) :: y(*)
    type(joint_evaluation_t), intent(inout) :: joint
    real(dp), intent(out) :: normal_force
    normal_force = 0
    if (self%at%rate == 0) then
      joint%eccentricity = y(self%at%position:self%at%position + 1)
      joint%eccentricity_rate = 0
      call find_polar(self%bearing%clearance, joint)   ! the state is the position in the film also between elastic walls
      return
    end if
    call self%read_state(y, joint)
    call self%find_gap(y, joint)
    if (self%phase == phase_contact) normal_force = self%slots(self%acting(phase_contact))%element%normal_force(joint)
  end subroutine find_contact_state

  !> Derivatives of the force and the moment on the pin (rows F_x, F_y, moment) and of the rates of the joint's states, with
  !> respect to e_x, e_y, e_x', e_y', the angular speeds of pin and bearing, and the states (columns), for implicit integration.
  !> Not defined for surfaces that stick.
  pure subroutine slopes(self, joint, of_loads, of_rates)
    class(clearance_joint_t), intent(in) :: self
    type(joint_evaluation_t), intent(in) :: joint
    real(dp), intent(out) :: of_loads(3, n_joint_slopes), of_rates(most_joint_states, n_joint_slopes)
    real(dp) :: loads_slopes(3, n_slopes), rate_slopes(most_element_states, n_slopes)
    integer :: i, k, first, n
    of_loads = 0
    of_rates = 0
    k = self%acting(self%phase)
    if (k == 0) return
    call self%slots(k)%element%find_slopes(joint, loads_slopes, rate_slopes)
    n = self%slots(k)%element%n_states
    first = sum([(self%slots(i)%element%n_states, i=1, k - 1)])   ! number of states before those of this element
    of_loads(:, :n_motions) = loads_slopes(:, :n_motions)
    of_loads(:, n_motions + first + 1:n_motions + first + n) = loads_slopes(:, n_motions + 1:n_motions + n)
    of_rates(first + 1:first + n, :n_motions) = rate_slopes(:n, :n_motions)
    of_rates(first + 1:first + n, n_motions + first + 1:n_motions + first + n) = rate_slopes(:n, n_motions + 1:n_motions + n)
    if (allocated(self%heat)) call add_heat_slopes(self, joint, of_loads, of_rates)
  end subroutine slopes

  !> Add the derivatives of and with respect to the temperature of the film. Left out is how its side flow depends on the motion.
  pure subroutine add_heat_slopes(self, joint, of_loads, of_rates)
    type(clearance_joint_t), intent(in) :: self
    type(joint_evaluation_t), intent(in) :: joint
    real(dp), intent(inout) :: of_loads(3, n_joint_slopes), of_rates(most_joint_states, n_joint_slopes)
    type(film_losses_t) :: losses
    real(dp) :: friction, of_viscosity
    integer :: by, at, k
    at = self%n_states
    by = n_motions + at
    k = self%acting(self%phase)
    call find_losses(self, joint, losses, friction)
    call self%heat%slopes(joint%temperature, losses%power + losses%neglected_power, losses%side_flow, of_viscosity, &
      of_rates(at, by))
    associate (element => self%slots(k)%element, e => joint%eccentricity, rate => joint%eccentricity_rate)
      if (.not. allocated(element%film)) return
      of_loads(:, by) = [joint%film, element%film_moment(joint)]*of_viscosity
      if (allocated(element%walls)) then   ! the load is given: the velocity of the film changes, not its force
        of_loads(:2, by) = 0
        of_rates(:2, by) = of_viscosity*(0.5_dp*(joint%pin_angular_speed + joint%bearing_speed)* &
          [-joint%states(2), joint%states(1)] - joint%rates)
      end if
      ! of -(F . e' + M omega_pin + M_bearing omega_bearing), of all loads
      of_rates(at, :n_motions) = -matmul([rate + joint%bearing_speed*[e(2), -e(1)], &
        joint%pin_angular_speed - joint%bearing_speed], of_loads(:, :n_motions))
      of_rates(at, 1:2) = of_rates(at, 1:2) - joint%bearing_speed*[-joint%force(2), joint%force(1)]
      of_rates(at, 3:4) = of_rates(at, 3:4) - joint%force
      of_rates(at, 5:6) = of_rates(at, 5:6) - [joint%moment, bearing_moment(e, joint%force, joint%moment)]
      of_rates(at, :n_motions) = of_rates(at, :n_motions)/self%heat%given%heat_capacity
    end associate
  end subroutine add_heat_slopes

  !> The phase of the joint while there is no contact.
  pure integer function phase_apart(self)
    class(clearance_joint_t), intent(in) :: self
    phase_apart = merge(phase_film, phase_free, self%acting(phase_film) > 0)
  end function phase_apart

  !> Begin a contact with a penetration rate [m/s].
  pure subroutine begin_contact(self, rate)
    class(clearance_joint_t), intent(inout) :: self
    real(dp), intent(in) :: rate
    self%phase = phase_contact
    self%impact_speed = max(rate, 0.0_dp)
    self%slots(self%acting(phase_contact))%element%force_is_lost = .false.
  end subroutine begin_contact

  !> End a contact: the pin is free or carried by the film again, and its force is no longer lost.
  pure subroutine end_contact(self)
    class(clearance_joint_t), intent(inout) :: self
    self%phase = self%phase_apart()
    self%slots(self%acting(phase_contact))%element%force_is_lost = .false.
  end subroutine end_contact

  !> Tell the elements whether an eccentricity [m] is beyond their kinks; exactly at a kink its rate [m/s] decides.
  pure subroutine begin_at(self, distance, rate)
    class(clearance_joint_t), intent(inout) :: self
    real(dp), intent(in) :: distance, rate
    integer :: k
    do k = 1, self%n_elements
      associate (element => self%slots(k)%element)
        element%is_beyond = element%kinks > 0 .and. (distance > element%kinks .or. (distance >= element%kinks .and. rate >= 0))
      end associate
    end do
    call self%find_reach()
  end subroutine begin_at

  !> Set the largest admissible eccentricities: inside the wall of the bearing and, while a film acts whose force has no bound
  !> there, inside the clearance.
  pure subroutine find_reach(self)
    class(clearance_joint_t), intent(inout) :: self
    self%reach = self%bearing%radius
    if (self%acting(phase_film) == 0) return
    associate (element => self%slots(self%acting(phase_film))%element)   ! beyond its first kink a film is held
      if (element%is_unbounded .and. .not. element%is_beyond(1)) self%reach(phase_film) = self%bearing%clearance
    end associate
  end subroutine find_reach

  !> Whether the film force has no bound at the wall and the film thickness is almost 0.
  pure logical function is_singular(self, y)
    class(clearance_joint_t), intent(in) :: self
    real(dp), intent(in) :: y(:)
    real(dp), parameter :: thin = 1e-6_dp   !! film thickness over clearance
    is_singular = .false.
    if (self%reach(self%phase) < self%bearing%radius) &
      is_singular = norm2(y(self%at%position:self%at%position + 1)) > (1 - thin)*self%bearing%clearance
  end function is_singular

  !> Whether the worn shape of the bore acts in the contact.
  pure logical function has_worn_bore(self)
    class(clearance_joint_t), intent(in) :: self
    has_worn_bore = .false.
    if (allocated(self%wear)) has_worn_bore = self%wear%bore == 'worn'
  end function has_worn_bore

  !> Results of the film besides its force; all are 0 without a film, and while it does not act.
  pure type(film_figures_t) function figures_of_joint(self, joint) result(figures)
    class(clearance_joint_t), intent(in) :: self
    type(joint_evaluation_t), intent(in) :: joint
    if (self%acting(phase_film) > 0) figures = film_figures_of(self%slots(self%acting(phase_film))%element, joint)
  end function figures_of_joint

  !> Whether the film of the joint thins with the shear.
  pure logical function thins(self)
    class(clearance_joint_t), intent(in) :: self
    thins = .false.
    if (self%acting(phase_film) > 0) thins = self%slots(self%acting(phase_film))%element%film%thinning_ratio < 1
  end function thins

  !> Dynamic viscosity of the film [Pa s], without pressure.
  pure real(dp) function viscosity(self, joint)
    class(clearance_joint_t), intent(in) :: self
    type(joint_evaluation_t), intent(in) :: joint
    type(film_motion_t) :: seen
    real(dp) :: rate(2), share, thickening
    associate (element => self%slots(self%acting(phase_film))%element)
      call element%see_film(joint, seen, rate, share, thickening)
      viscosity = element%film%viscosity*joint%viscosity_ratio*element%film%thinning(seen)
    end associate
  end function viscosity

  !> Powers of the kinds of load on the bodies [W]; their sum is the power of the joint.
  pure function powers(self, joint)
    class(clearance_joint_t), intent(in) :: self
    type(joint_evaluation_t), intent(in) :: joint
    real(dp) :: powers(n_kinds)
    powers = 0
    if (self%acting(self%phase) > 0) powers = self%slots(self%acting(self%phase))%element%powers(joint)
  end function powers

  !> Whether the joint has this kind of load in any of its phases.
  pure logical function has_kind(self, kind)
    class(clearance_joint_t), intent(in) :: self
    integer, intent(in) :: kind
    integer :: k
    has_kind = .false.
    do k = 1, self%n_elements
      associate (element => self%slots(k)%element)
        select case (kind)
        case (of_film)
          has_kind = has_kind .or. allocated(element%film)
        case (of_contact)
          has_kind = has_kind .or. element%rubs .and. element%normal_kind == kind .or. allocated(element%walls)
        case (of_friction)
          has_kind = has_kind .or. element%rubs .and. element%friction_kind == kind .and. element%has_friction
        case default
          has_kind = has_kind .or. element%rubs .and. element%normal_kind == kind
        end select
      end associate
    end do
  end function has_kind

  !> Whether a film and another kind of load act at the same time.
  pure logical function shares_load(self)
    class(clearance_joint_t), intent(in) :: self
    integer :: k
    shares_load = .false.
    do k = 1, self%n_elements
      associate (element => self%slots(k)%element)
        shares_load = shares_load .or. allocated(element%film) .and. (element%rubs .or. allocated(element%walls))
      end associate
    end do
  end function shares_load

  !> The same as `powers`, from what the right-hand side computes: loads that the present phase does not have need not be set,
  !> unless the joint shares its load.
  pure function work_rates(self, joint, y) result(rates)
    class(clearance_joint_t), intent(in) :: self
    type(joint_evaluation_t), intent(in) :: joint
    real(dp), intent(in) :: y(*)   !! the whole state vector
    real(dp) :: rates(n_kinds)
    integer :: k
    rates = 0
    k = self%acting(self%phase)
    if (k == 0) return
    associate (element => self%slots(k)%element)
      if (.not. allocated(element%film)) then
        rates(of_contact) = -joint%normal_force*(joint%normal(1)*joint%eccentricity_rate(1) &
          + joint%normal(2)*joint%eccentricity_rate(2))
        if (element%has_friction) rates(of_friction) = joint%friction_force*joint%sliding_speed
      else if (element%rubs .or. allocated(element%walls)) then
        rates = element%powers(whole_of(self, joint, y))
      else
        rates(of_film) = joint%power
      end if
    end associate
  end function work_rates

  !> Whether surfaces may touch in the present phase.
  pure logical function rubs(self)
    class(clearance_joint_t), intent(in) :: self
    rubs = .false.
    if (self%acting(self%phase) > 0) rubs = self%slots(self%acting(self%phase))%element%rubs
  end function rubs

  !> Largest friction over normal force of surfaces in contact that stick [-].
  pure real(dp) function holding_ratio(self)
    class(clearance_joint_t), intent(in) :: self
    holding_ratio = self%slots(self%acting(phase_contact))%element%holding_ratio
  end function holding_ratio

  !> Int p R L dtheta |v|: the force that presses on the surfaces, summed without regard to its direction, times the sliding speed
  !> [W]. Times the wear rate of a surface it is the volume that wears in a second. On a wide arc it is larger than the normal force
  !> times the speed.
  pure real(dp) function sliding_load(self, joint)
    class(clearance_joint_t), intent(in) :: self
    type(joint_evaluation_t), intent(in) :: joint
    real(dp) :: ratio
    sliding_load = abs(joint%normal_force*joint%sliding_speed)
    if (.not. sliding_load > 0) return
    call self%slots(self%acting(self%phase))%element%spread(joint, ratio=ratio)
    sliding_load = sliding_load*ratio
  end function sliding_load
end module clearance_joint
