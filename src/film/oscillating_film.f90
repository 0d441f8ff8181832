!> The oscillating film (5.1-5.9, after Gandara 2006 and Bannwart et al. 2010): a long bearing with a full film, wedge effect and
!> fluid inertia, without squeeze effect. The speed of the pin's surface is the real part of a phasor U that rotates with the crank
!> frequency w. The film carries no load along the line of centres: it has only a tangential force, and the moment of the shear.
!> Without squeeze it does not resist motions of the pin's centre: where the centre moves along the film faster than half of the
!> pin's surface, the film supplies energy to the bodies instead of dissipating it.
module oscillating_film
  use kinds, only: dp
  use constants, only: pi, two_pi
  use model_parameters, only: parameter_list_t
  use bearing_size, only: bearing_t
  use film_law, only: film_law_t, film_motion_t
  use oscillating_response, only: oscillating_response_t, film_phasors_t, new_oscillating_response, max_eccentricity_ratio
  implicit none
  private
  public :: oscillating_film_t

  !> Allowed error of means over the film, relative to the tolerance of the run, and its largest value.
  real(dp), parameter :: mean_margin = 1e-4_dp
  real(dp), parameter :: coarsest_mean = 1e-8_dp

  type, extends(film_law_t) :: oscillating_film_t
    character(len=:), allocatable :: variant   !! bearing_frame or as_printed
    integer :: quadrature_points = 0      !! number of points around the film; 0: chosen from the tolerance
    type(oscillating_response_t) :: response = oscillating_response_t()
    real(dp) :: pin_radius = 0            !! R [m]
    real(dp) :: inertia_scale = 0         !! c^2/(4 nu), the ratio of Q to the frequency [s]
    real(dp) :: largest_ratio = 1  !! eccentricity ratio beyond which the film does not change: the film between real surfaces is at
                                   !! least as thick as their roughness, while the theoretical force grows without bound
    real(dp) :: speed_scale = 0           !! mu w_b R/c [Pa s]
    real(dp) :: arm_length = 0            !! L of (5.4), the rod length [m], if the acceleration term is included; otherwise 0
  contains
    procedure :: parameters
    procedure :: prepare
    procedure :: film_force
    procedure, non_overridable :: surface_speed
  end type oscillating_film_t

contains

  subroutine parameters(self, list)
    class(oscillating_film_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call list%word('variant', self%variant, 'bearing_frame, as_printed', 'bearing_frame', &
      'form of the film force')
    call self%add_viscosity(list)
    call list%add('kinematic_viscosity', self%kinematic_viscosity, &
      'kinematic viscosity; required unless viscosity_law gives it', 'm^2/s', '> 0', default='0.0', example='1.38e-5', &
      usual='1e-7 to 1e-3')
    call list%add('quadrature_points', self%quadrature_points, &
      'points of the integral round the film; 0: chosen from the tolerance', '>= 4 and <= 1000000', &
      default='0')
    call self%add_least_film(list)
  end subroutine parameters

  !> Set the scales, and prepare the response of the film with means more accurate than the tolerance of the run by `mean_margin`.
  !> The variant `as_printed` has the acceleration terms of (5.4), with the rod length as L.
  subroutine prepare(self, bearing, tolerance)
    class(oscillating_film_t), intent(inout) :: self
    type(bearing_t), intent(in) :: bearing
    real(dp), intent(in) :: tolerance
    logical :: as_printed
    as_printed = .false.
    if (allocated(self%variant)) as_printed = self%variant == 'as_printed'
    self%needs_ideal_motion = .true.
    self%singular_at_wall = .false.
    self%clearance = bearing%clearance
    self%per_clearance = 1/bearing%clearance
    self%pin_radius = bearing%pin_radius()
    self%inertia_scale = bearing%clearance**2/(4*self%kinematic_viscosity)
    self%speed_scale = self%viscosity*bearing%length*self%pin_radius/bearing%clearance
    self%arm_length = 0
    if (as_printed) self%arm_length = bearing%rod_length
    self%largest_ratio = 1 - self%least_film_ratio
    call new_oscillating_response(self%response, min(max(mean_margin*tolerance, epsilon(1.0_dp)), coarsest_mean), &
      self%quadrature_points, as_printed)
  end subroutine prepare

  !> Surface speed of the pin as a phasor [m/s]: Re U = R omega and Re(i w U) = R omegadot of the mechanism with ideal joints.
  !> Without oscillation it is R omega.
  pure complex(dp) function surface_speed(self, motion) result(speed)
    class(oscillating_film_t), intent(in) :: self
    type(film_motion_t), intent(in) :: motion
    real(dp), parameter :: slowest = 1e-300_dp   !! smallest frequency with a finite reciprocal
    real(dp) :: lag
    lag = 0
    ! the reciprocal is computed independently of the acceleration
    if (motion%frequency > slowest) lag = motion%ideal_pin_acceleration*(1/motion%frequency)
    speed = cmplx(self%pin_radius*motion%ideal_pin_speed, -self%pin_radius*lag, dp)
  end function surface_speed

  !> f_t = mu w_b R/c Re{U [Int t* cos th - (R/c) Int P* sin th]}, f_r = 0, moment mu w_b R^2/c Re{U Int t*}. The velocity of the
  !> pin's centre and its actual rotation have no influence. If `arm_length` is not 0, the first acceleration term of (5.4), a
  !> pressure -rho w L U cos th, adds f_r = pi w_b R rho w L Re U.
  pure subroutine film_force(self, motion, force, moment)
    class(oscillating_film_t), intent(in) :: self
    type(film_motion_t), intent(in) :: motion
    real(dp), intent(out) :: force(2)
    real(dp), intent(out) :: moment
    type(film_phasors_t) :: response
    complex(dp) :: speed
    real(dp) :: e(2), n(2), square, held, scale, along, across, lever, tangential, radial

    e = motion%eccentricity*self%per_clearance
    square = e(1)**2 + e(2)**2
    held = min(self%largest_ratio, max_eccentricity_ratio)
    if (square > held**2) then
      e = e*(held/sqrt(square))
      square = held**2
    end if
    call self%response%respond(square, 1 - square, self%inertia_scale*motion%frequency, response)
    speed = self%surface_speed(motion)
    scale = two_pi*self%speed_scale
    along = scale*real(speed)
    across = scale*aimag(speed)
    lever = self%pin_radius*self%per_clearance
    tangential = along*(real(response%shear) - lever*real(response%pressure)) &
      - across*(aimag(response%shear) - lever*aimag(response%pressure))   ! divided by eps
    moment = self%pin_radius*(along*real(response%moment) - across*aimag(response%moment))
    force(1) = -tangential*e(2)
    force(2) = tangential*e(1)
    if (self%arm_length > 0) then
      radial = pi*self%speed_scale*self%clearance/self%kinematic_viscosity*motion%frequency*self%arm_length*real(speed)
      n(1) = 1   ! a centred pin has no direction; x is used
      n(2) = 0
      if (square > 0) n = e*(1/sqrt(square))
      force(1) = force(1) + radial*n(1)
      force(2) = force(2) + radial*n(2)
    end if
  end subroutine film_force
end module oscillating_film
