!> A piston pin that turns in both of its bearings, in the piston and in the rod's small end: a third body between rod and piston.
!>
!>     m_g P'' = F_b + F_s + m_g g,    I_g phi'' = M_b + M_s,    e_b = P - C,    e_s = P - S
!>
!> P is its centre, C that of the bearing in the piston, S that of the bearing in the rod. Since the forces of both joints follow
!> from the state, rod and piston do not feel its inertia: they move as those of a chain without it, on whose rod the force -F_s
!> acts and on whose piston the force -F_b. That chain has one force for both, so that F_b + F_s acts on its piston from outside.
module floating_pin
  use kinds, only: dp
  use state_layout, only: layout_t, coordinates_t
  use run_state, only: run_state_t
  use chain_motion, only: motion_t, accelerations_t, piston_pin, small_end, body_pin
  use chain_bodies, only: bodies_t
  use chain_loads, only: loads_t, bearing_moment
  use chain_reactions, only: reactions_t
  use loose_piston, only: pin_eccentricity, bearing_acceleration
  implicit none
  private
  public :: floating_pin_t

  type :: floating_pin_t
    real(dp) :: mass = 0          !! m_g [kg], > 0
    real(dp) :: inertia = 0       !! I_g, about its axis [kg m^2], > 0
    real(dp) :: start_speed = 0   !! angular speed at t = 0, positive from x to y [rad/s]
    type(coordinates_t) :: turn   !! index of its angle in the state
  contains
    procedure :: claim
    procedure :: set_start
    procedure :: declare
    procedure :: read_state
    procedure :: set_rates
    procedure :: chain_loads
    procedure :: accelerate
    procedure :: split_loads
    procedure, nopass :: split_reactions
    procedure :: energy
  end type floating_pin_t

contains

  !> Claim the angle in the state vector. Its tolerance is not relative to its value, since it drifts.
  subroutine claim(self, layout, rod_speed)
    class(floating_pin_t), intent(inout) :: self
    type(layout_t), intent(inout) :: layout
    real(dp), intent(in) :: rod_speed   !! natural size of the angular speed of the rod [rad/s]
    call layout%claim_positions(1, 1.0_dp, max(rod_speed, abs(self%start_speed), 1.0_dp), self%turn, grows=.true.)
  end subroutine claim

  !> Set the initial state in the state vector.
  pure subroutine set_start(self, y)
    class(floating_pin_t), intent(in) :: self
    real(dp), intent(inout) :: y(:)
    y(self%turn%position) = 0
    y(self%turn%rate) = self%start_speed
  end subroutine set_start

  !> Declare the turn of the pin. A run that begins with the motion of another one counts it from 0.
  subroutine declare(self, list, y)
    class(floating_pin_t), intent(in) :: self
    type(run_state_t), intent(inout) :: list
    real(dp), intent(inout) :: y(:)
    list%of_totals = .true.
    call list%add('pin_angle', y(self%turn%position), 'rad', 'angle by which the floating pin has turned since the start')
    list%of_totals = .false.
    call list%add('pin_speed', y(self%turn%rate), 'rad/s', 'angular speed of the floating pin, positive from x to y')
  end subroutine declare

  !> Set angle and speed of the pin.
  pure subroutine read_state(self, y, motion)
    class(floating_pin_t), intent(in) :: self
    real(dp), intent(in) :: y(*)
    type(motion_t), intent(inout) :: motion
    motion%pin_angle = y(self%turn%position)
    motion%turning(body_pin) = y(self%turn%rate)
  end subroutine read_state

  pure subroutine set_rates(self, motion, accelerations, dydt)
    class(floating_pin_t), intent(in) :: self
    type(motion_t), intent(in) :: motion
    type(accelerations_t), intent(in) :: accelerations
    real(dp), intent(inout) :: dydt(*)
    dydt(self%turn%position) = motion%turning(body_pin)
    dydt(self%turn%rate) = accelerations%pin_turn
  end subroutine set_rates

  !> The loads of a chain without the pin, in which rod and piston move as they do with it.
  pure subroutine chain_loads(self, bodies, motion, loads, acting)
    class(floating_pin_t), intent(in) :: self
    type(bodies_t), intent(in) :: bodies
    type(motion_t), intent(in) :: motion
    type(loads_t), intent(in) :: loads
    type(loads_t), intent(out) :: acting
    real(dp) :: on_pin(2), e(2)
    on_pin = loads%force(:, piston_pin) - loads%force(:, small_end)
    acting = loads
    acting%force(:, piston_pin) = loads%force(:, small_end)
    acting%moment(piston_pin) = loads%moment(small_end)
    acting%axial_force = loads%axial_force + on_pin(1)
    if (.not. bodies%piston%is_loose) return
    e = pin_eccentricity(motion)
    acting%bore_force = loads%bore_force - on_pin(2)
    acting%bore_moment = loads%bore_moment + moment_on_piston(e - motion%small_end, piston_pin) &
      - moment_on_piston(e, small_end)

  contains

    !> Moment of the opposite of a load about the piston's centre of mass [N m].
    pure real(dp) function moment_on_piston(eccentricity, pin) result(moment)
      real(dp), intent(in) :: eccentricity(2)
      integer, intent(in) :: pin
      associate (f => loads%force(:, pin), p => motion%tilting%com)
        moment = bearing_moment(eccentricity, f, loads%moment(pin)) + p(1)*f(2) - p(2)*f(1)
      end associate
    end function moment_on_piston
  end subroutine chain_loads

  !> Accelerations of the pin in both bearings and of its turn, from those of a chain without it.
  pure subroutine accelerate(self, bodies, motion, loads, accelerations)
    class(floating_pin_t), intent(in) :: self
    type(bodies_t), intent(in) :: bodies   !! with the gravity that acts on the pin too
    type(motion_t), intent(in) :: motion
    type(loads_t), intent(in) :: loads
    type(accelerations_t), intent(inout) :: accelerations
    real(dp) :: apart(2)   ! S'' - C''
    apart = accelerations%pin(:, piston_pin)
    accelerations%pin(:, piston_pin) = (loads%force(:, piston_pin) - loads%force(:, small_end))/self%mass + bodies%gravity &
      - in_piston(bodies, motion, accelerations)
    accelerations%pin(:, small_end) = apart - accelerations%pin(:, piston_pin)
    accelerations%pin_turn = (loads%moment(piston_pin) &
      + bearing_moment(motion%small_end, loads%force(:, small_end), loads%moment(small_end)))/self%inertia
  end subroutine accelerate

  !> Acceleration C'' of the bearing in the piston [m/s^2].
  pure function in_piston(bodies, motion, accelerations) result(a)
    type(bodies_t), intent(in) :: bodies
    type(motion_t), intent(in) :: motion
    type(accelerations_t), intent(in) :: accelerations
    real(dp) :: a(2)
    a = [accelerations%piston, 0.0_dp]
    if (bodies%piston%is_loose) a = bearing_acceleration(motion, accelerations)
  end function in_piston

  !> The loads of a chain with the pin fixed in the piston, from which the reactions follow: `split_reactions` completes them with
  !> the force that accelerates the pin, beside its weight [N].
  pure subroutine split_loads(self, bodies, motion, accelerations, loads, acting, force)
    class(floating_pin_t), intent(in) :: self
    type(bodies_t), intent(in) :: bodies
    type(motion_t), intent(in) :: motion
    type(accelerations_t), intent(in) :: accelerations
    type(loads_t), intent(in) :: loads
    type(loads_t), intent(out) :: acting
    real(dp), intent(out) :: force(2)
    force = self%mass*(accelerations%pin(:, piston_pin) + in_piston(bodies, motion, accelerations) - bodies%gravity)
    acting = loads
    acting%moment(piston_pin) = loads%moment(small_end)
    acting%axial_force = loads%axial_force + force(1)
  end subroutine split_loads

  !> Set the reactions on both sides of the pin, from those of the chain with the loads of `split_loads`.
  pure subroutine split_reactions(axial_force, force, reactions)
    real(dp), intent(in) :: axial_force   !! on the piston, as in `loads_t` [N]
    real(dp), intent(in) :: force(2)      !! by `split_loads`
    type(reactions_t), intent(inout) :: reactions
    reactions%small_end = reactions%pin
    reactions%pin = reactions%pin - force
    reactions%guide = reactions%guide - force(2)
    reactions%frame = reactions%crank_bearing - [axial_force, reactions%guide]
  end subroutine split_reactions

  !> Kinetic and potential energy [J]. The motion of the piston must be known.
  pure real(dp) function energy(self, bodies, motion)
    class(floating_pin_t), intent(in) :: self
    type(bodies_t), intent(in) :: bodies
    type(motion_t), intent(in) :: motion
    real(dp) :: position(2), velocity(2)   ! of P
    position = motion%offset - motion%crank_pin - motion%small_end   ! e_b, and the offset of the piston's bearing
    position(1) = position(1) + motion%piston_position
    velocity = motion%offset_rate - motion%crank_pin_rate - motion%small_end_rate
    velocity(1) = velocity(1) + motion%piston_velocity
    energy = 0.5_dp*(self%mass*sum(velocity**2) + self%inertia*motion%turning(body_pin)**2) &
      - self%mass*dot_product(bodies%gravity, position)
  end function energy
end module floating_pin
