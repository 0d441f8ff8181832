!> The oscillating film (5.1-5.9) in dimensionless form: complex pressure and wall shear for a pin whose surface oscillates with
!> unit speed.
!>
!> The flow obeys i w V = -(dP/dth)/(rho R) + nu V'', with V = U at the pin and 0 at the bearing, and is equal in every cross
!> section. With h = c eta, eta = 1 - eps cos th, Q = c^2 w/(4 nu), u^2 = i Q eta^2, t = tanh(u)/u and B = u^2 t/(1 - t), the
!> solution in a form without the cancellation of the printed h lambda - 2T is
!>
!>     P*' = 2 [eta B - K (B + u^2)]/eta^3,   K = <B/eta^2>/<(B + u^2)/eta^3>,   P* = P c^2/(mu U R)
!>     t*  = -[1 + B + u^2/B]/eta + K B/eta^2,   t* = mu dV/dy c/(mu U) at the pin
!>
!> where <> is the mean over th; the choice of K makes P periodic. Corrections to the print: (5.1) lacks i under its roots, (5.4) a
!> factor R, (5.5) has nu instead of i and c/2 instead of h/2.
!>
!> B = 3 + u^2/5 - u^4/175 + ... is even in eta and smooth near the wall. After separating powers of 1/eta, which have means in
!> closed form, the smooth remainder is expanded into a power series in Q (inertia_series); for larger Q it is summed over points,
!> whose number does not depend on the eccentricity. P*' and t* are even in th: pressure and shear have no resultant along the line
!> of centres, and half of the circle is sufficient.
module oscillating_response
  use kinds, only: dp
  use constants, only: pi
  use inertia_series, only: inertia_series_t, remainder_t, new_inertia_series
  implicit none
  private
  public :: oscillating_response_t, film_phasors_t, new_oscillating_response, inertia_function, max_eccentricity_ratio

  !> The response grows as (1-eps)^-1/2. Beyond this eccentricity ratio, and beyond the wall, it is constant, so that it is finite
  !> until the contact begins.
  real(dp), parameter :: max_eccentricity_ratio = 1 - 1e-6_dp

  !> Numbers of points of the rules on half of the circle.
  integer, parameter :: rule_points(*) = [2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64, 96, 128, 256, 512, 1024]

  !> Series of (B - 3)/u^2 in u^2, and the largest |u^2| for which it is used.
  real(dp), parameter :: b(0:8) = [1/5.0_dp, -1/175.0_dp, 2/7875.0_dp, -37/3031875.0_dp, 118/197071875.0_dp, &
    -5506/186232921875.0_dp, 3308/2261399765625.0_dp, -8386459/115794974998828125.0_dp, 56067454/15632321624841796875.0_dp]
  real(dp), parameter :: series_limit = 0.5_dp

  !> One rule of summation.
  type :: rule_t
    real(dp) :: limit = huge(1.0_dp)      !! largest Q for which the rule is used
    real(dp), allocatable :: cosines(:)   !! of the points, th = pi (j - 1/2)/n
  end type rule_t

  !> The response at one position.
  type :: film_phasors_t
    complex(dp) :: pressure   !! Int P* sin th dth over 2 pi eps
    complex(dp) :: shear      !! Int t* cos th dth over 2 pi eps
    complex(dp) :: moment     !! Int t* dth over 2 pi
    complex(dp) :: flow       !! K
  end type film_phasors_t

  type :: oscillating_response_t
    logical :: as_printed = .false.       !! with the second acceleration term of (5.4), which subtracts 4iQ from P*'
    type(inertia_series_t) :: series = inertia_series_t()   !! for small Q
    type(rule_t), allocatable :: rule(:)  !! for larger Q; the rule with the fewest points first
  contains
    procedure, non_overridable :: respond
  end type oscillating_response_t

contains

  !> Prepare the response. `accuracy` is the allowed relative error of series and sums, between 0 and 1; if `points` > 0, sums over
  !> that number of points on the whole circle are used instead.
  pure subroutine new_oscillating_response(response, accuracy, points, as_printed)
    type(oscillating_response_t), intent(out) :: response
    real(dp), intent(in) :: accuracy
    integer, intent(in) :: points
    logical, intent(in) :: as_printed
    integer :: i, n
    response%as_printed = as_printed
    if (points == 0) call new_inertia_series(response%series, accuracy)
    allocate (response%rule(merge(1, size(rule_points), points > 0)))
    do i = 1, size(response%rule)
      n = rule_points(i)
      if (points > 0) n = (points + 1)/2
      response%rule(i)%cosines = midpoint_cosines(n)
      if (i < size(response%rule)) response%rule(i)%limit = served_inertia(n, accuracy)
    end do
  end subroutine new_oscillating_response

  pure function midpoint_cosines(n) result(cosines)
    integer, intent(in) :: n
    real(dp) :: cosines(n)
    integer :: j
    cosines = [(cos(pi*(2*j - 1)/(2*n)), j=1, n)]
  end function midpoint_cosines

  !> Largest Q at which the midpoint rule with n points on half of the circle reaches the accuracy. Its error is less than 10
  !> r^(-2n), where r + 1/r is the sum of the distances of the integrand's nearest pole from the ends of the range of eta, divided
  !> by half of that range. The worst range is 0 to 2, at eps = 1; the nearest pole is at B = 0, u^2 = -pi^2, or eta = d sqrt(i)
  !> with d = pi/sqrt(Q). Hence r + 1/r = d + |2 - d sqrt(i)|, which is solved for d.
  pure real(dp) function served_inertia(n, accuracy) result(q)
    integer, intent(in) :: n
    real(dp), intent(in) :: accuracy
    real(dp) :: r, total
    r = (accuracy/10)**(-0.5_dp/n)
    total = r + 1/r
    q = (pi*(2*total - sqrt(8.0_dp))/((total - 2)*(total + 2)))**2
  end function served_inertia

  !> The response at an eccentricity ratio and Q, with pressure and shear divided by 2 pi eps and the moment by 2 pi, so that the
  !> square root eps is not needed. The closed means of 1/eta, 1/eta^2, 1/eta^3 and of their products with cos th are multiplied out
  !> with the remainders, so that nothing cancels as eps -> 1.
  pure subroutine respond(self, square, gap, q, phasors)
    class(oscillating_response_t), intent(in) :: self
    real(dp), value, intent(in) :: square, gap   !! eps^2 and 1 - eps^2, both >= 0, gap not 0
    real(dp), value, intent(in) :: q             !! Q >= 0
    type(film_phasors_t), intent(out) :: phasors
    type(remainder_t) :: rest
    complex(dp) :: driven, scale, part, pressure, shear, moment
    real(dp) :: s, gap2, per_s, per_sum, first
    if (q <= self%series%limit) then
      call self%series%remainders(gap, q, rest)
    else
      call sum_remainders(self, sqrt(square), q, rest)
    end if
    s = sqrt(gap)
    per_s = 1/(s + gap)
    per_sum = s*per_s   ! 1/(1 + s)
    per_s = per_s + per_sum
    gap2 = gap**2
    first = (1 + b(0))*q   ! of n2 and c3 times <1/eta> = 1/s and <cos th/eta> = eps/(s (1 + s))
    driven = rest%n1
    if (self%as_printed) driven = driven - cmplx(0.0_dp, 2*q, dp)
    ! real times complex by parts, since the compiler would also multiply by the imaginary part 0; s^5 is s times gap^2, which does
    ! not depend on the square root
    scale = reciprocal(cmplx(3 + 1.5_dp*square + s*(gap2*real(rest%n2)), first*gap2 + s*(gap2*aimag(rest%n2)), dp))
    part = cmplx(3 + s*(gap*real(driven)), s*(gap*aimag(driven)), dp)*scale
    pressure = scale*(cmplx(3*gap*(real(rest%n2) - real(rest%c3)) - 4.5_dp*per_s, &
      3*gap*(aimag(rest%n2) - aimag(rest%c3) + first*per_sum), dp) &
      - driven*cmplx(4.5_dp + s*(gap2*real(rest%c3)), s*(gap2*aimag(rest%c3)) + first*gap2*per_sum, dp))
    shear = part*cmplx(3*per_s + gap*real(rest%c2), gap*aimag(rest%c2), dp)
    moment = part*cmplx(3*per_s + gap*real(rest%n1), gap*aimag(rest%n1), dp)
    phasors%flow = cmplx(gap*real(part), gap*aimag(part), dp)
    phasors%pressure = cmplx(2*(real(pressure) + real(rest%c2)), 2*(aimag(pressure) + aimag(rest%c2)), dp)
    phasors%shear = cmplx(real(shear) - (real(rest%mc) + 4*(per_s - per_sum)), aimag(shear) - aimag(rest%mc), dp)
    phasors%moment = cmplx(real(moment) - (real(rest%m1) + 4*per_s), aimag(moment) - aimag(rest%m1), dp)
  end subroutine respond

  !> The remainders by the rule with the fewest points that is sufficient. At eps = 0 those with cos th over eps cannot be computed
  !> by sums and are left out, since nothing depends on them there.
  pure subroutine sum_remainders(self, eps, q, rest)
    type(oscillating_response_t), intent(in) :: self
    real(dp), intent(in) :: eps
    real(dp), intent(in) :: q   !! Q
    type(remainder_t), intent(out) :: rest
    complex(dp) :: first, second, shear, iq
    real(dp) :: eta, v, per_eps
    integer :: i, j
    do i = 1, size(self%rule) - 1
      if (q <= self%rule(i)%limit) exit
    end do
    rest = remainder_t((0, 0), (0, 0), (0, 0), (0, 0), (0, 0), (0, 0))
    associate (cosines => self%rule(i)%cosines)
      do j = 1, size(cosines)
        eta = 1 - eps*cosines(j)
        v = q*eta**2
        second = second_remainder(v)
        first = cmplx(b(0) - v*aimag(second), v*real(second), dp)
        shear = eta*(first + reciprocal(cmplx(3 - v*aimag(first), v*real(first), dp)))
        second = eta*second
        rest%n1 = rest%n1 + first
        rest%c2 = rest%c2 + cosines(j)*first
        rest%n2 = rest%n2 + second
        rest%c3 = rest%c3 + cosines(j)*second
        rest%m1 = rest%m1 + shear
        rest%mc = rest%mc + cosines(j)*shear
      end do
      iq = cmplx(0.0_dp, q/size(cosines), dp)
    end associate
    per_eps = 0
    if (eps > 1e-30_dp) per_eps = 1/eps
    rest%n1 = iq*rest%n1
    rest%c2 = iq*rest%c2*per_eps
    rest%m1 = iq*rest%m1
    rest%mc = iq*rest%mc*per_eps
    rest%n2 = cmplx(0.0_dp, q, dp)*iq*rest%n2
    rest%c3 = cmplx(0.0_dp, q, dp)*iq*rest%c3*per_eps
  end subroutine sum_remainders

  !> (B - 3 - u^2/5)/u^4 for u^2 = i v, v >= 0: by its series, or from T = tanh(u), where real and imaginary part of u are equal.
  pure complex(dp) function second_remainder(v) result(remainder)
    real(dp), intent(in) :: v
    complex(dp) :: u, tangent
    real(dp) :: w, root, decay
    if (v <= series_limit) then
      w = -v**2
      remainder = cmplx(b(1) + w*(b(3) + w*(b(5) + w*b(7))), v*(b(2) + w*(b(4) + w*(b(6) + w*b(8)))), dp)
    else
      root = sqrt(2*v)
      decay = exp(-root)
      u = cmplx(root/2, root/2, dp)
      tangent = cmplx(1 - decay**2, 2*decay*sin(root), dp)/(1 + decay**2 + 2*decay*cos(root))
      remainder = ((u**2*tangent/(u - tangent) - 3)/u**2 - b(0))/u**2
    end if
  end function second_remainder

  !> B at u^2 = i v.
  elemental function inertia_function(v)
    real(dp), intent(in) :: v   !! Q eta^2, >= 0
    complex(dp) :: inertia_function
    complex(dp) :: u_squared
    u_squared = cmplx(0.0_dp, v, dp)
    inertia_function = 3 + u_squared*(b(0) + u_squared*second_remainder(v))
  end function inertia_function

  pure function reciprocal(z)
    complex(dp), intent(in) :: z
    complex(dp) :: reciprocal
    real(dp) :: per_square
    per_square = 1/(real(z)**2 + aimag(z)**2)
    reciprocal = cmplx(real(z)*per_square, -aimag(z)*per_square, dp)
  end function reciprocal
end module oscillating_response
