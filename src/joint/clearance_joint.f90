!> A joint with clearance: its laws, its discrete state, its loads and its events.
!>
!> Without contact between journal and bearing the joint is free, or a film carries the load; in contact the contact law acts (Reis
!> 2013, fig. 3.9). A law that the case does not name is not allocated.
module clearance_joint
  use gudgeon_kinds, only: dp
  use gudgeon_bearing, only: bearing_t, crossing_speed
  use state_layout, only: layout_t, coordinates_t, slice_t
  use chain_motion, only: motion_t, piston_pin
  use chain_bodies, only: bodies_t
  use ideal_chain, only: ideal_rod
  use chain_loads, only: loads_t, bearing_moment
  use contact_law, only: contact_law_t
  use friction_law, only: friction_law_t, most_friction_states
  use film_law, only: film_law_t, film_motion_t
  use film_transition, only: film_transition_t
  use asperities, only: asperities_t
  use archard_wear, only: wear_law_t
  use worn_bore, only: worn_bore_t
  use mixed_film, only: mixed_forces, mixed_derivatives
  use elastic_film, only: elastic_film_t, n_film_states
  use joint_motion, only: joint_motion_t, most_joint_states, find_polar, find_speeds, find_sliding
  implicit none
  private
  public :: clearance_joint_t, joint_loads_t, most_joints
  public :: phase_free, phase_film, phase_contact, n_phases

  integer, parameter :: most_joints = 2

  !> States of the joint: the values of the column `phase`.
  integer, parameter :: phase_free = 0, phase_film = 1, phase_contact = 2
  integer, parameter :: n_phases = 3

  !> Loads of a joint on its journal. The opposite forces act on the bearing.
  type :: joint_loads_t
    real(dp) :: contact(2)        !! force of contact and friction [N]
    real(dp) :: film(2)           !! force of the film [N]
    real(dp) :: moment            !! total moment about the journal's centre, positive from x to y [N m]
    real(dp) :: normal_force      !! normal force of the contact, positive in compression [N]
    real(dp) :: friction_force    !! friction force along the tangent t [N]
    real(dp) :: power             !! power of all these loads on the bodies [W]
    real(dp) :: friction_rates(most_friction_states)   !! rates of the states of the friction law
    logical :: sticks             !! set-valued friction holds the surfaces together: its force follows from the accelerations
  end type joint_loads_t

  type :: clearance_joint_t
    integer :: place = piston_pin           !! place of the pin in the chain
    logical :: bearing_turns = .false.  !! the bearing rotates: true for the crank pin, and for the piston pin if the piston has
                                        !! clearance in its bore
    type(bearing_t) :: bearing
    real(dp) :: pin_radius = 0              !! of the journal [m]
    class(contact_law_t), allocatable :: contact
    class(friction_law_t), allocatable :: friction
    class(film_law_t), allocatable :: film
    type(asperities_t), allocatable :: asperities   !! contact of rough surfaces in parallel with the film; without contact law
    type(film_transition_t), allocatable :: transition   !! film and contact share the load near the wall
    type(elastic_film_t), allocatable :: elastic    !! film between elastic walls; without contact law
    type(wear_law_t), allocatable :: wear            !! wear of pin and bore is counted
    type(worn_bore_t), allocatable :: worn           !! the worn shape of the bore acts in the contact
    type(slice_t) :: film_states            !! indices of the film's own eccentricity in the state
    type(coordinates_t) :: at               !! indices of the eccentricity in the state
    integer :: n_friction_states = 0        !! number of states of the friction law
    type(slice_t) :: friction_states        !! their indices in the state
    logical :: reports_friction_work = .false.   !! integrate the work of friction even if the friction law has no states
    logical :: reports_film = .false.       !! report the results of the film in the summary
    type(slice_t) :: friction_work          !! index of the work of friction in the state, if it is integrated [J]
    logical :: has_own_rates = .false.      !! the joint has states other than the eccentricity
    integer :: phase = phase_free
    integer :: sliding = 0                  !! set-valued friction: sign of the sliding speed, 0 while the surfaces stick
    real(dp) :: impact_speed = 0            !! penetration rate at the beginning of the present contact [m/s]
    logical :: force_is_lost = .false.      !! in contact, but the damper cancels the elastic force: none acts
    real(dp) :: max_penetration = 0  !! largest penetration at the end of the step in which a contact begins, for contact entry by
                                     !! step rejection [m]
    real(dp) :: start_eccentricity(2) = 0   !! initial value [m]
    real(dp) :: start_rate(2) = 0           !! initial value [m/s]
    real(dp) :: start_deflection(2) = 0     !! initial deflection of the walls of an elastic film [m]
  contains
    procedure :: claim
    procedure :: own_speed
    procedure :: put_start
    procedure :: put_own_rates
    procedure :: reset_friction
    procedure :: has_friction_work
    procedure :: work_of_friction
    procedure, non_overridable :: read_state
    procedure, non_overridable :: admits
    procedure, non_overridable :: loads
    procedure, non_overridable, private :: film_motion
    procedure, non_overridable, private :: elastic_film_motion
    procedure :: contact_weight
    procedure :: n_states
    procedure :: complete
    procedure :: look
    procedure :: static_speed
    procedure :: slopes
    procedure :: reach
    procedure :: state_slopes
    procedure :: is_singular
    procedure :: phase_apart
  end type clearance_joint_t

  interface
    !> Derivatives of the force and the moment on the journal (rows F_x, F_y, moment) with respect to e_x, e_y, e_x', e_y' and the
    !> angular speed of the journal (columns), for implicit integration. Not defined for surfaces that stick.
    pure module subroutine slopes(self, bodies, motion, joint, own, derivatives)
      class(clearance_joint_t), intent(in) :: self
      type(bodies_t), intent(in) :: bodies
      type(motion_t), intent(in) :: motion
      type(joint_motion_t), intent(in) :: joint
      type(joint_loads_t), intent(in) :: own
      real(dp), intent(out) :: derivatives(3, 5)
    end subroutine slopes

    !> Additions to `slopes` for the states of the friction law or of an elastic film: derivatives of the force and the moment on
    !> the journal (rows F_x, F_y, moment) with respect to these states, and of the rates of the states with respect to e_x, e_y,
    !> e_x', e_y', the angular speed of the journal and the states (columns).
    pure module subroutine state_slopes(self, bodies, motion, joint, own, by_states, of_rates)
      class(clearance_joint_t), intent(in) :: self
      type(bodies_t), intent(in) :: bodies
      type(motion_t), intent(in) :: motion
      type(joint_motion_t), intent(in) :: joint
      type(joint_loads_t), intent(in) :: own
      real(dp), intent(out) :: by_states(3, most_joint_states), of_rates(most_joint_states, 5 + most_joint_states)
    end subroutine state_slopes
  end interface

contains

  !> Claim the eccentricity, the states of the friction law and its work in the state vector. The scale of the eccentricity is the
  !> clearance, that of its rate the clearance divided by the time in which the crank turns by one radian. Measured
  !> (scripts/compare_adams.sh, simulation IV, c = 20 um): the error of the eccentricity at the end is 4e-5 c at the relative
  !> tolerance 1e-4, 4e-9 c at 1e-6, and 1e-14 c at 1e-12; in the coordinates (q, A, x) rounding alone causes 4e-12 c.
  !>
  !> Where the crank hardly turns the journal has a speed scale of its own, `own_speed`. The scale of the rate is then a hundredth
  !> of the speed that crosses the clearance, since a journal that starts at rest is slow at first and may remain slow.
  subroutine claim(self, layout, crank_speed, span)
    class(clearance_joint_t), intent(inout) :: self
    type(layout_t), intent(inout) :: layout
    real(dp), intent(in) :: crank_speed   !! natural size of the crank speed [rad/s]
    real(dp), intent(in) :: span          !! duration of the simulation [s]
    if (self%place /= piston_pin) self%bearing_turns = .true.
    call layout%claim_positions(2, self%bearing%clearance, max(self%bearing%clearance*crank_speed, norm2(self%start_rate), &
      0.01_dp*crossing_speed(self%bearing%clearance, span)), self%at, grows=.false.)
    if (allocated(self%elastic)) then
      call layout%claim_states(n_film_states, self%bearing%clearance, self%film_states)
      self%has_own_rates = .true.
    end if
    if (.not. allocated(self%friction)) return
    self%n_friction_states = self%friction%n_states
    self%has_own_rates = self%n_friction_states > 0 .or. self%reports_friction_work
    if (self%n_friction_states > 0) &
      call layout%claim_states(self%n_friction_states, self%friction%state_scale, self%friction_states)
    if (self%has_own_rates) call layout%claim_quadratures(1, 0.0_dp, self%friction_work)
  end subroutine claim

  !> Natural size of the journal's speed in its bearing where it does not follow from the crank speed [m/s]: the initial speed, or
  !> the speed that crosses the clearance in the time simulated.
  pure real(dp) function own_speed(self, span)
    class(clearance_joint_t), intent(in) :: self
    real(dp), intent(in) :: span   !! [s]
    own_speed = max(norm2(self%start_rate), crossing_speed(self%bearing%clearance, span))
  end function own_speed

  !> Number of first-order states of the laws.
  pure integer function n_states(self)
    class(clearance_joint_t), intent(in) :: self
    n_states = self%n_friction_states
    if (allocated(self%elastic)) n_states = n_film_states
  end function n_states

  !> Put the initial values of the joint's states into the state vector.
  pure subroutine put_start(self, y)
    class(clearance_joint_t), intent(in) :: self
    real(dp), intent(inout) :: y(:)
    y(self%at%position:self%at%position + 1) = self%start_eccentricity
    y(self%at%rate:self%at%rate + 1) = self%start_rate
    if (allocated(self%elastic)) y(self%film_states%first:self%film_states%last) = &
      self%start_eccentricity - self%start_deflection
  end subroutine put_start

  !> Rates of the states of an elastic film, of the states of the friction law and of the work of friction. The last two are 0
  !> without contact.
  pure subroutine put_own_rates(self, motion, own, dydt)
    class(clearance_joint_t), intent(in) :: self
    type(joint_motion_t), intent(in) :: motion
    type(joint_loads_t), intent(in) :: own
    real(dp), intent(inout) :: dydt(*)
    integer :: i
    if (allocated(self%elastic)) then
      dydt(self%film_states%first) = motion%film_rate(1)
      dydt(self%film_states%last) = motion%film_rate(2)
      return
    end if
    do i = 1, self%n_friction_states
      dydt(self%friction_states%first + i - 1) = 0
      if (self%phase == phase_contact) dydt(self%friction_states%first + i - 1) = own%friction_rates(i)
    end do
    dydt(self%friction_work%first) = 0
    if (self%phase == phase_contact) dydt(self%friction_work%first) = own%friction_force*motion%sliding_speed
  end subroutine put_own_rates

  !> Set the states of the friction law to 0, at the beginning or end of a contact.
  pure subroutine reset_friction(self, y)
    class(clearance_joint_t), intent(in) :: self
    real(dp), intent(inout) :: y(:)
    if (self%n_friction_states > 0) y(self%friction_states%first:self%friction_states%last) = 0
  end subroutine reset_friction

  !> Whether the work of friction is integrated.
  pure logical function has_friction_work(self)
    class(clearance_joint_t), intent(in) :: self
    has_friction_work = self%has_own_rates .and. allocated(self%friction)
  end function has_friction_work

  !> Work of friction so far [J] if it is integrated, else 0. It is negative where friction takes energy from the bodies.
  pure real(dp) function work_of_friction(self, y)
    class(clearance_joint_t), intent(in) :: self
    real(dp), intent(in) :: y(:)
    work_of_friction = 0
    if (self%has_friction_work()) work_of_friction = y(self%friction_work%first)
  end function work_of_friction

  !> Read the eccentricity and its rate from the state vector.
  pure subroutine read_state(self, y, joint)
    class(clearance_joint_t), intent(in) :: self
    real(dp), intent(in) :: y(*)
    type(joint_motion_t), intent(inout) :: joint
    joint%eccentricity(1) = y(self%at%position)
    joint%eccentricity(2) = y(self%at%position + 1)
    joint%eccentricity_rate(1) = y(self%at%rate)
    joint%eccentricity_rate(2) = y(self%at%rate + 1)
    if (allocated(self%elastic)) then
      joint%film_eccentricity(1) = y(self%film_states%first)
      joint%film_eccentricity(2) = y(self%film_states%last)
    end if
  end subroutine read_state

  !> Whether the eccentricity is admissible: inside the wall of the bearing and, where the film force is singular at the wall,
  !> inside the clearance.
  pure logical function admits(self, joint)
    class(clearance_joint_t), intent(in) :: self
    type(joint_motion_t), intent(in) :: joint
    real(dp) :: distance_squared
    distance_squared = joint%eccentricity(1)**2 + joint%eccentricity(2)**2
    admits = distance_squared < self%bearing%radius**2
    if (self%phase == phase_film) &
      admits = admits .and. (distance_squared < self%bearing%clearance**2 .or. .not. is_unbounded(self))
    if (allocated(self%elastic)) admits = admits .and. sum(joint%film_eccentricity**2) < self%bearing%clearance**2
  end function admits

  !> Whether the film of the present phase has a force without bound at the wall.
  pure logical function is_unbounded(joint)
    type(clearance_joint_t), intent(in) :: joint
    is_unbounded = .false.
    if (joint%phase /= phase_film .or. allocated(joint%asperities) .or. allocated(joint%elastic)) return
    is_unbounded = joint%film%singular_at_wall
    if (allocated(joint%transition)) is_unbounded = is_unbounded .and. .not. joint%transition%film_is_held
  end function is_unbounded

  !> Compute the loads of the present phase and their power on the bodies, and add them to the loads of the chain. Components that
  !> the present phase does not need are not set.
  pure subroutine loads(self, bodies, motion, y, joint, own, all)
    class(clearance_joint_t), intent(in) :: self
    type(bodies_t), intent(in) :: bodies
    type(motion_t), intent(in) :: motion
    real(dp), intent(in) :: y(*)          !! the whole state vector, for the states of the laws
    type(joint_motion_t), intent(inout) :: joint
    type(joint_loads_t), intent(inout) :: own
    type(loads_t), intent(inout) :: all
    real(dp) :: force(2)

    own%sticks = .false.
    own%moment = 0
    own%power = 0
    force = 0
    if (self%phase /= phase_free) then
      call find_speeds(self%place, self%bearing_turns, motion, joint)
      if (self%phase == phase_contact) then
        call find_contact(self, y, joint, own)
        force = own%contact
        if (allocated(self%transition)) then
          call share_with_film(self, self%film_motion(bodies, motion, joint), joint, own)
          force = own%film + own%contact
        end if
      else if (allocated(self%asperities)) then
        call find_mixed(self, self%film_motion(bodies, motion, joint), joint, own)
        force = own%film + own%contact
      else if (allocated(self%elastic)) then
        call find_elastic(self, bodies, motion, joint, own)
        force = own%film
      else
        if (allocated(self%transition)) then
          call self%film%film_force(self%transition%held_motion(self%film_motion(bodies, motion, joint)), own%film, own%moment)
        else
          call self%film%film_force(self%film_motion(bodies, motion, joint), own%film, own%moment)
        end if
        force = own%film
      end if
      own%power = (force(1)*joint%eccentricity_rate(1) + force(2)*joint%eccentricity_rate(2)) + own%moment*joint%journal_speed
      if (self%bearing_turns) &
        own%power = own%power + bearing_moment(joint%eccentricity, force, own%moment)*joint%bearing_speed
    end if
    all%force(1, self%place) = force(1)
    all%force(2, self%place) = force(2)
    all%moment(self%place) = own%moment
  end subroutine loads

  !> Contact and friction: the force -F_N n + F_T t on the journal and the moment F_T R. If the surfaces stick, friction is not set
  !> here; it follows from the accelerations.
  pure subroutine find_contact(self, y, joint, own)
    type(clearance_joint_t), intent(in) :: self
    real(dp), intent(in) :: y(*)
    type(joint_motion_t), intent(inout) :: joint
    type(joint_loads_t), intent(inout) :: own
    call find_polar(self%bearing%clearance, joint)
    if (allocated(self%worn)) then
      call find_worn(self, joint, own%normal_force)
    else
      own%normal_force = self%contact%normal_force(joint%penetration, joint%penetration_rate, self%impact_speed)
    end if
    if (self%force_is_lost) own%normal_force = 0
    own%friction_force = 0
    if (allocated(self%friction)) then
      call find_sliding(self%pin_radius, joint)
      if (self%n_friction_states > 0) then
        call find_state_friction(self, y, joint, own)
      else
        own%sticks = self%friction%set_valued .and. self%sliding == 0
        if (.not. own%sticks) own%friction_force = own%normal_force*self%friction%friction_ratio(joint%sliding_speed, self%sliding)
      end if
    end if
    associate (n => joint%normal, pressing => own%normal_force, friction => own%friction_force)
      own%contact(1) = -pressing*n(1) - friction*n(2)
      own%contact(2) = friction*n(1) - pressing*n(2)
      own%moment = friction*self%pin_radius
    end associate
  end subroutine find_contact

  !> A journal in a worn bore: its penetration, the normal force, and the direction in which it presses, if it does.
  pure subroutine find_worn(self, joint, normal_force)
    class(clearance_joint_t), intent(in) :: self
    type(joint_motion_t), intent(inout) :: joint
    real(dp), intent(out) :: normal_force
    real(dp) :: gradient(2), elastic(2), pressing, unused
    normal_force = 0
    call self%worn%find_gap(joint%eccentricity, joint%penetration, gradient)
    joint%penetration_rate = dot_product(gradient, joint%eccentricity_rate)
    if (self%phase /= phase_contact) return
    call self%worn%press(joint%eccentricity, elastic, unused)
    pressing = norm2(elastic)
    if (.not. pressing > 0) return
    joint%normal = elastic/pressing
    associate (n => joint%normal, rate => joint%eccentricity_rate)
      joint%tangential_rate = n(1)*rate(2) - n(2)*rate(1)
      if (.not. self%force_is_lost) &
        normal_force = self%contact%damped_by(pressing, joint%penetration, dot_product(n, rate), self%impact_speed)
    end associate
  end subroutine find_worn

  !> Weight the contact force, computed as if there were no film, and the film force with their shares of the load.
  pure subroutine share_with_film(self, motion, joint, own)
    type(clearance_joint_t), intent(in) :: self
    type(film_motion_t), intent(in) :: motion
    type(joint_motion_t), intent(in) :: joint
    type(joint_loads_t), intent(inout) :: own
    real(dp) :: w, force(2), moment
    own%film = 0
    if (self%transition%film_is_gone) return
    call self%transition%weight(joint%penetration, w)
    call self%film%film_force(self%transition%held_motion(motion), force, moment)
    own%film = (1 - w)*force
    own%contact = w*own%contact
    own%moment = w*own%moment + (1 - w)*moment
    own%normal_force = w*own%normal_force
    own%friction_force = w*own%friction_force
  end subroutine share_with_film

  !> Share of the contact in the load of a joint with a weighted transition, at a penetration [m]; 0 without contact.
  pure real(dp) function contact_weight(self, penetration) result(w)
    class(clearance_joint_t), intent(in) :: self
    real(dp), intent(in) :: penetration
    w = 0
    if (self%phase == phase_contact) call self%transition%weight(penetration, w)
  end function contact_weight

  !> Loads of a film between rough surfaces and of the contact of their asperities.
  pure subroutine find_mixed(self, motion, joint, own)
    type(clearance_joint_t), intent(in) :: self
    type(film_motion_t), intent(in) :: motion
    type(joint_motion_t), intent(inout) :: joint
    type(joint_loads_t), intent(inout) :: own
    call mixed_forces(self%film, self%asperities, self%pin_radius, motion, own%film, own%moment, own%normal_force, &
      own%friction_force)
    call find_polar(self%bearing%clearance, joint)
    associate (n => joint%normal)
      own%contact = -own%normal_force*n + own%friction_force*[-n(2), n(1)]
    end associate
    own%moment = own%moment + own%friction_force*self%pin_radius
  end subroutine find_mixed

  !> Loads of a film between elastic walls: the force of the walls, and the rate of the film's own eccentricity under this load.
  pure subroutine find_elastic(self, bodies, motion, joint, own)
    type(clearance_joint_t), intent(in) :: self
    type(bodies_t), intent(in) :: bodies
    type(motion_t), intent(in) :: motion
    type(joint_motion_t), intent(inout) :: joint
    type(joint_loads_t), intent(inout) :: own
    associate (e => joint%film_eccentricity, drawn => 0.5_dp*(joint%journal_speed + joint%bearing_speed))
      own%film = -self%elastic%load(joint%eccentricity - e)
      joint%film_rate = self%elastic%velocity(self%film, e, -own%film) + drawn*[-e(2), e(1)]
    end associate
    if (self%film%film_moment) &
      own%moment = self%elastic%moment(self%film, self%elastic_film_motion(bodies, motion, joint), -own%film)
  end subroutine find_elastic

  !> The thickness of an elastic film, which does not follow from the eccentricity of its pin, expressed as a penetration. Its rate
  !> does not include the rotation of the film.
  pure subroutine find_elastic_thickness(self, joint)
    type(clearance_joint_t), intent(in) :: self
    type(joint_motion_t), intent(inout) :: joint
    real(dp) :: distance
    associate (e => joint%film_eccentricity)
      distance = norm2(e)
      joint%penetration = distance - self%bearing%clearance
      joint%penetration_rate = 0
      if (distance > 0 .and. distance < self%bearing%clearance) joint%penetration_rate = dot_product(e, &
        self%elastic%velocity(self%film, e, self%elastic%load(joint%eccentricity - e)))/distance
    end associate
  end subroutine find_elastic_thickness

  !> The motion on which the force of a film between elastic walls depends: that of the place where the film is.
  pure type(film_motion_t) function elastic_film_motion(self, bodies, motion, joint) result(film)
    class(clearance_joint_t), intent(in) :: self
    type(bodies_t), intent(in) :: bodies
    type(motion_t), intent(in) :: motion
    type(joint_motion_t), intent(in) :: joint
    film = self%film_motion(bodies, motion, joint)
    film%eccentricity = joint%film_eccentricity
    film%eccentricity_rate = joint%film_rate
  end function elastic_film_motion

  !> Friction by a law with states.
  pure subroutine find_state_friction(self, y, joint, own)
    type(clearance_joint_t), intent(in) :: self
    real(dp), intent(in) :: y(*)
    type(joint_motion_t), intent(inout) :: joint
    type(joint_loads_t), intent(inout) :: own
    real(dp) :: ratio
    integer :: i
    do i = 1, self%n_friction_states
      joint%friction_states(i) = y(self%friction_states%first + i - 1)
    end do
    call self%friction%state_friction(joint%sliding_speed, joint%friction_states, ratio, own%friction_rates)
    own%friction_force = own%normal_force*ratio
  end subroutine find_state_friction

  !> Set what `loads` does not: the relative motion of journal and bearing in any phase, and zeros for loads that the phase does not
  !> have. If the motion of the bodies is not known, angular speeds and sliding speed are not set.
  pure subroutine complete(self, motion, is_known, joint, own)
    class(clearance_joint_t), intent(in) :: self
    type(motion_t), intent(in) :: motion
    logical, intent(in) :: is_known
    type(joint_motion_t), intent(inout) :: joint
    type(joint_loads_t), intent(inout) :: own
    real(dp) :: normal_force
    if (self%phase == phase_free .or. (self%phase == phase_contact .and. .not. allocated(self%transition))) own%film = 0
    if (self%phase /= phase_contact .and. .not. allocated(self%asperities)) then
      own%contact = 0
      own%normal_force = 0
      own%friction_force = 0
      joint%friction_states = 0
    end if
    if (.not. (is_known .and. self%phase == phase_contact)) then   ! else `loads` has set these
      call find_polar(self%bearing%clearance, joint)
      if (allocated(self%worn)) call find_worn(self, joint, normal_force)
    end if
    if (allocated(self%elastic)) call find_elastic_thickness(self, joint)
    if (.not. is_known) return
    call find_speeds(self%place, self%bearing_turns, motion, joint)
    call find_sliding(self%pin_radius, joint)
  end subroutine complete

  !> The position and velocity of the journal in its bearing, without angular and sliding speeds, and the normal force: all that
  !> follows from the state without the motion of the bodies.
  pure subroutine look(self, y, joint, normal_force)
    class(clearance_joint_t), intent(in) :: self
    real(dp), intent(in) :: y(:)
    type(joint_motion_t), intent(inout) :: joint
    real(dp), intent(out) :: normal_force
    call self%read_state(y, joint)
    call find_polar(self%bearing%clearance, joint)
    if (allocated(self%elastic)) call find_elastic_thickness(self, joint)
    normal_force = 0
    if (allocated(self%worn)) call find_worn(self, joint, normal_force)
    if (self%phase /= phase_contact .or. allocated(self%worn)) return
    if (.not. self%force_is_lost) &
      normal_force = self%contact%normal_force(joint%penetration, joint%penetration_rate, self%impact_speed)
    if (allocated(self%transition)) normal_force = normal_force*self%contact_weight(joint%penetration)
  end subroutine look

  !> See `static_speed` of friction_law_t; 0 without friction or without contact.
  elemental real(dp) function static_speed(self)
    class(clearance_joint_t), intent(in) :: self
    static_speed = 0
    if (allocated(self%friction) .and. self%phase == phase_contact) static_speed = self%friction%static_speed()
  end function static_speed

  !> The motion on which the film force depends. If both bodies rotate, the film is entrained with the sum of their angular speeds.
  pure function film_motion(self, bodies, motion, joint) result(film)
    class(clearance_joint_t), intent(in) :: self
    type(bodies_t), intent(in) :: bodies
    type(motion_t), intent(in) :: motion
    type(joint_motion_t), intent(in) :: joint
    type(film_motion_t) :: film
    real(dp) :: rod_speed, rod_acceleration
    film%eccentricity = joint%eccentricity
    film%eccentricity_rate = joint%eccentricity_rate
    film%pin_speed = joint%journal_speed + joint%bearing_speed
    film%turning_speed = joint%journal_speed - joint%bearing_speed
    if (self%film%needs_ideal_motion) then
      call ideal_rod(bodies, motion, rod_speed, rod_acceleration)
      film%ideal_pin_speed = -rod_speed
      film%ideal_pin_acceleration = -rod_acceleration
      film%frequency = abs(motion%crank_speed)
      if (self%place /= piston_pin) film%ideal_pin_speed = motion%crank_speed - rod_speed
    end if
  end function film_motion

  !> The phase of the joint while there is no contact.
  pure integer function phase_apart(self)
    class(clearance_joint_t), intent(in) :: self
    phase_apart = merge(phase_film, phase_free, allocated(self%film))
  end function phase_apart

  !> Largest admissible eccentricity in the present phase [m].
  pure real(dp) function reach(self)
    class(clearance_joint_t), intent(in) :: self
    reach = self%bearing%radius
    if (is_unbounded(self)) reach = min(reach, self%bearing%clearance)
  end function reach

  !> Whether the film force has no bound at the wall and the film thickness is almost 0.
  pure logical function is_singular(self, y)
    class(clearance_joint_t), intent(in) :: self
    real(dp), intent(in) :: y(:)
    real(dp), parameter :: thin = 1e-6_dp   !! film thickness over clearance
    is_singular = .false.
    if (is_unbounded(self)) is_singular = norm2(y(self%at%position:self%at%position + 1)) > (1 - thin)*self%bearing%clearance
  end function is_singular
end module clearance_joint
