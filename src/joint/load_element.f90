!> What carries the load of a joint with clearance: the abstract load element.
!>
!> A joint has a list of elements; in each of its phases one of them acts on the pin. An element declares its states and its events
!> as components, and finds its loads, their slopes and its columns. What a kind of element does not override is that of an element
!> without film or wear, with a round pin in a round bore. A new kind is one file, and one line in `load_elements`.
module load_element
  use kinds, only: dp
  use bearing_size, only: bearing_t
  use state_layout, only: slice_t
  use trace_row, only: trace_row_t
  use chain_loads, only: bearing_moment
  use contact_geometry, only: contact_geometry_t
  use film_law, only: film_law_t, film_motion_t
  use contact_arc, only: contact_arc_t
  use joint_case, only: joint_case_t
  use joint_evaluation, only: joint_evaluation_t, joint_rates_t, most_element_states
  implicit none
  private
  public :: load_element_t, power_of, sliding_changes, first_kink, force_changes
  public :: of_contact, of_friction, of_film, of_asperities, n_kinds
  public :: by_pin_speed, by_bearing_speed, n_motions, n_slopes

  !> Kinds of load whose powers are told apart: normal force of a contact or of elastic walls, friction of a contact, film, and
  !> asperities with their friction.
  integer, parameter :: of_contact = 1, of_friction = 2, of_film = 3, of_asperities = 4, n_kinds = 4

  !> Columns of slopes: derivatives with respect to e_x, e_y, their rates, the angular speeds of pin and bearing, and the states
  !> of the element, which begin after these `n_motions`.
  integer, parameter :: by_pin_speed = 5, by_bearing_speed = 6, n_motions = 6, n_slopes = n_motions + most_element_states

  !> Events of an element, in this order, up to the last one that it has: set-valued friction changes, |e| passes the first or the
  !> second of its kinks, the contact loses its force or the force acts again.
  integer, parameter :: sliding_changes = 1, first_kink = 2, force_changes = 4

  type, abstract :: load_element_t
    type(bearing_t) :: bearing
    real(dp) :: pin_radius = 0              !! of the pin [m]
    real(dp) :: change_length = 0           !! eccentricity over which its loads change severalfold; 0: the clearance [m]
    class(film_law_t), allocatable :: film                !! not allocated: the element has no film
    class(contact_geometry_t), allocatable :: walls       !! elasticity of the walls under the film; not allocated: they are rigid
    logical :: is_unbounded = .false.       !! the film has a force without bound at |e| = c, which the state must not reach
    logical :: has_own_gap = .false.        !! the gap is not that of a round pin in a round bore: see `find_gap`
    logical :: has_slopes = .true.          !! the slopes are in closed form
    logical :: is_reported = .false.        !! results of its film are kept over a run
    logical :: rubs = .false.               !! surfaces may touch while it acts, and wear
    logical :: has_friction = .false.       !! there is friction where they touch
    integer :: normal_kind = of_contact, friction_kind = of_friction   !! kinds of its normal force and of its friction
    ! first-order states
    integer :: n_states = 0
    character(len=24) :: state_name = ''    !! of all of them, in files of states
    character(len=8) :: state_unit = ''
    real(dp) :: state_scale(most_element_states) = 1      !! natural sizes
    real(dp) :: start(most_element_states) = 0            !! values at t = 0
    logical :: starts_again = .false.       !! they are 0 at the beginning of each contact
    real(dp) :: state_reach = 0             !! magnitude that they must not reach, as a vector; 0: no limit
    logical :: integrates_friction = .false.              !! the work of friction is a quadrature
    type(slice_t) :: states, friction_work  !! their indices in the state vector, set by the joint
    ! events
    real(dp) :: kinks(2) = 0                !! eccentricities beyond which the loads change their form; 0: none [m]
    logical :: is_beyond(2) = .false.       !! |e| is beyond these
    logical :: may_stick = .false.          !! friction is set-valued
    integer :: sliding = 0                  !! with set-valued friction: sign of the sliding speed, 0 while they stick
    real(dp) :: holding_ratio = 0           !! largest friction over normal force while they stick [-]
    real(dp) :: static_speed = 0            !! see friction_law_t [m/s]
    logical :: may_lose_force = .false.     !! the damper of the contact may cancel its elastic force
    logical :: force_is_lost = .false.      !! the surfaces touch, but the damper cancels the force
    type(slice_t) :: events                 !! numbers of its events among those of the joint, set by the joint
    ! limits of validity of a contact
    real(dp) :: fastest_impact = huge(1.0_dp), deepest = huge(1.0_dp)   !! speed [m/s], penetration [m]
  contains
    procedure(prepare), deferred :: prepare
    procedure, non_overridable :: prepare_film
    procedure, non_overridable :: n_events
    procedure(find_loads), deferred :: find_loads
    procedure(find_slopes), deferred :: find_slopes
    procedure(add_columns), deferred :: add_columns
    procedure :: find_gap => round_gap
    procedure :: normal_force => no_force
    procedure :: find_share => no_loss
    procedure :: free_impact_speed => no_impact
    procedure :: see_film => no_film
    procedure :: carry => carry_nothing
    procedure :: spread => on_a_line
    procedure :: wear_bore => stays_round
    procedure, non_overridable :: film_moment
    procedure, non_overridable :: powers
  end type load_element_t

  abstract interface
    !> Accept the laws that a case gives to a joint, prepare them for the bearing, and declare states and events. `tolerance` is the
    !> relative tolerance of the run; without `makes_tables` tables that take long are left out.
    subroutine prepare(self, wanted, tolerance, makes_tables)
      import :: load_element_t, joint_case_t, dp
      class(load_element_t), intent(inout) :: self
      type(joint_case_t), intent(in) :: wanted
      real(dp), intent(in) :: tolerance
      logical, intent(in) :: makes_tables
    end subroutine prepare

    !> Loads on the pin, force and moment of all kinds, and rates of the element's states. Loads of kinds that the element does
    !> not have are left as they are, and `sticks` as .false.
    pure subroutine find_loads(self, y, joint)
      import :: load_element_t, joint_evaluation_t, dp
      class(load_element_t), intent(in) :: self
      real(dp), intent(in) :: y(*)   !! the whole state vector, for the states of the element
      type(joint_evaluation_t), intent(inout) :: joint
    end subroutine find_loads

    !> Derivatives of force and moment on the pin (rows F_x, F_y, moment) and of the rates of the states, for implicit
    !> integration. Not defined for surfaces that stick.
    pure subroutine find_slopes(self, joint, of_loads, of_rates)
      import :: load_element_t, joint_evaluation_t, dp, most_element_states, n_slopes
      class(load_element_t), intent(in) :: self
      type(joint_evaluation_t), intent(in) :: joint
      real(dp), intent(out) :: of_loads(3, n_slopes), of_rates(most_element_states, n_slopes)
    end subroutine find_slopes

    !> Add the columns of the element to a row.
    pure subroutine add_columns(self, joint, row)
      import :: load_element_t, joint_evaluation_t, trace_row_t
      class(load_element_t), intent(in) :: self
      type(joint_evaluation_t), intent(in) :: joint   !! with the loads of the element that acts
      type(trace_row_t), intent(inout) :: row
    end subroutine add_columns
  end interface

contains

  !> Accept the film of a case, and prepare it.
  subroutine prepare_film(self, wanted, tolerance, makes_tables)
    class(load_element_t), intent(inout) :: self
    type(joint_case_t), intent(in) :: wanted
    real(dp), intent(in) :: tolerance
    logical, intent(in) :: makes_tables
    call wanted%make_film(self%film)
    if (makes_tables) call self%film%make_table(self%bearing, tolerance)
    call self%film%prepare(self%bearing, tolerance)
    self%is_unbounded = self%film%singular_at_wall
  end subroutine prepare_film

  !> Number of events.
  pure integer function n_events(self)
    class(load_element_t), intent(in) :: self
    n_events = merge(sliding_changes, 0, self%may_stick)
    if (self%kinks(1) > 0) n_events = first_kink + 1
    if (self%may_lose_force) n_events = force_changes
  end function n_events

  !> Replace penetration and penetration rate, which are those of a round pin in a round bore, if the element `has_own_gap`.
  pure subroutine round_gap(self, y, joint)
    class(load_element_t), intent(in) :: self
    real(dp), intent(in) :: y(*)
    type(joint_evaluation_t), intent(inout) :: joint
  end subroutine round_gap

  !> Normal force of the contact as it follows from the position and velocity of the pin alone [N].
  pure real(dp) function no_force(self, joint)
    class(load_element_t), intent(in) :: self
    type(joint_evaluation_t), intent(in) :: joint
    no_force = 0
  end function no_force

  !> The damped over the elastic force of a contact that may lose its force, without the limit 0, and its rate [1/s].
  pure subroutine no_loss(self, joint, rates, share, share_rate)
    class(load_element_t), intent(in) :: self
    type(joint_evaluation_t), intent(in) :: joint
    type(joint_rates_t), intent(in) :: rates
    real(dp), intent(out) :: share, share_rate
    share = 1
    share_rate = 0
  end subroutine no_loss

  !> Impact speed [m/s] of a contact that is present at the start, whose elastic force decelerates the penetration as given.
  !> Elements with a contact law override this.
  pure real(dp) function no_impact(self, joint, deceleration) result(speed)
    class(load_element_t), intent(in) :: self
    type(joint_evaluation_t), intent(in) :: joint
    real(dp), intent(in) :: deceleration   !! [m/s^2]
    speed = joint%impact_speed
  end function no_impact

  !> The film of the element: the motion on which it depends, the velocity with which it gives way [m/s], the share of the full film
  !> that acts, 0 if none does, and a further factor of its pressures.
  pure subroutine no_film(self, joint, seen, rate, share, thickening)
    class(load_element_t), intent(in) :: self
    type(joint_evaluation_t), intent(in) :: joint
    type(film_motion_t), intent(out) :: seen
    real(dp), intent(out) :: rate(2), share, thickening
    rate = joint%eccentricity_rate
    share = 0
    thickening = 1
  end subroutine no_film

  !> The inverse of `find_loads`, for films that can carry a load without inertia: the motion of the pin in its bearing with which
  !> the element carries a load (force of the pin on its bearing). Eccentricity, its rate, the loads and the rates of the states are
  !> set; the position in the film, `place`, is a state, and the angular speeds are known.
  pure subroutine carry_nothing(self, place, load, joint)
    class(load_element_t), intent(in) :: self
    real(dp), intent(in) :: place(2), load(2)   !! [m], |place| < c for a film without bound at the wall; [N]
    type(joint_evaluation_t), intent(inout) :: joint
    joint%eccentricity = place
    joint%eccentricity_rate = 0
  end subroutine carry_nothing

  !> How the contact spreads along an arc: as far as they are present, `ratio`, Int p R L dtheta over the normal force [-], and
  !> `arc`, in cells that are not much wider than `width` [rad]; it has none for contact along a line.
  pure subroutine on_a_line(self, joint, ratio, width, arc)
    class(load_element_t), intent(in) :: self
    type(joint_evaluation_t), intent(in) :: joint
    real(dp), intent(out), optional :: ratio
    real(dp), intent(in), optional :: width
    type(contact_arc_t), intent(inout), optional :: arc
    if (present(ratio)) ratio = 1
    if (present(arc)) arc%n = 0
  end subroutine on_a_line

  !> Change the shape of the bore: depth of wear in the middle of each of its bins [m].
  pure subroutine stays_round(self, depth)
    class(load_element_t), intent(inout) :: self
    real(dp), intent(in) :: depth(:)
  end subroutine stays_round

  !> Moment of the shear of the film on the pin [N m] as far as the case includes it: that of all loads without friction.
  pure real(dp) function film_moment(self, joint)
    class(load_element_t), intent(in) :: self
    type(joint_evaluation_t), intent(in) :: joint
    film_moment = joint%moment - joint%friction_force*self%pin_radius
  end function film_moment

  !> Powers of the kinds of load on the bodies [W]; their sum is the power of the joint.
  pure function powers(self, joint)
    class(load_element_t), intent(in) :: self
    type(joint_evaluation_t), intent(in) :: joint
    real(dp) :: powers(n_kinds)
    type(film_motion_t) :: seen
    real(dp) :: rate(2), share, thickening
    call self%see_film(joint, seen, rate, share, thickening)
    powers = 0
    powers(of_film) = power_of(joint, joint%film, rate, self%film_moment(joint))
    powers(of_contact) = dot_product(joint%film, joint%eccentricity_rate - rate)   ! of elastic walls
    powers(self%normal_kind) = powers(self%normal_kind) - joint%normal_force*dot_product(joint%normal, joint%eccentricity_rate)
    powers(self%friction_kind) = powers(self%friction_kind) + joint%friction_force*joint%sliding_speed
  end function powers

  !> Power of a force and a moment between pin and bearing on the bodies [W].
  pure real(dp) function power_of(joint, force, rate, moment)
    type(joint_evaluation_t), intent(in) :: joint
    real(dp), intent(in) :: force(2), moment   !! on the pin [N], [N m]
    real(dp), intent(in) :: rate(2)            !! velocity with which the force moves [m/s]
    power_of = dot_product(force, rate) + moment*joint%pin_angular_speed &
      + bearing_moment(joint%eccentricity, force, moment)*joint%bearing_speed
  end function power_of
end module load_element
