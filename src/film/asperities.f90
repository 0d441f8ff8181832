!> Contact of rough surfaces through a film: Greenwood and Tripp's model of paraboloids with Gaussian heights, and the mean gap that
!> is left for the oil (Patir and Cheng).
module asperities
  use kinds, only: dp
  use constants, only: pi
  use model_parameters, only: has_parameters_t, parameter_list_t
  use bearing_size, only: bearing_t
  use uniform_spline, only: spline_weights, through_values, before, after
  implicit none
  private
  public :: asperities_t, pressure_integral

  !> The pressure is p = K' E* F52(h/s), with h = c - |e| cos theta, K' = (16 sqrt(2) pi/15) (eta beta s)^2 sqrt(s/beta), and F52(H)
  !> the mean of (u - H)^(5/2) over u > H for a Gaussian u. The resultant F_a = R_b L Int p cos theta dtheta depends on |e| alone.
  type, extends(has_parameters_t) :: asperities_t
    real(dp) :: roughness = 0              !! s, combined roughness of both surfaces (root of the sum of squares) [m]
    real(dp) :: density_product = 0        !! eta beta s [-]
    real(dp) :: sharpness = 0              !! s/beta [-]
    character(len=:), allocatable :: integral   !! exact, or fit: F52 approximated by 4.4086e-5 (4 - H)^6.804
    real(dp) :: youngs_modulus(2) = 0, poissons_ratio(2) = 0   !! of pin and bearing
    real(dp) :: coefficient = 0            !! of boundary friction [-]
    real(dp) :: transition_speed = 0       !! width of its change of sign [m/s]
    type(bearing_t), private :: bearing
    logical, private :: is_fit = .false.
    real(dp), private :: scale = 0         !! K' E* R_b L [N]
    integer, private :: last = 0           !! number of the last interval of the table; 0: there is none
    real(dp), allocatable, private :: c(:) !! coefficients of the spline through the forces, by depth, in the form of `folded`
  contains
    procedure :: parameters
    procedure :: prepare
    procedure :: make_table
    procedure :: force
    procedure :: integrated_force
    procedure :: half_angle
    procedure :: pressure
    procedure :: total_pressure
    procedure :: mean_gap
    procedure :: film_gap
    procedure :: gap_curvature
    procedure :: friction_force
    procedure :: friction_slope
  end type asperities_t

  real(dp), parameter :: farthest(2) = [8.0_dp, 4.0_dp]   !! h/s above which there is no contact: exact, fit
  real(dp), parameter :: far_apart = 7                    !! h/s above which surfaces count as smooth
  real(dp), parameter :: deepest = -20                    !! smallest h/s of the table
  integer, parameter :: per_roughness = 8                 !! number of values per roughness in the table
  real(dp), parameter :: fit_power = 6.804_dp

contains

  subroutine parameters(self, list)
    class(asperities_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call list%add('roughness', self%roughness, 'combined roughness of both surfaces, the root of the sum of squares', 'm', '> 0', &
      example='0.4e-6', usual='1e-8 to 1e-5')
    call list%add('density_product', self%density_product, 'asperity density times asperity radius times roughness', &
      range='> 0 and <= 1', default='0.05', usual='0.01 to 0.1')
    call list%add('sharpness', self%sharpness, 'roughness over asperity radius', range='> 0 and <= 1', &
      default='1.0e-2', usual='1e-4 to 0.1')
    call list%word('integral', self%integral, 'exact, fit', 'exact', &
      'Greenwood-Tripp integral; fit: the common approximation (4 - h/s)^6.804')
    call list%add('youngs_modulus', self%youngs_modulus, 'Young''s moduli of pin and bearing', 'Pa', '> 0', default='207.0e9', &
      usual='1e8 to 1e12')
    call list%add('poissons_ratio', self%poissons_ratio, &
      'Poisson''s ratios of pin and bearing', range='>= 0 and <= 0.5', default='0.3', usual='0.1 to 0.5')
    call list%add('coefficient', self%coefficient, 'coefficient of boundary friction', range='>= 0 and <= 10', default='0.1', &
      usual='1e-3 to 1')
    call list%add('transition_speed', self%transition_speed, &
      'sliding speed at which friction reaches 76 % of its full value', 'm/s', &
      '> 0', default='0.01', usual='1e-6 to 1')
  end subroutine parameters

  !> Prepare for a bearing.
  subroutine prepare(self, bearing)
    class(asperities_t), intent(inout) :: self
    type(bearing_t), intent(in) :: bearing
    self%bearing = bearing
    self%is_fit = self%integral == 'fit'
    self%scale = 16*sqrt(2.0_dp)*pi/15*self%density_product**2*sqrt(self%sharpness) &
      /sum((1 - self%poissons_ratio**2)/self%youngs_modulus)*bearing%radius*bearing%length
    self%last = 0
    if (allocated(self%c)) deallocate (self%c)
  end subroutine prepare

  !> Compute the table of forces. Without it the force is integrated at every evaluation.
  subroutine make_table(self)
    class(asperities_t), intent(inout) :: self
    real(dp), allocatable :: values(:, :), coefficients(:, :)
    integer :: i, n
    n = nint((farthest_of(self) - deepest)*per_roughness) + 1
    allocate (values(n, 1))
    do i = 1, n
      values(i, 1) = folded(self, self%integrated_force(self%bearing%clearance - self%roughness*(farthest_of(self) - depth_at(i))))
    end do
    coefficients = through_values(values)
    allocate (self%c(1 - before:n + after))
    self%c = coefficients(:, 1)
    self%last = n - 1

  contains

    !> Distance of a value of the table from the limit of contact, over the roughness; the first value lies slightly inside.
    pure real(dp) function depth_at(i)
      integer, intent(in) :: i
      depth_at = (i - 1)/real(per_roughness, dp)
      if (i == 1) depth_at = 1e-3_dp/per_roughness
    end function depth_at
  end subroutine make_table

  pure real(dp) function farthest_of(self)
    type(asperities_t), intent(in) :: self
    farthest_of = merge(farthest(2), farthest(1), self%is_fit)
  end function farthest_of

  !> A force in the form that a spline interpolates best: the logarithm for the exact integral, for the fit the root that is linear
  !> at the limit of contact.
  pure real(dp) function folded(self, force)
    type(asperities_t), intent(in) :: self
    real(dp), intent(in) :: force
    if (self%is_fit) then
      folded = max(force/self%scale, 0.0_dp)**(1/(fit_power + 0.5_dp))
    else
      folded = log(max(force/self%scale, tiny(force)))
    end if
  end function folded

  !> Force that presses the pin towards the centre at the eccentricity |e| [m], from the spline [N].
  pure real(dp) function force(self, distance)
    class(asperities_t), intent(in) :: self
    real(dp), intent(in) :: distance
    real(dp) :: depth, value
    integer :: i
    force = 0
    depth = (farthest_of(self) - (self%bearing%clearance - distance)/self%roughness)*per_roughness
    if (.not. depth > 0) return   ! also if it is not a number
    i = int(depth) + 1
    if (i > self%last) then   ! also without a table
      force = self%integrated_force(distance)
      return
    end if
    value = dot_product(spline_weights(depth - (i - 1)), self%c(i - before:i + 3))
    if (self%is_fit) then
      force = self%scale*max(value, 0.0_dp)**(fit_power + 0.5_dp)
    else
      force = self%scale*exp(value)
    end if
  end function force

  !> The same force by the trapezoidal rule over the arc in contact. The integrand is even at its middle and has vanishing
  !> derivatives at its ends, so that the rule converges fast.
  pure real(dp) function integrated_force(self, distance) result(force)
    class(asperities_t), intent(in) :: self
    real(dp), intent(in) :: distance
    integer, parameter :: points = 200
    real(dp) :: last, angle
    integer :: i
    force = 0
    last = self%half_angle(distance)
    if (.not. last > 0) return
    do i = 0, points
      angle = last*i/points
      force = force + merge(0.5_dp, 1.0_dp, i == 0 .or. i == points)*cos(angle)*pressure_at(self, distance, angle)
    end do
    force = 2*self%scale*force*last/points
  end function integrated_force

  !> Half-angle of the arc on which asperities touch, at the eccentricity |e| [m]; 0 if none do.
  pure real(dp) function half_angle(self, distance)
    class(asperities_t), intent(in) :: self
    real(dp), intent(in) :: distance
    half_angle = 0
    associate (gap => self%bearing%clearance - farthest_of(self)*self%roughness)
      if (gap >= distance) return
      half_angle = pi
      if (gap > -distance) half_angle = acos(gap/distance)
    end associate
  end function half_angle

  !> Pressure times radius and length of the bore [N] at an angle from the line of centres.
  pure real(dp) function pressure(self, distance, angle)
    class(asperities_t), intent(in) :: self
    real(dp), intent(in) :: distance, angle
    pressure = self%scale*pressure_at(self, distance, angle)
  end function pressure

  !> Integral of the pressure along the arc, times radius and length of the bore, over the force; 1 without contact. By the
  !> trapezoidal rule, as the force.
  pure real(dp) function total_pressure(self, distance)
    class(asperities_t), intent(in) :: self
    real(dp), intent(in) :: distance   !! [m]
    integer, parameter :: points = 40
    real(dp) :: last, angle, values(2), here
    integer :: i
    total_pressure = 1
    last = self%half_angle(distance)
    if (.not. last > 0) return
    values = 0
    do i = 0, points
      angle = last*i/points
      here = merge(0.5_dp, 1.0_dp, i == 0 .or. i == points)*pressure_at(self, distance, angle)
      values = values + here*[1.0_dp, cos(angle)]
    end do
    if (values(2) > 0) total_pressure = values(1)/values(2)
  end function total_pressure

  !> p/(K' E*) at an angle from the line of centres.
  pure real(dp) function pressure_at(self, distance, angle)
    class(asperities_t), intent(in) :: self
    real(dp), intent(in) :: distance, angle
    pressure_at = pressure_integral((self%bearing%clearance - distance + 2*distance*sin(0.5_dp*angle)**2)/self%roughness, &
      self%is_fit)
  end function pressure_at

  !> F52(H): the exact integral by a Chebyshev series of its logarithm, within 7e-7 between -4 and 8, and by its asymptotic series
  !> below -4; or the fit.
  pure real(dp) function pressure_integral(h, is_fit) result(f)
    real(dp), intent(in) :: h   !! H = h/s
    logical, intent(in) :: is_fit
    real(dp), parameter :: series(0:16) = [-11.61231074891603_dp, -20.617452832288585_dp, -6.2634546415843744_dp, &
      -0.73646689340233418_dp, 0.11947790516206643_dp, 0.0087308609636478785_dp, &
      -0.011751921480713065_dp, 0.0023312950554783981_dp, 0.00076238873116151601_dp, &
      -0.00056371973327111588_dp, 7.1620434114969174e-05_dp, 6.5262407002420522e-05_dp, &
      -3.4923242743502115e-05_dp, 1.3368426203381316e-06_dp, 5.710616981672648e-06_dp, &
      -2.3828726060054943e-06_dp, -1.5139969508450551e-07_dp]
    real(dp) :: x, b(0:2)
    integer :: k
    if (is_fit) then
      f = 4.4086e-5_dp*max(4 - h, 0.0_dp)**fit_power
    else if (h >= 8) then
      f = 0
    else if (h < -4) then
      x = 1/h**2   ! asymptotic series of the mean of (u - H)^(5/2) for a Gaussian u
      f = (-h)**2.5_dp*(1 + x*(1.875_dp + x*(-0.1171875_dp + x*(-0.0732421875_dp - x*0.144195556640625_dp))))
    else
      x = (h - 2)/6
      b = 0
      do k = 16, 1, -1
        b(2) = b(1)
        b(1) = b(0)
        b(0) = 2*x*b(1) - b(2) + series(k)
      end do
      f = exp(x*b(0) - b(1) + series(0))
    end if
  end function pressure_integral

  !> Mean gap of the surfaces if the smooth surfaces are h apart, h/2 (1 + erf(h/(sqrt2 s))) + s/sqrt(2 pi) exp(-h^2/(2 s^2)) > 0
  !> [m], and its derivative with respect to h.
  pure subroutine mean_gap(self, h, gap, slope)
    class(asperities_t), intent(in) :: self
    real(dp), intent(in) :: h   !! [m]
    real(dp), intent(out) :: gap, slope
    real(dp) :: x
    x = h/self%roughness
    slope = 0.5_dp*erfc(-x/sqrt(2.0_dp))
    gap = h*slope + self%roughness/sqrt(2*pi)*exp(-0.5_dp*x**2)
  end subroutine mean_gap

  !> The same, h and 1 where the surfaces are so far apart that this has an error of 1e-12.
  pure subroutine film_gap(self, h, gap, slope)
    class(asperities_t), intent(in) :: self
    real(dp), intent(in) :: h   !! [m]
    real(dp), intent(out) :: gap, slope
    if (h > far_apart*self%roughness) then
      gap = h
      slope = 1
    else
      call self%mean_gap(h, gap, slope)
    end if
  end subroutine film_gap

  !> Second derivative of the mean gap [1/m].
  pure real(dp) function gap_curvature(self, h) result(curvature)
    class(asperities_t), intent(in) :: self
    real(dp), intent(in) :: h   !! [m]
    curvature = exp(-0.5_dp*(h/self%roughness)**2)/(sqrt(2*pi)*self%roughness)
  end function gap_curvature

  !> Boundary friction at a sliding speed [m/s] under a normal force of the asperities [N].
  pure real(dp) function friction_force(self, sliding_speed, pressing)
    class(asperities_t), intent(in) :: self
    real(dp), intent(in) :: sliding_speed, pressing
    friction_force = -self%coefficient*pressing*tanh(sliding_speed/self%transition_speed)
  end function friction_force

  !> Its derivative by the speed [N s/m].
  pure real(dp) function friction_slope(self, sliding_speed, pressing)
    class(asperities_t), intent(in) :: self
    real(dp), intent(in) :: sliding_speed, pressing
    friction_slope = -self%coefficient*pressing*(1 - tanh(sliding_speed/self%transition_speed)**2)/self%transition_speed
  end function friction_slope
end module asperities
