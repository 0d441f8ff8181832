!> A cylinder whose rod and piston have ideal joints: a function of the angle of its throw, without states. It adds an inertia I and
!> a torque G - I'/2 q'^2 to the equation of the station of the crankshaft on which its throw stands:
!>
!>     I = m_c-term + m_r R^2 + k (2 m12 + k m22) + m_p p^2,    k = dA/dq,  p = dx/dq
!>     I'/2 = c k (1 + k) + (m12 + k m22) k' + m_p p p'
!>     G = p (m_p g_x - F_gas) + k (moment of gravity on the rod) + moment of gravity on the crank with the rod's mass at its pin
!>
!> Its bodies, with the body of the crank of its throw, are in its own axes: x along its axis, gravity turned accordingly.
module ideal_cylinders
  use kinds, only: dp
  use train_motion, only: train_motion_t
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
  contains
    procedure, non_overridable :: follow
    procedure, non_overridable :: add_row
    procedure, non_overridable :: piston_rate
    procedure :: inertia
    procedure :: energy
    procedure :: forces
  end type ideal_cylinder_t

  !> Results of a cylinder in its own axes.
  type :: cylinder_forces_t
    type(reactions_t) :: reactions
    real(dp) :: piston_position = 0      !! [m]
    real(dp) :: torque = 0               !! of the rod on the crank [N m]
  end type cylinder_forces_t

contains

  !> Set sine and cosine of the rod's angle, and 1/(L cos A), of element i of the motion, whose crank is known.
  pure subroutine follow(self, i, train)
    class(ideal_cylinder_t), intent(in) :: self
    integer, intent(in) :: i
    type(train_motion_t), intent(inout) :: train
    real(dp) :: gap
    associate (sin_rod => train%sin_rod(i))
      sin_rod = self%bodies%crank%length*train%sine(i)*self%bodies%per_rod_length
      gap = (1 - sin_rod)*(1 + sin_rod)
    end associate
    train%cos_rod(i) = sqrt(gap)
    train%per_arm(i) = self%bodies%per_rod_length/gap*train%cos_rod(i)
  end subroutine follow

  !> Add inertia and torque in the motion of element i, at a speed [rad/s] and with its force of the gas, to those of the station.
  pure subroutine add_row(self, i, train, speed, inertia, torque)
    class(ideal_cylinder_t), intent(in) :: self
    integer, intent(in) :: i
    type(train_motion_t), intent(in) :: train
    real(dp), intent(in) :: speed
    real(dp), intent(inout) :: inertia, torque
    real(dp) :: k, k_slope, p, p_slope, along, across, m12, c
    associate (b => self%bodies, r => self%bodies%crank%length, mass => self%bodies%piston%mass, sine => train%sine(i), &
               cosine => train%cosine(i), sin_rod => train%sin_rod(i), cos_rod => train%cos_rod(i), per_arm => train%per_arm(i), &
               gas_force => train%gas_force(i))
      k = r*cosine*per_arm
      k_slope = b%rod%length*sin_rod*per_arm*((k - 1)*(k + 1))
      p = -r*sine*(1 + k)
      p_slope = -(r*sine*k_slope + r*cosine*(1 + k))
      along = b%static_moment(1)*cosine + b%static_moment(2)*sine
      across = b%static_moment(1)*sine - b%static_moment(2)*cosine
      m12 = across*sin_rod - along*cos_rod
      c = across*cos_rod + along*sin_rod
      inertia = inertia + (b%crank_term + k*(2*m12 + k*b%rod_term) + mass*p**2)
      torque = torque + (b%crank_weight(1)*sine + b%crank_weight(2)*cosine) &
        + k*(b%rod_weight(1)*sin_rod - b%rod_weight(2)*cos_rod) + p*(b%gravity(1)*mass - gas_force) &
        - speed**2*(c*k*(1 + k) + (m12 + k*b%rod_term)*k_slope + mass*p*p_slope)
    end associate
  end subroutine add_row

  !> p = dx/dq of the piston in the motion of element i [m].
  pure real(dp) function piston_rate(self, i, train) result(rate)
    class(ideal_cylinder_t), intent(in) :: self
    integer, intent(in) :: i
    type(train_motion_t), intent(in) :: train
    associate (r => self%bodies%crank%length)
      rate = -r*train%sine(i)*(1 + r*train%cosine(i)*train%per_arm(i))
    end associate
  end function piston_rate

  !> Inertia at a crank angle [kg m^2].
  pure real(dp) function inertia(self, angle)
    class(ideal_cylinder_t), intent(in) :: self
    real(dp), intent(in) :: angle   !! [rad]
    type(train_motion_t) :: train
    real(dp) :: torque
    train%sine(1) = sin(angle)
    train%cosine(1) = cos(angle)
    train%gas_force(1) = 0
    call self%follow(1, train)
    inertia = 0
    torque = 0
    call self%add_row(1, train, 0.0_dp, inertia, torque)
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
