!> How the pressure of a film deforms the bore of its bearing: a round elastic ring in closed form, or a table of compliances.
!>
!> The radius of the bore grows by delta(theta) = sum of a_k s_k(theta) over the shapes s_k = 1, cos 2 theta, sin 2 theta,
!> cos 3 theta, ... The amplitudes follow those of the pressure p averaged over the length of the bearing, p = sum of p_k s_k + ...:
!> a = C p. The first harmonic is left out, since it shifts the bore as a whole: the eccentricity of the pin is measured from the
!> middle of the deformed bore. The outside of the ring is free, its pin is rigid.
module ring_compliance
  use kinds, only: dp
  use error_handling, only: error_t, fail, status_case_file
  use small_lu, only: decompose, solve
  implicit none
  private
  public :: elastic_bore_t, new_ring, new_compliance, ring_compliance_of, shape_value, shape_slope, most_modes

  integer, parameter :: most_modes = 32   !! largest harmonic of a shape

  !> An elastic bore; without shapes it is rigid.
  type :: elastic_bore_t
    integer, allocatable :: harmonic(:)         !! n of each shape: 0, 2, 3, ...
    logical, allocatable :: is_sine(:)          !! the shape is sin n theta instead of cos n theta
    real(dp), allocatable :: compliance(:, :)   !! C: amplitude of a shape (row) for one of the pressure (column) [m/Pa]
  contains
    procedure :: shapes
  end type elastic_bore_t

contains

  !> Number of shapes.
  pure integer function shapes(self)
    class(elastic_bore_t), intent(in) :: self
    shapes = 0
    if (allocated(self%harmonic)) shapes = size(self%harmonic)
  end function shapes

  !> The shape with a harmonic at theta [rad]: cos n theta or sin n theta.
  elemental real(dp) function shape_value(harmonic, is_sine, theta)
    integer, intent(in) :: harmonic
    logical, intent(in) :: is_sine
    real(dp), intent(in) :: theta
    if (is_sine) then
      shape_value = sin(harmonic*theta)
    else
      shape_value = cos(harmonic*theta)
    end if
  end function shape_value

  !> Its derivative with respect to theta.
  elemental real(dp) function shape_slope(harmonic, is_sine, theta)
    integer, intent(in) :: harmonic
    logical, intent(in) :: is_sine
    real(dp), intent(in) :: theta
    if (is_sine) then
      shape_slope = harmonic*cos(harmonic*theta)
    else
      shape_slope = -harmonic*sin(harmonic*theta)
    end if
  end function shape_slope

  !> A ring with the harmonics 0 and 2 to `modes` (2 to most_modes), whose two radii [m] differ by 2 % at least.
  pure type(elastic_bore_t) function new_ring(radius, outer_radius, youngs_modulus, poissons_ratio, modes) result(bore)
    real(dp), intent(in) :: radius, outer_radius, youngs_modulus, poissons_ratio
    integer, intent(in) :: modes
    integer :: k, n
    k = 2*modes - 1
    allocate (bore%harmonic(k), bore%is_sine(k), bore%compliance(k, k))
    bore%harmonic = [0, (n, n, n=2, modes)]
    bore%is_sine = [.false., (.false., .true., n=2, modes)]
    bore%compliance = 0
    do k = 1, bore%shapes()
      bore%compliance(k, k) = ring_compliance_of(bore%harmonic(k), outer_radius/radius, poissons_ratio)*radius/youngs_modulus
    end do
  end function new_ring

  !> A bore from a list of compliances [m/Pa], each the amplitude of a shape for an amplitude of the pressure; those not in the list
  !> are 0. Names are 0, 2c, 2s, 3c, ...: the harmonic, and cosine or sine. Refused are other names, a pair given twice, and
  !> compliances that are not those of an elastic body: its matrix, weighted by the work of the shapes, is symmetric (Betti), to
  !> 1 %, and its diagonal is not negative.
  pure subroutine new_compliance(loads, shapes, compliances, bore, error)
    character(len=*), intent(in) :: loads(:), shapes(:)
    real(dp), intent(in) :: compliances(:)
    type(elastic_bore_t), intent(out) :: bore
    type(error_t), allocatable, intent(out) :: error
    logical :: is_given(2*most_modes, 2*most_modes)
    real(dp) :: matrix(2*most_modes, 2*most_modes), weight(2*most_modes), limit
    integer, allocatable :: used(:)
    integer :: row, column, k

    is_given = .false.
    matrix = 0
    do k = 1, size(compliances)
      row = number_of(shapes(k))
      column = number_of(loads(k))
      if (min(row, column) == 0) then
        call fail(error, 'compliance '//trim(loads(k))//','//trim(shapes(k))//': shapes are 0, 2c, 2s, 3c, ... to 32s', &
          status_case_file)
      else if (is_given(row, column)) then
        call fail(error, 'compliance '//trim(loads(k))//','//trim(shapes(k))//' is given twice', status_case_file)
      end if
      if (allocated(error)) return
      is_given(row, column) = .true.
      matrix(row, column) = compliances(k)
    end do
    weight = 1
    weight(1) = 2   ! integral of the square of the shape 1 over that of cos n theta
    used = pack([(k, k=1, 2*most_modes)], any(is_given, 1) .or. any(is_given, 2))
    do column = 1, size(used)
      do row = 1, column
        associate (k => used(row), l => used(column))
          limit = 1e-2_dp*sqrt(max(weight(k)*matrix(k, k)*weight(l)*matrix(l, l), 0.0_dp))
          if (matrix(k, k) >= 0 .and. matrix(l, l) >= 0 .and. &
            abs(weight(k)*matrix(k, l) - weight(l)*matrix(l, k)) <= limit) cycle
          call fail(error, 'compliances of the shapes '//name_of(k)//' and '//name_of(l)//' are not those of an elastic body', &
            status_case_file)
          return
        end associate
      end do
    end do
    bore%harmonic = merge(0, used/2 + 1, used == 1)
    bore%is_sine = used > 1 .and. mod(used, 2) == 1
    bore%compliance = matrix(used, used)
  end subroutine new_compliance

  !> Place of a shape in the order 0, 2c, 2s, 3c, ...; 0 for a name that is none of them.
  pure integer function number_of(name)
    character(len=*), intent(in) :: name
    do number_of = 1, 2*most_modes - 1
      if (name_of(number_of) == name) return
    end do
    number_of = 0
  end function number_of

  !> Name of the shape at a place of this order.
  pure function name_of(number) result(name)
    integer, intent(in) :: number
    character(len=:), allocatable :: name
    character(len=3) :: text
    write (text, '(i0,a)') number/2 + 1, merge('s', 'c', mod(number, 2) == 1)
    if (number == 1) text = '0'
    name = trim(text)
  end function name_of

  !> Radial displacement of the bore of a ring (plane stress) for the pressure cos n theta, times E/(a p), n = 0 or >= 2.
  !>
  !> Airy's function (A r^n + B r^(n + 2) + C r^-n + D r^(2 - n)) cos n theta, a = 1, satisfies four conditions: sigma_r = -1 and
  !> tau = 0 at the bore, both 0 outside (Timoshenko and Goodier 1970, section 44). Its growing terms are scaled by the outer
  !> radius.
  pure real(dp) function ring_compliance_of(n, radius_ratio, poissons_ratio) result(compliance)
    integer, intent(in) :: n
    real(dp), intent(in) :: radius_ratio   !! outer over inner radius, > 1
    real(dp), intent(in) :: poissons_ratio
    real(dp) :: conditions(4, 4), terms(4), square, kappa
    integer :: pivot(4)
    logical :: singular
    if (n == 0) then
      square = radius_ratio**2
      compliance = (square + 1)/(square - 1) + poissons_ratio
      return
    end if
    conditions(1, :) = radial_stresses(1.0_dp)
    conditions(2, :) = shear_stresses(1.0_dp)
    conditions(3, :) = radial_stresses(radius_ratio)
    conditions(4, :) = shear_stresses(radius_ratio)
    call decompose(4, conditions, pivot, singular)
    terms = [-1, 0, 0, 0]
    call solve(4, conditions, pivot, terms)
    kappa = (3 - poissons_ratio)/(1 + poissons_ratio)
    compliance = (1 + poissons_ratio)*dot_product(terms, scales(1.0_dp)*[-real(n, dp), kappa - n - 1, real(n, dp), kappa + n - 1])

  contains

    !> r^(n - 2) times: A and C r^-2n scaled, B and D r^(-2n) with the factor r^2 of their terms.
    pure function scales(r)
      real(dp), intent(in) :: r
      real(dp) :: scales(4)
      scales(1:2) = (r/radius_ratio)**(n - 2)*[1.0_dp, (r/radius_ratio)**2]
      scales(3:4) = [r**(-n - 2), r**(-n)]
    end function scales

    pure function radial_stresses(r)
      real(dp), intent(in) :: r
      real(dp) :: radial_stresses(4)
      radial_stresses = scales(r)*[n*(1 - n), 2 + n - n**2, -n*(1 + n), 2 - n - n**2]
    end function radial_stresses

    pure function shear_stresses(r)
      real(dp), intent(in) :: r
      real(dp) :: shear_stresses(4)
      shear_stresses = scales(r)*[n - 1, n + 1, -n - 1, 1 - n]
    end function shear_stresses
  end function ring_compliance_of
end module ring_compliance
