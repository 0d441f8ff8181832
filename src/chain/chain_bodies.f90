!> The bodies of the chain of crank, rod and piston, and the drive: constants, energy (Reis 2013, 3.1-3.66).
!>
!> x is vertical, upwards, along the cylinder axis; y is horizontal; angles are positive from x towards y. q is the crank angle from
!> +x. The rod angle A is measured in the opposite sense: the angular speed of the rod is -dA/dt.
module chain_bodies
  use kinds, only: dp
  use chain_motion, only: motion_t
  implicit none
  private
  public :: bodies_t, crank_t, rod_t, piston_t, drive_t, undriven, new_bodies, weightless

  !> The crank. The origin of its frame is the crank bearing; the first axis points to the crank pin.
  type :: crank_t
    real(dp) :: length = 0    !! R [m]
    real(dp) :: mass = 0      !! [kg]
    real(dp) :: inertia = 0   !! about its centre of mass [kg m^2]
    real(dp) :: com(2) = 0    !! position of its centre of mass (U_c, V_c) [m]
  end type crank_t

  !> The connecting rod. The origin of its frame is its big end; the first axis points to the piston pin.
  type :: rod_t
    real(dp) :: length = 0    !! L [m], > R
    real(dp) :: mass = 0      !! [kg]
    real(dp) :: inertia = 0   !! about its centre of mass [kg m^2]
    real(dp) :: com(2) = 0    !! position of its centre of mass (U_r, V_r) [m]
  end type rod_t

  !> The piston. The origin of its frame is the centre of the pin's bearing; the first axis points away from the crank.
  type :: piston_t
    real(dp) :: mass = 0          !! [kg], > 0
    logical :: is_loose = .false. !! it has clearance in its bore; the following components are used only then
    real(dp) :: inertia = 0       !! about its centre of mass [kg m^2], > 0
    real(dp) :: com(2) = 0        !! position of its centre of mass (U_p, V_p) [m]
    real(dp) :: axis_offset = 0   !! d, of the cylinder axis from the crank axis, along y [m]
  end type piston_t

  !> The drive of the crank. (No default values, since one is made in every evaluation.)
  type :: drive_t
    logical :: free_crank            !! the crank moves under its loads; otherwise its speed is prescribed
    real(dp) :: torque               !! torque tau on a free crank [N m]
    real(dp) :: damping              !! D, damping moment per crank speed [N m s/rad]
    real(dp) :: acceleration         !! of a crank with prescribed speed [rad/s^2]
    real(dp) :: inertia              !! that moves with the crank in addition to its own [kg m^2]
  end type drive_t

  type(drive_t), parameter :: undriven = drive_t(.true., 0.0_dp, 0.0_dp, 0.0_dp, 0.0_dp)   !! a free crank without torque

  !> The bodies with derived constants; made by `new_bodies`.
  type :: bodies_t
    type(crank_t) :: crank
    type(rod_t) :: rod
    type(piston_t) :: piston
    real(dp) :: gravity(2) = 0          !! (x, y) [m/s^2]
    real(dp) :: per_rod_length = 0      !! 1/L [1/m]
    real(dp) :: per_piston_mass = 0     !! [1/kg]
    real(dp) :: crank_inertia = 0       !! moment of inertia of the crank about its bearing [kg m^2]
    real(dp) :: crank_term = 0          !! m11, the same with the rod's mass at the crank pin [kg m^2]
    real(dp) :: rod_term = 0            !! m22, moment of inertia of the rod about its big end [kg m^2]
    real(dp) :: inertia_product = 0     !! m11 m22 [kg^2 m^4]
    real(dp) :: static_moment(2) = 0    !! m_rod R (U_r, V_r) [kg m^2]
    real(dp) :: crank_weight(2) = 0     !! moment of gravity on q: (1) sin q + (2) cos q [N m], with the rod's mass at the crank pin
    real(dp) :: crank_own_weight(2) = 0 !! the same for the crank alone
    real(dp) :: rod_weight(2) = 0       !! moment of gravity on A about the big end: (1) sin A - (2) cos A [N m]
  contains
    procedure :: coupling
    procedure :: kinetic_energy
    procedure :: potential_energy
    procedure :: energy_beside_rod
  end type bodies_t

contains

  !> The bodies with derived constants. Limits: rod%length > 0, piston%mass > 0.
  pure type(bodies_t) function new_bodies(crank, rod, piston, gravity) result(b)
    type(crank_t), intent(in) :: crank
    type(rod_t), intent(in) :: rod
    type(piston_t), intent(in) :: piston
    real(dp), intent(in) :: gravity(2)   !! (x, y) [m/s^2]
    real(dp) :: moment(2)
    b%crank = crank
    b%rod = rod
    b%piston = piston
    b%gravity = gravity
    b%per_rod_length = 1/rod%length
    b%per_piston_mass = 1/piston%mass
    b%crank_inertia = crank%inertia + crank%mass*sum(crank%com**2)
    b%crank_term = b%crank_inertia + rod%mass*crank%length**2
    b%rod_term = rod%inertia + rod%mass*sum(rod%com**2)
    b%inertia_product = b%crank_term*b%rod_term
    b%static_moment = rod%mass*crank%length*rod%com
    moment = crank%mass*crank%com
    b%crank_own_weight = weight_on_crank(moment)
    b%crank_weight = weight_on_crank(moment + [rod%mass*crank%length, 0.0_dp])
    moment = rod%mass*rod%com
    b%rod_weight = -[gravity(1)*moment(1) + gravity(2)*moment(2), gravity(1)*moment(2) - gravity(2)*moment(1)]

  contains

    !> Factors of sin q and cos q in the moment of gravity on a crank with the given first moment of mass [kg m].
    pure function weight_on_crank(first_moment) result(weight)
      real(dp), intent(in) :: first_moment(2)
      real(dp) :: weight(2)
      weight = [-gravity(1)*first_moment(1) - gravity(2)*first_moment(2), &
        gravity(2)*first_moment(1) - gravity(1)*first_moment(2)]
    end function weight_on_crank
  end function new_bodies

  !> The same bodies without gravity.
  pure type(bodies_t) function weightless(bodies) result(b)
    type(bodies_t), intent(in) :: bodies
    b = bodies
    b%gravity = 0
    b%crank_weight = 0
    b%crank_own_weight = 0
    b%rod_weight = 0
  end function weightless

  !> m12 = -m_rod R (U_r cos s + V_r sin s) and c = dm12/ds, s = q + A [kg m^2].
  pure subroutine coupling(self, motion, m12, slope)
    class(bodies_t), intent(in) :: self
    type(motion_t), intent(in) :: motion
    real(dp), intent(out) :: m12, slope
    real(dp) :: along, across
    ! multiplied out with the sines and cosines of q, which are known before those of A
    along = self%static_moment(1)*motion%cos_crank + self%static_moment(2)*motion%sin_crank
    across = self%static_moment(1)*motion%sin_crank - self%static_moment(2)*motion%cos_crank
    m12 = across*motion%sin_rod - along*motion%cos_rod
    slope = across*motion%cos_rod + along*motion%sin_rod
  end subroutine coupling

  !> Kinetic energy of the three bodies [J]. The motion of the piston must be known (see `follow_piston`).
  pure real(dp) function kinetic_energy(self, motion)
    class(bodies_t), intent(in) :: self
    type(motion_t), intent(in) :: motion
    real(dp) :: m12, slope, slip(2), turned(2)
    call self%coupling(motion, m12, slope)
    kinetic_energy = 0.5_dp*(self%crank_term*motion%crank_speed**2 + self%rod_term*motion%rod_speed**2 &
      + self%piston%mass*motion%piston_velocity**2) + m12*motion%crank_speed*motion%rod_speed
    slip = -motion%crank_pin_rate
    if (abs(slip(1)) + abs(slip(2)) <= 0) return
    ! the big end does not move with the crank pin
    turned = [-self%rod%com(1)*motion%sin_rod + self%rod%com(2)*motion%cos_rod, &
      -self%rod%com(1)*motion%cos_rod - self%rod%com(2)*motion%sin_rod]
    kinetic_energy = kinetic_energy + self%rod%mass*dot_product(slip, 0.5_dp*slip &
      + self%crank%length*motion%crank_speed*[-motion%sin_crank, motion%cos_crank] + motion%rod_speed*turned)
  end function kinetic_energy

  !> Potential energy of the three bodies in gravity, 0 at the crank axis [J].
  pure real(dp) function potential_energy(self, motion)
    class(bodies_t), intent(in) :: self
    type(motion_t), intent(in) :: motion
    real(dp) :: crank(2), rod(2)
    associate (c => self%crank%com, r => self%rod%com)
      crank = [c(1)*motion%cos_crank - c(2)*motion%sin_crank, c(1)*motion%sin_crank + c(2)*motion%cos_crank]
      rod = self%crank%length*[motion%cos_crank, motion%sin_crank] - motion%crank_pin &
        + [r(1)*motion%cos_rod + r(2)*motion%sin_rod, -r(1)*motion%sin_rod + r(2)*motion%cos_rod]
      potential_energy = -(dot_product(self%gravity, self%crank%mass*crank + self%rod%mass*rod) &
        + self%gravity(1)*self%piston%mass*motion%piston_position)
    end associate
  end function potential_energy

  !> Kinetic and potential energy of crank and piston [J].
  pure real(dp) function energy_beside_rod(self, motion) result(energy)
    class(bodies_t), intent(in) :: self
    type(motion_t), intent(in) :: motion
    real(dp) :: crank(2)
    associate (c => self%crank%com)
      crank = [c(1)*motion%cos_crank - c(2)*motion%sin_crank, c(1)*motion%sin_crank + c(2)*motion%cos_crank]
    end associate
    energy = 0.5_dp*(self%crank_inertia*motion%crank_speed**2 + self%piston%mass*motion%piston_velocity**2) &
      - dot_product(self%gravity, self%crank%mass*crank) - self%gravity(1)*self%piston%mass*motion%piston_position
  end function energy_beside_rod
end module chain_bodies
