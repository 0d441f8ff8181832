!> A cylinder whose rod and piston have ideal joints: a function of the angle of its throw, without states. It adds an inertia I and
!> a torque G - F_gas p - I'/2 q'^2 to the equation of the station of the crankshaft on which its throw stands. With k = dA/dq and
!> p = dx/dq, the speed of the rod's big end and that of its small end give the speed of its centre of mass (U, V), so that
!>
!>     I = a + b p^2 + c k^2 + e p cos q,    a = m11 - m_r R^2 U/L,  b = m_p + m_r U/L,  c = m22 - m_r U L,  e = 2 m_r V R/L
!>     G = w_1 sin q + w_2 cos q + w_3 p:    gravity on the crank, and on the rod with its mass at both ends
!>     k = R cos q/(L cos A),  k' = tan A (k^2 - 1) - d/(L cos A),  p = -R sin q (1 + k) + d k
!>
!> Its bodies, with the body of the crank of its throw, are in its own axes: x along its axis, gravity turned accordingly.
module ideal_cylinders
  use kinds, only: dp
  use chain_motion, only: motion_t, accelerations_t, crank_pin
  use chain_bodies, only: bodies_t, drive_t
  use chain_loads, only: loads_t
  use chain_reactions, only: reactions_t, reactions_of
  use ideal_chain, only: ideal_motion, accelerate_ideal_chain
  implicit none
  private
  public :: ideal_cylinder_t, cylinder_forces_t, small_sine_cosine

  type :: ideal_cylinder_t
    integer :: number = 0                !! in the case
    integer :: station = 1               !! of its throw
    integer :: throw = 1                 !! number of its throw along the shaft
    real(dp) :: shift = 0                !! crank angle from its own axis minus the angle of its station [rad]
    real(dp) :: sin_shift = 0, cos_shift = 1
    real(dp) :: bank = 0                 !! angle of its axis from that of the full cylinder, positive from x to y [rad]
    real(dp) :: axial_position = 0       !! [m]
    type(bodies_t) :: bodies
    real(dp), private :: length = 0      !! R [m]
    real(dp), private :: ratio = 0       !! R/L
    real(dp), private :: axis_offset = 0 !! d/R
    real(dp), private :: constant = 0    !! a [kg m^2]
    real(dp), private :: by_piston = 0   !! b [kg]
    real(dp), private :: by_rod = 0      !! c [kg m^2]
    real(dp), private :: by_offset = 0   !! e/2 [kg m]
    real(dp), private :: weight(3) = 0   !! w [N m], [N m], [N]
  contains
    procedure :: set_bodies
    procedure, non_overridable :: find_terms
    procedure :: inertia
    procedure :: energy
    procedure :: forces
  end type ideal_cylinder_t

  !> Results of a cylinder in its own axes.
  type :: cylinder_forces_t
    type(reactions_t) :: reactions
    real(dp) :: piston_position = 0      !! [m]
    real(dp) :: torque = 0               !! of the rod on the crank [N m]
    real(dp) :: rod(2) = 0               !! cosine and sine of the angle A of the rod
    real(dp) :: rod_speed = 0            !! A' [rad/s]
  end type cylinder_forces_t

contains

  !> Set the bodies, and the terms that follow from them.
  pure subroutine set_bodies(self, bodies)
    class(ideal_cylinder_t), intent(inout) :: self
    type(bodies_t), intent(in) :: bodies
    real(dp) :: at_end(2)   ! of the rod's mass at its small end [kg]
    self%bodies = bodies
    associate (b => bodies, rod => bodies%rod)
      at_end = rod%mass*rod%com*b%per_rod_length
      self%length = b%crank%length
      self%ratio = b%crank%length*b%per_rod_length
      self%axis_offset = b%piston%axis_offset/b%crank%length
      self%constant = b%crank_term - at_end(1)*b%crank%length**2
      self%by_piston = b%piston%mass + at_end(1)
      self%by_rod = b%rod_term - at_end(1)*rod%length**2
      self%by_offset = at_end(2)*b%crank%length
      self%weight = [b%crank_weight - self%ratio*b%rod_weight, b%gravity(1)*b%piston%mass - b%rod_weight(1)*b%per_rod_length]
    end associate
  end subroutine set_bodies

  !> Inertia I, half of its slope I'/2 [kg m^2], moment of gravity G [N m] and speed of the piston p [m] at the sine and the cosine
  !> of a crank angle.
  pure subroutine find_terms(self, sine, cosine, inertia, half_slope, weight, rate)
    class(ideal_cylinder_t), intent(in) :: self
    real(dp), intent(in) :: sine, cosine
    real(dp), intent(out) :: inertia, half_slope, weight, rate
    real(dp) :: across, sin_rod, lever, k, k_slope, rate_slope
    across = sine - self%axis_offset
    sin_rod = self%ratio*across
    lever = self%ratio/sqrt((1 - sin_rod)*(1 + sin_rod))
    k = lever*cosine
    k_slope = lever*across*((k - 1)*(k + 1)) - lever*self%axis_offset
    rate = -self%length*sine*(1 + k) + self%length*self%axis_offset*k
    rate_slope = -self%length*(across*k_slope + cosine*(1 + k))
    inertia = self%constant + rate*(self%by_piston*rate + 2*self%by_offset*cosine) + self%by_rod*k**2
    half_slope = rate_slope*(self%by_piston*rate + self%by_offset*cosine) - self%by_offset*sine*rate + self%by_rod*k*k_slope
    weight = self%weight(1)*sine + self%weight(2)*cosine + self%weight(3)*rate
  end subroutine find_terms

  !> Inertia at a crank angle [kg m^2].
  pure real(dp) function inertia(self, angle)
    class(ideal_cylinder_t), intent(in) :: self
    real(dp), intent(in) :: angle   !! [rad]
    real(dp) :: half_slope, weight, rate
    call self%find_terms(sin(angle), cos(angle), inertia, half_slope, weight, rate)
  end function inertia

  !> Kinetic and potential energy at a crank angle [rad] and a speed [rad/s] [J].
  pure real(dp) function energy(self, angle, speed)
    class(ideal_cylinder_t), intent(in) :: self
    real(dp), intent(in) :: angle, speed
    type(motion_t) :: motion
    motion = ideal_motion(self%bodies, angle, speed)
    energy = self%bodies%kinetic_energy(motion) + self%bodies%potential_energy(motion)
  end function energy

  !> The forces between the bodies of the cylinder and on the frame, at a crank angle [rad], speed [rad/s] and acceleration
  !> [rad/s^2].
  pure type(cylinder_forces_t) function forces(self, angle, speed, acceleration, gas_force) result(found)
    class(ideal_cylinder_t), intent(in) :: self
    real(dp), intent(in) :: angle, speed, acceleration, gas_force
    type(motion_t) :: motion
    type(accelerations_t) :: accelerations
    type(loads_t) :: loads
    real(dp) :: moment
    motion = ideal_motion(self%bodies, angle, speed)
    loads%force = 0
    loads%moment = 0
    loads%axial_force = gas_force
    call accelerate_ideal_chain(self%bodies, drive_t(.false., 0.0_dp, 0.0_dp, acceleration, 0.0_dp), motion, loads, &
      accelerations, moment)
    accelerations%pin(:, crank_pin) = 0
    found%reactions = reactions_of(self%bodies, loads, motion, accelerations)
    found%piston_position = motion%piston_position
    found%rod = [motion%cos_rod, motion%sin_rod]
    found%rod_speed = motion%rod_speed
    found%torque = self%bodies%crank%length*(found%reactions%crankpin(1)*motion%sin_crank &
      - found%reactions%crankpin(2)*motion%cos_crank)
  end function forces

  !> Sine and cosine of an angle [rad], by a series if it is small.
  pure subroutine small_sine_cosine(angle, sine, cosine)
    real(dp), intent(in) :: angle
    real(dp), intent(out) :: sine, cosine
    real(dp) :: square
    if (abs(angle) < 0.05_dp) then
      square = angle**2
      sine = angle*(1 - square*(1/6.0_dp - square*(1/120.0_dp - square*(1/5040.0_dp))))
      cosine = 1 - square*(0.5_dp - square*(1/24.0_dp - square*(1/720.0_dp - square*(1/40320.0_dp))))
    else
      sine = sin(angle)
      cosine = cos(angle)
    end if
  end subroutine small_sine_cosine
end module ideal_cylinders
