!> The Pinkus-Sternlicht film (5.10-5.37): a long bearing in which only the positive pressures act.
module pinkus_sternlicht
  use kinds, only: dp
  use constants, only: pi
  use model_parameters, only: parameter_list_t
  use bearing_size, only: bearing_t
  use film_law, only: film_law_t, film_motion_t, difference_derivatives, yes
  use film_direction, only: derivatives_in_components, least_ratio_of_derivatives
  implicit none
  private
  public :: pinkus_sternlicht_t, max_eccentricity_ratio

  !> Largest eccentricity ratio that is evaluated. The force has no bound at 1, which a run never reaches. For a state at or beyond
  !> 1 the force of this ratio is used, which is finite.
  real(dp), parameter :: max_eccentricity_ratio = 1 - epsilon(1.0_dp)

  !> A motion in the variables of the film equations.
  type :: reduced_motion_t
    real(dp) :: normal(2)    !! n, unit vector along the eccentricity; arbitrary if the pin is concentric
    real(dp) :: ratio        !! eps = |e|/c, at most `max_eccentricity_ratio`
    real(dp) :: ratio_rate   !! eps_dot [1/s]
    real(dp) :: wedge        !! eps W = eps (omega - 2 gamma_dot) [rad/s]
  end type reduced_motion_t

  !> The closed form of the force (5.34-5.37).
  type, extends(film_law_t) :: pinkus_sternlicht_t
    character(len=:), allocatable :: variant   !! closed_form, as_printed, or half_film for half_film_t
    real(dp) :: pressure_scale = 0   !! mu R^2/c^2 [Pa s], R of the pin
    real(dp) :: withdrawal_sign = 1  !! factor of the radial force for eps_dot < 0: 1 corrected, -1 as printed
  contains
    procedure :: parameters
    procedure :: prepare
    procedure :: film_force
    procedure :: force_derivatives
    procedure :: is_quasi_static
    procedure, nopass :: gives_pressure => yes
    procedure, nopass :: is_of_long_bearings => yes
    procedure :: pressure
    procedure :: peak_and_flow
  end type pinkus_sternlicht_t

contains

  subroutine parameters(self, list)
    class(pinkus_sternlicht_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call list%word('variant', self%variant, 'closed_form, as_printed, half_film', 'closed_form', &
      'form of the film force', example='closed_form')
    call self%add_viscosity(list)
    call list%add('film_moment', self%film_moment, &
      'the oil shear acts on the pin with a moment; default .true. for finite_bearing, else .false.', &
      '.false.', example='.false.')
    call self%add_least_film(list)
  end subroutine parameters

  !> True for all variants except `as_printed`, whose misprint makes the film push a pin that moves away from the wall.
  pure logical function is_quasi_static(self)
    class(pinkus_sternlicht_t), intent(in) :: self
    is_quasi_static = .true.
    if (allocated(self%variant)) is_quasi_static = self%variant /= 'as_printed'
  end function is_quasi_static

  !> Set the scales of pressure and force, and the sign of (5.36), which is misprinted in the variant `as_printed`.
  subroutine prepare(self, bearing, tolerance)
    class(pinkus_sternlicht_t), intent(inout) :: self
    type(bearing_t), intent(in) :: bearing
    real(dp), intent(in) :: tolerance
    self%clearance = bearing%clearance
    self%per_clearance = 1/bearing%clearance
    self%pressure_scale = self%viscosity*(bearing%pin_radius()/bearing%clearance)**2
    self%force_scale = self%pressure_scale*bearing%length*bearing%pin_radius()
    self%withdrawal_sign = 1
    if (allocated(self%variant)) then
      if (self%variant == 'as_printed') self%withdrawal_sign = -1
    end if
  end subroutine prepare

  !> The motion in polar coordinates. If the pin is concentric, the direction of the eccentricity is set to that of x.
  pure subroutine reduce(per_clearance, motion, state)
    real(dp), intent(in) :: per_clearance   !! [1/m]
    type(film_motion_t), intent(in) :: motion
    type(reduced_motion_t), intent(out) :: state
    real(dp), parameter :: centred = 1e-200_dp   !! below this square the components' squares lose digits
    real(dp) :: square, eccentricity, per_eccentricity
    associate (e => motion%eccentricity, v => motion%eccentricity_rate, n => state%normal)
      square = e(1)**2 + e(2)**2
      n(1) = 1
      n(2) = 0
      state%ratio = 0
      if (square > centred) then
        eccentricity = sqrt(square)
        per_eccentricity = 1/eccentricity
        n(1) = e(1)*per_eccentricity
        n(2) = e(2)*per_eccentricity
        state%ratio = min(eccentricity*per_clearance, max_eccentricity_ratio)
      end if
      state%ratio_rate = (n(1)*v(1) + n(2)*v(2))*per_clearance
      state%wedge = state%ratio*motion%pin_speed - 2*(n(1)*v(2) - n(2)*v(1))*per_clearance
    end associate
  end subroutine reduce

  !> Force (5.34-5.37), (5.36) with its sign corrected unless the variant is `as_printed`. With S = sqrt((1-eps^2)((eps W)^2 + 4
  !> eps_dot^2)), |eps_dot| k eps = S/2 and both quotients of k are (S + 6 eps max(eps_dot, 0))/(S + 3 eps |eps_dot|), so that no
  !> term is singular at eps = 0 or eps_dot = 0. The theory gives the pressure only; the moment is that of `shear_moment`, if
  !> `film_moment` is set.
  pure subroutine film_force(self, motion, force, moment)
    class(pinkus_sternlicht_t), intent(in) :: self
    type(film_motion_t), intent(in) :: motion
    real(dp), intent(out) :: force(2)
    real(dp), intent(out) :: moment
    type(reduced_motion_t) :: state
    real(dp) :: gap, root, s, squeeze, denominator, quotient, scale, radial, tangential
    call reduce(self%per_clearance, motion, state)
    moment = 0
    associate (eps => state%ratio, eps_dot => state%ratio_rate, n => state%normal)
      gap = (1 - eps)*(1 + eps)
      root = sqrt(gap)
      s = root*sqrt(state%wedge**2 + 4*eps_dot**2)
      squeeze = 3*eps*abs(eps_dot)
      denominator = s + squeeze
      quotient = 1
      if (denominator > 0) quotient = (s + squeeze + sign(squeeze, eps_dot))/denominator
      scale = 6*self%force_scale/((2 + eps**2)*root*gap)
      radial = -scale*(2*eps*s + (2 + eps**2)*pi*eps_dot*quotient)
      if (eps_dot < 0) radial = self%withdrawal_sign*radial
      tangential = scale*gap*pi*state%wedge*quotient
      force(1) = radial*n(1) - tangential*n(2)
      force(2) = radial*n(2) + tangential*n(1)
    end associate
    if (self%film_moment) moment = self%shear_moment(motion, force)
  end subroutine film_force

  !> Derivatives of `film_force`, for implicit integration (see `difference_derivatives`): those of the polar components with
  !> respect to (eps, eps_dot, eps W), eps W = -2 T, transformed to x and y. Central differences are used close to the centre, where
  !> the direction of the eccentricity changes rapidly.
  pure subroutine force_derivatives(self, motion, derivatives)
    class(pinkus_sternlicht_t), intent(in) :: self
    type(film_motion_t), intent(in) :: motion
    real(dp), intent(out) :: derivatives(3, 5)
    type(reduced_motion_t) :: state
    real(dp) :: radial(0:3), tangential(0:3)
    logical :: moves

    call reduce(self%per_clearance, motion, state)
    call polar_forces(self, state, radial, tangential, moves)
    if (state%ratio < least_ratio_of_derivatives .or. .not. moves) then
      call difference_derivatives(self, motion, derivatives)
      return
    end if
    radial(3) = -2*radial(3)
    tangential(3) = -2*tangential(3)
    derivatives = derivatives_in_components(self, motion, state%normal, state%ratio, state%ratio_rate, radial, tangential)
  end subroutine force_derivatives

  !> Radial and tangential force (element 0) and their derivatives with respect to eps, eps_dot and eps W (elements 1 to 3). At rest
  !> `moves` is .false. and there are no derivatives.
  pure subroutine polar_forces(self, state, radial, tangential, moves)
    class(pinkus_sternlicht_t), intent(in) :: self
    type(reduced_motion_t), intent(in) :: state
    real(dp), intent(out) :: radial(0:3), tangential(0:3)
    logical, intent(out) :: moves
    real(dp) :: gap, s(0:3), squeeze(0:3), numerator(0:3), quotient(0:3), scale(0:1), bracket(0:3), two_plus, way

    associate (eps => state%ratio, rate => state%ratio_rate, wedge => state%wedge)
      gap = (1 - eps)*(1 + eps)
      two_plus = 2 + eps**2
      way = sign(1.0_dp, rate)
      s(0) = sqrt(gap*(wedge**2 + 4*rate**2))
      radial = 0
      tangential = 0
      moves = s(0) > 0
      if (.not. moves) return
      s(1:) = [-eps*s(0)/gap, 4*gap*rate/s(0), gap*wedge/s(0)]
      squeeze = [3*eps*abs(rate), 3*abs(rate), 3*eps*way, 0.0_dp]
      numerator = s + (1 + way)*squeeze
      quotient(0) = numerator(0)/(s(0) + squeeze(0))
      quotient(1:) = (numerator(1:) - quotient(0)*(s(1:) + squeeze(1:)))/(s(0) + squeeze(0))
      scale(0) = 6*self%force_scale/(two_plus*gap*sqrt(gap))
      scale(1) = scale(0)*(3*eps/gap - 2*eps/two_plus)
      bracket = 2*eps*s + two_plus*pi*rate*quotient
      bracket(1) = bracket(1) + 2*s(0) + 2*eps*pi*rate*quotient(0)
      bracket(2) = bracket(2) + two_plus*pi*quotient(0)
      radial = -scale(0)*bracket
      radial(1) = radial(1) - scale(1)*bracket(0)
      if (rate < 0) radial = self%withdrawal_sign*radial
      tangential = scale(0)*gap*pi*wedge*quotient
      tangential(1) = tangential(1) + pi*wedge*quotient(0)*(scale(1)*gap - 2*eps*scale(0))
      tangential(3) = tangential(3) + scale(0)*gap*pi*quotient(0)
    end associate
  end subroutine polar_forces

  !> Pressure of the film [Pa] (5.20), 0 where it would be negative, at the angle theta [rad] from the thinnest film (the direction
  !> of the eccentricity), positive from x to y:
  !> p = 6 mu (R/c)^2 { W eps sin a (2 + eps cos a)/((2 + eps^2) u^2) + eps_dot/eps [1/u^2 - 2/(2 + eps^2)] } with
  !> a = theta + pi and u = 1 + eps cos a = h/c, written without the division by eps.
  pure function pressure(self, motion, theta)
    class(pinkus_sternlicht_t), intent(in) :: self
    type(film_motion_t), intent(in) :: motion
    real(dp), intent(in) :: theta
    real(dp) :: pressure
    type(reduced_motion_t) :: state
    real(dp) :: c, s, bracket
    call reduce(self%per_clearance, motion, state)
    c = -cos(theta)
    s = -sin(theta)
    associate (eps => state%ratio)
      bracket = state%wedge*s*(2 + eps*c) - state%ratio_rate*(4*c + eps*(2*c**2 - 1))
      pressure = max(0.0_dp, 6*self%pressure_scale*bracket/((2 + eps**2)*(1 + eps*c)**2))
    end associate
  end function pressure

  !> Largest pressure [Pa] of (5.20); a long film has no side flow. By the Reynolds equation u^3 dp/da is proportional to
  !> eps W (cos a + 3 eps/(2 + eps^2)) + 2 eps_dot sin a; the pressure is largest where this falls through 0.
  pure subroutine peak_and_flow(self, motion, most, flow)
    class(pinkus_sternlicht_t), intent(in) :: self
    type(film_motion_t), intent(in) :: motion
    real(dp), intent(out) :: most, flow
    type(reduced_motion_t) :: state
    real(dp) :: strength
    most = 0
    flow = 0
    call reduce(self%per_clearance, motion, state)
    associate (eps => state%ratio, rate => state%ratio_rate, wedge => state%wedge)
      strength = sqrt(wedge**2 + 4*rate**2)
      if (strength > 0) most = self%pressure(motion, atan2(2*rate, wedge) &
        + acos(max(-1.0_dp, min(1.0_dp, -3*eps*wedge/((2 + eps**2)*strength)))) - pi)
    end associate
  end subroutine peak_and_flow
end module pinkus_sternlicht
