!> An elastic rod as a continuum: mass points along a line that bends and stretches. Kinetic and potential energy are sums over
!> these points (Gauss's quadrature with 40 nodes, in quadruple precision), reduced to second order in the shapes by differences at
!> five amplitudes only; Lagrange's equations are differences of the energies.
module elastic_rod_field
  use kinds, only: dp
  use chain_bodies, only: bodies_t
  use elastic_rod, only: elastic_rod_t
  implicit none
  private
  public :: field_t, new_field, lagrange_residual, energy_slope_of_field, qp

  integer, parameter :: qp = selected_real_kind(30)
  integer, parameter :: nodes = 40
  real(qp), parameter :: pi = 3.14159265358979323846264338327950288_qp

  !> Points of the rod: Gauss's nodes on the shank, the big end and the piston pin.
  type :: field_t
    integer :: n = 0, na = 0                       !! shapes across and along
    real(qp) :: length = 0, bending = 0, axial = 0 !! L, E I, E A
    real(qp) :: mass(nodes + 2) = 0, at(nodes + 2) = 0, weight(nodes + 2) = 0
    real(qp) :: phi(nodes + 2, 8) = 0, phi_2(nodes + 2, 8) = 0, psi(nodes + 2, 8) = 0, psi_1(nodes + 2, 8) = 0
    real(qp) :: drawn_back(nodes + 2, 8, 8) = 0    !! sigma = eta . drawn_back eta
    real(qp) :: whole_mass = 0
    real(qp) :: rest_inertia = 0, rest_across = 0  !! part of the rod's inertia and first moment that these points lack
  end type field_t

contains

  !> The field of a rod: shank, point masses at the pins, and the rest of the rod's inertia and centre of mass.
  type(field_t) function new_field(rod, bodies) result(f)
    type(elastic_rod_t), intent(in) :: rod
    type(bodies_t), intent(in) :: bodies
    real(qp) :: x(nodes), w(nodes)
    integer :: i, k, l
    f%n = rod%n_bending
    f%na = rod%n_axial
    f%length = bodies%rod%length
    f%bending = real(rod%youngs_modulus, qp)*rod%section_inertia
    f%axial = real(rod%youngs_modulus, qp)*rod%section_area
    f%whole_mass = bodies%rod%mass
    call gauss(x, w)
    f%at(:nodes) = f%length*x
    f%weight(:nodes) = f%length*w
    f%at(nodes + 1:) = [0.0_qp, f%length]
    f%mass(:nodes) = rod%shank_mass*w
    f%mass(nodes + 2) = f%whole_mass*bodies%rod%com(1)/f%length - 0.5_qp*rod%shank_mass
    f%mass(nodes + 1) = f%whole_mass - rod%shank_mass - f%mass(nodes + 2)
    f%rest_inertia = bodies%rod%inertia + f%whole_mass*sum(real(bodies%rod%com, qp)**2) - sum(f%mass*f%at**2)
    f%rest_across = f%whole_mass*bodies%rod%com(2)
    do i = 1, nodes + 2
      do k = 1, f%n
        f%phi(i, k) = sin(k*pi*f%at(i)/f%length)
        f%phi_2(i, k) = -(k*pi/f%length)**2*f%phi(i, k)
        do l = 1, f%n   ! again by quadrature, from the big end to here
          f%drawn_back(i, k, l) = 0.5_qp*f%at(i)*sum(w*cos(k*pi*x*f%at(i)/f%length)*cos(l*pi*x*f%at(i)/f%length))* &
            k*l*(pi/f%length)**2
        end do
      end do
      f%psi(i, 1) = f%at(i)/f%length
      f%psi_1(i, 1) = 1/f%length
      do k = 2, f%na
        f%psi(i, k) = sin((k - 1)*pi*f%at(i)/f%length)
        f%psi_1(i, k) = (k - 1)*pi/f%length*cos((k - 1)*pi*f%at(i)/f%length)
      end do
    end do
  end function new_field

  !> Nodes and weights of Gauss's quadrature on [0, 1], by Newton's method on Legendre's polynomial.
  subroutine gauss(x, w)
    real(qp), intent(out) :: x(nodes), w(nodes)
    real(qp) :: z, p0, p1, p2, slope
    integer :: i, j, turn
    do i = 1, nodes
      z = cos(pi*(i - 0.25_qp)/(nodes + 0.5_qp))
      do turn = 1, 100
        p0 = 1
        p1 = z
        do j = 2, nodes
          p2 = ((2*j - 1)*z*p1 - (j - 1)*p0)/j
          p0 = p1
          p1 = p2
        end do
        slope = nodes*(z*p1 - p0)/(z**2 - 1)
        z = z - p1/slope
        if (abs(p1/slope) < 1e-32_qp) exit
      end do
      x(i) = 0.5_qp*(1 + z)
      w(i) = 1/((1 - z**2)*slope**2)
    end do
  end subroutine gauss

  !> Kinetic energy with the shapes `factor` times as large. Coordinates are (B_x, B_y, A, eta, a).
  real(qp) function kinetic(f, x, v, factor)
    type(field_t), intent(in) :: f
    real(qp), intent(in) :: x(:), v(:), factor
    real(qp) :: e1(2), e2(2), along, along_rate, across, across_rate, velocity(2), eta(f%n), eta_rate(f%n), a(f%na), a_rate(f%na)
    integer :: i
    e1 = [cos(x(3)), -sin(x(3))]
    e2 = [sin(x(3)), cos(x(3))]
    eta = factor*x(4:3 + f%n)
    eta_rate = factor*v(4:3 + f%n)
    a = factor*x(4 + f%n:)
    a_rate = factor*v(4 + f%n:)
    kinetic = 0.5_qp*f%rest_inertia*v(3)**2 + f%rest_across*v(3)*dot_product(v(1:2), e1)
    do i = 1, nodes + 2
      associate (back => f%drawn_back(i, :f%n, :f%n))
        along = f%at(i) + dot_product(f%psi(i, :f%na), a) - dot_product(eta, matmul(back, eta))
        along_rate = dot_product(f%psi(i, :f%na), a_rate) - 2*dot_product(eta_rate, matmul(back, eta))
      end associate
      across = dot_product(f%phi(i, :f%n), eta)
      across_rate = dot_product(f%phi(i, :f%n), eta_rate)
      velocity = v(1:2) + (along_rate + across*v(3))*e1 + (across_rate - along*v(3))*e2
      kinetic = kinetic + 0.5_qp*f%mass(i)*sum(velocity**2)
    end do
  end function kinetic

  !> The same up to second order in the shapes: a polynomial of degree 4 in their amplitude without its two highest terms.
  real(qp) function truncated_kinetic(f, x, v) result(t)
    type(field_t), intent(in) :: f
    real(qp), intent(in) :: x(:), v(:)
    real(qp) :: value(-2:2), even(2), odd(2), third, fourth
    integer :: i
    do i = -2, 2
      value(i) = kinetic(f, x, v, real(i, qp))
    end do
    even = 0.5_qp*[value(1) + value(-1), value(2) + value(-2)] - value(0)   ! c2 + c4, 4 c2 + 16 c4
    odd = 0.5_qp*[value(1) - value(-1), value(2) - value(-2)]               ! c1 + c3, 2 c1 + 8 c3
    fourth = (even(2) - 4*even(1))/12
    third = (odd(2) - 2*odd(1))/6
    t = value(1) - third - fourth
  end function truncated_kinetic

  !> Strain energy of bending and stretching, and potential energy of gravity.
  real(qp) function potential(f, x, gravity)
    type(field_t), intent(in) :: f
    real(qp), intent(in) :: x(:), gravity(2)
    real(qp) :: e1(2), e2(2), along, across
    integer :: i
    e1 = [cos(x(3)), -sin(x(3))]
    e2 = [sin(x(3)), cos(x(3))]
    potential = -f%rest_across*dot_product(gravity, e2)
    associate (eta => x(4:3 + f%n), a => x(4 + f%n:))
      do i = 1, nodes + 2
        along = f%at(i) + dot_product(f%psi(i, :f%na), a) - dot_product(eta, matmul(f%drawn_back(i, :f%n, :f%n), eta))
        across = dot_product(f%phi(i, :f%n), eta)
        potential = potential - f%mass(i)*dot_product(gravity, x(1:2) + along*e1 + across*e2) &
          + 0.5_qp*f%weight(i)*(f%bending*dot_product(f%phi_2(i, :f%n), eta)**2 + f%axial*dot_product(f%psi_1(i, :f%na), a)**2)
      end do
    end associate
  end function potential

  !> d/dt dT/dv - d(T - V)/dx along a motion with these coordinates, rates and accelerations: the generalized forces of the motion.
  function lagrange_residual(f, gravity, x, v, acceleration) result(residual)
    type(field_t), intent(in) :: f
    real(dp), intent(in) :: gravity(2), x(:), v(:), acceleration(:)
    real(dp) :: residual(size(x))
    real(qp), parameter :: dt = 1e-10_qp, step = 1e-10_qp
    real(qp) :: there(size(x)), back(size(x)), g(2)
    integer :: i
    g = gravity
    do i = 1, size(x)
      there = x
      back = x
      there(i) = there(i) + step
      back(i) = back(i) - step
      residual(i) = real((momentum(dt) - momentum(-dt))/(2*dt) &
        - (truncated_kinetic(f, there, real(v, qp)) - truncated_kinetic(f, back, real(v, qp)))/(2*step) &
        + (potential(f, there, g) - potential(f, back, g))/(2*step), dp)
    end do

  contains

    !> dT/dv_i at time t; T is quadratic in v.
    real(qp) function momentum(t)
      real(qp), intent(in) :: t
      real(qp) :: place(size(x)), faster(size(x)), slower(size(x))
      place = x + v*t + 0.5_qp*acceleration*t**2
      faster = v + acceleration*t
      slower = faster
      faster(i) = faster(i) + 1
      slower(i) = slower(i) - 1
      momentum = 0.5_qp*(truncated_kinetic(f, place, faster) - truncated_kinetic(f, place, slower))
    end function momentum
  end function lagrange_residual

  !> dE/dt [W] of crank, this rod and piston, for coordinates (q, c_x, c_y, e_x, e_y, eta, a) with these values, rates and
  !> accelerations.
  real(dp) function energy_slope_of_field(f, bodies, z, z_rate, z_acceleration) result(slope)
    type(field_t), intent(in) :: f
    type(bodies_t), intent(in) :: bodies
    real(dp), intent(in) :: z(:), z_rate(:), z_acceleration(:)
    real(qp), parameter :: dt = 1e-11_qp
    slope = real((energy_after(dt) - energy_after(-dt))/(2*dt), dp)

  contains

    real(qp) function energy_after(t)
      real(qp), intent(in) :: t
      real(qp), parameter :: step = 1e-40_qp
      complex(qp) :: moved(size(z)), place(6)
      real(qp) :: x(size(z) - 2), v(size(z) - 2)
      moved = cmplx(z + z_rate*t + 0.5_qp*z_acceleration*t**2, step*(z_rate + z_acceleration*t), qp)
      place = places(moved)
      x(:3) = real(place(:3), qp)
      v(:3) = aimag(place(:3))/step
      x(4:) = real(moved(6:), qp)
      v(4:) = aimag(moved(6:))/step
      associate (b => bodies, g => real(bodies%gravity, qp))
        energy_after = truncated_kinetic(f, x, v) + potential(f, x, g) &
          + 0.5_qp*(b%crank%mass*sum(aimag(place(5:6))**2)/step**2 + b%crank%inertia*aimag(moved(1))**2/step**2 &
          + b%piston%mass*(aimag(place(4))/step)**2) &
          - g(1)*b%piston%mass*real(place(4), qp) - b%crank%mass*dot_product(g, real(place(5:6), qp))
      end associate
    end function energy_after

    !> Big end, angle of the chord, piston, centre of mass of the crank.
    function places(now) result(p)
      complex(qp), intent(in) :: now(:)
      complex(qp) :: p(6), chord, sine
      chord = f%length
      if (f%na > 0) chord = chord + now(6 + f%n)
      associate (eta => now(6:5 + f%n), r => bodies%crank%length, com => bodies%crank%com)
        chord = chord - sum(eta*matmul(cmplx(f%drawn_back(nodes + 2, :f%n, :f%n), 0.0_qp, qp), eta))
        p(1) = r*cos(now(1)) - now(2)
        p(2) = r*sin(now(1)) - now(3)
        sine = (p(2) - bodies%piston%axis_offset - now(5))/chord
        p(3) = atan(sine/sqrt(1 - sine**2))
        p(4) = p(1) + chord*sqrt(1 - sine**2) - now(4)
        p(5) = com(1)*cos(now(1)) - com(2)*sin(now(1))
        p(6) = com(1)*sin(now(1)) + com(2)*cos(now(1))
      end associate
    end function places
  end function energy_slope_of_field
end module elastic_rod_field
