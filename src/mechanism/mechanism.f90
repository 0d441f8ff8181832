!> The three bodies of the slider-crank mechanism: geometry, inertia, kinematics and energy (Reis 2013, 3.1-3.30).
!>
!> x is vertical, up, along the cylinder axis; y is horizontal; angles are positive from x towards y. q is the
!> crank angle from +x. A is the rod angle, measured the other way: the rod turns with omega_rod = -dA/dt. The pin
!> is at (R cos q + L cos A, R sin q - L sin A).
module mechanism
  use kinds, only: dp
  implicit none
  private
  public :: mechanism_t, motion_t, accelerations_t, turn_crank

  !> Constants of the bodies. Centres of mass are given in each body's own frame: the crank's from the crank
  !> bearing, the first axis towards the crank pin; the rod's from the crank pin, the first axis towards the pin. The
  !> second part follows from the first, once: `mechanism_t(...)` with the first ten values fills it.
  type :: mechanism_t
    real(dp) :: crank_length = 0    !! R [m]
    real(dp) :: crank_mass = 0      !! [kg]
    real(dp) :: crank_inertia = 0   !! about its centre of mass [kg m^2]
    real(dp) :: crank_com(2) = 0    !! (U_c, V_c) [m]
    real(dp) :: rod_length = 0      !! L [m], > R
    real(dp) :: rod_mass = 0        !! [kg]
    real(dp) :: rod_inertia = 0     !! about its centre of mass [kg m^2]
    real(dp) :: rod_com(2) = 0      !! (U_r, V_r) [m]
    real(dp) :: piston_mass = 0     !! [kg]
    real(dp) :: gravity = 0         !! along -x [m/s^2]
    real(dp) :: crank_term = 0      !! m11 = I_crank + m_crank (U_c^2 + V_c^2) + m_rod R^2 [kg m^2]
    real(dp) :: rod_term = 0        !! m22 = I_rod + m_rod (U_r^2 + V_r^2) [kg m^2]
    real(dp) :: inertia_product = 0 !! m11 m22 [kg^2 m^4]
    real(dp) :: static_moment(2) = 0 !! m_rod R (U_r, V_r) [kg m^2]
    real(dp) :: crank_weight(2) = 0 !! gravity's moment on q is (1) sin q + (2) cos q [N m]
    real(dp) :: rod_weight(2) = 0   !! and on A (1) sin A - (2) cos A [N m]
    real(dp) :: per_rod_length = 0  !! 1/L [1/m]
    real(dp) :: per_piston_mass = 0 !! [1/kg]
  contains
    procedure :: coupling       !! m12 and its derivative
    procedure :: kinetic_energy
    procedure :: potential_energy
    procedure :: crank_com_acceleration
    procedure :: rod_com_acceleration
  end type mechanism_t

  interface mechanism_t
    module procedure new_mechanism
  end interface mechanism_t

  !> Positions and speeds of the three bodies at one instant.
  type :: motion_t
    real(dp) :: crank_angle      !! q [rad]
    real(dp) :: sin_crank, cos_crank
    real(dp) :: sin_rod, cos_rod !! of A; cos A > 0
    real(dp) :: crank_speed      !! dq/dt [rad/s]
    real(dp) :: rod_speed        !! dA/dt [rad/s]
    real(dp) :: piston_position  !! x of the bearing centre [m]
    real(dp) :: piston_velocity  !! [m/s]
  end type motion_t

  !> Accelerations of the three bodies.
  type :: accelerations_t
    real(dp) :: crank    !! d2q/dt2 [rad/s^2]
    real(dp) :: rod      !! d2A/dt2 [rad/s^2]
    real(dp) :: piston   !! [m/s^2]
    real(dp) :: eccentricity(2)   !! e'' = that of the pin on the rod - that of the piston [m/s^2]
  end type accelerations_t

contains

  !> The bodies with what follows from their constants. Limits: rod_length > 0, piston_mass > 0.
  pure function new_mechanism(crank_length, crank_mass, crank_inertia, crank_com, rod_length, rod_mass, rod_inertia, &
    rod_com, piston_mass, gravity) result(m)
    real(dp), intent(in) :: crank_length, crank_mass, crank_inertia, crank_com(2), rod_length, rod_mass, rod_inertia, &
      rod_com(2), piston_mass, gravity
    type(mechanism_t) :: m
    m%crank_length = crank_length
    m%crank_mass = crank_mass
    m%crank_inertia = crank_inertia
    m%crank_com = crank_com
    m%rod_length = rod_length
    m%rod_mass = rod_mass
    m%rod_inertia = rod_inertia
    m%rod_com = rod_com
    m%piston_mass = piston_mass
    m%gravity = gravity
    m%crank_term = crank_inertia + crank_mass*sum(crank_com**2) + rod_mass*crank_length**2
    m%rod_term = rod_inertia + rod_mass*sum(rod_com**2)
    m%inertia_product = m%crank_term*m%rod_term
    m%static_moment = rod_mass*crank_length*rod_com
    m%crank_weight = gravity*[crank_mass*crank_com(1) + rod_mass*crank_length, crank_mass*crank_com(2)]
    m%rod_weight = gravity*rod_mass*rod_com
    m%per_rod_length = 1/rod_length
    m%per_piston_mass = 1/piston_mass
  end function new_mechanism

  !> The crank of a motion: its angle [rad] with sine and cosine, and its speed [rad/s].
  pure subroutine turn_crank(motion, crank_angle, crank_speed)
    type(motion_t), intent(inout) :: motion
    real(dp), value, intent(in) :: crank_angle, crank_speed
    motion%crank_angle = crank_angle
    motion%sin_crank = sin(crank_angle)
    motion%cos_crank = cos(crank_angle)
    motion%crank_speed = crank_speed
  end subroutine turn_crank

  !> m12 = -m_rod R (U_r cos s + V_r sin s) and c = dm12/ds, s = q + A [kg m^2].
  pure subroutine coupling(self, motion, m12, slope)
    class(mechanism_t), intent(in) :: self
    type(motion_t), intent(in) :: motion
    real(dp), intent(out) :: m12, slope
    real(dp) :: along, across
    ! by the sines and cosines of q first, which are known before those of A
    along = self%static_moment(1)*motion%cos_crank + self%static_moment(2)*motion%sin_crank
    across = self%static_moment(1)*motion%sin_crank - self%static_moment(2)*motion%cos_crank
    m12 = across*motion%sin_rod - along*motion%cos_rod
    slope = across*motion%cos_rod + along*motion%sin_rod
  end subroutine coupling

  !> Kinetic energy of the three bodies [J].
  pure real(dp) function kinetic_energy(self, motion)
    class(mechanism_t), intent(in) :: self
    type(motion_t), intent(in) :: motion
    real(dp) :: m12, slope
    call self%coupling(motion, m12, slope)
    kinetic_energy = 0.5_dp*(self%crank_term*motion%crank_speed**2 + self%rod_term*motion%rod_speed**2 &
      + self%piston_mass*motion%piston_velocity**2) + m12*motion%crank_speed*motion%rod_speed
  end function kinetic_energy

  !> Potential energy of the three bodies in gravity, 0 at x = 0 [J].
  pure real(dp) function potential_energy(self, motion)
    class(mechanism_t), intent(in) :: self
    type(motion_t), intent(in) :: motion
    real(dp) :: crank_height, rod_height
    crank_height = self%crank_com(1)*motion%cos_crank - self%crank_com(2)*motion%sin_crank
    rod_height = self%crank_length*motion%cos_crank + self%rod_com(1)*motion%cos_rod + self%rod_com(2)*motion%sin_rod
    potential_energy = self%gravity*(self%crank_mass*crank_height + self%rod_mass*rod_height &
      + self%piston_mass*motion%piston_position)
  end function potential_energy

  !> Acceleration (x, y) of the rod's centre of mass [m/s^2].
  pure function rod_com_acceleration(self, motion, accelerations) result(a)
    class(mechanism_t), intent(in) :: self
    type(motion_t), intent(in) :: motion
    type(accelerations_t), intent(in) :: accelerations
    real(dp) :: a(2)
    a = rod_point_acceleration(self, self%rod_com, motion, accelerations)
  end function rod_com_acceleration

  !> Acceleration of the point (U, V) of the rod, at (R cos q + U cos A + V sin A, R sin q - U sin A + V cos A).
  pure function rod_point_acceleration(self, point, motion, accelerations) result(a)
    class(mechanism_t), intent(in) :: self
    real(dp), intent(in) :: point(2)
    type(motion_t), intent(in) :: motion
    type(accelerations_t), intent(in) :: accelerations
    real(dp) :: a(2), along(2), across(2), crank(2), turned(2)
    crank = self%crank_length*[motion%cos_crank, motion%sin_crank]
    turned = self%crank_length*[-motion%sin_crank, motion%cos_crank]
    along = [point(1)*motion%cos_rod + point(2)*motion%sin_rod, -point(1)*motion%sin_rod + point(2)*motion%cos_rod]
    across = [along(2), -along(1)]   ! its derivative by A
    a = turned*accelerations%crank - crank*motion%crank_speed**2 + across*accelerations%rod - along*motion%rod_speed**2
  end function rod_point_acceleration

  !> Acceleration (x, y) of the crank's centre of mass [m/s^2].
  pure function crank_com_acceleration(self, motion, accelerations) result(a)
    class(mechanism_t), intent(in) :: self
    type(motion_t), intent(in) :: motion
    type(accelerations_t), intent(in) :: accelerations
    real(dp) :: a(2), position(2)
    position = [self%crank_com(1)*motion%cos_crank - self%crank_com(2)*motion%sin_crank, &
      self%crank_com(1)*motion%sin_crank + self%crank_com(2)*motion%cos_crank]
    a = [-position(2), position(1)]*accelerations%crank - position*motion%crank_speed**2
  end function crank_com_acceleration
end module mechanism
