!> The elastic rod as a body of the chain: its mass matrix, the inertial loads of its motion, its energy, and the forces at its
!> ends.
!>
!> Its velocities are (B_x', B_y', A', eta', a'): of the centre B of the big end, of the chord's angle and of the shapes. With e1 =
!> (cos A, -sin A) along the chord and e2 = (sin A, cos A), so that e1' = -A' e2 and e2' = A' e1,
!>
!>     du = Z0.a - eta.P eta/2,   dv = S.eta,   first moment of mass about B:   g = (m U + du) e1 + (m V + dv) e2
!>     J  = eta.M eta - eta.Q eta + 2 Z1.a + a.Ma a,    H = -T.eta' - a.Z eta' + a'.Z eta
!>     T  = m |B'|^2/2 + B' . g' + (m22 + J) A'^2/2 + A' H + eta'.M eta'/2 + a'.Ma a'/2
!>
!> and Lagrange's equations of T and of V = sum K eta^2/2 + sum ka a^2/2 - gravity . (m B + g) give mass matrix and loads.
module elastic_rod_body
  use kinds, only: dp
  use chain_motion, only: motion_t, accelerations_t, crank_pin, piston_pin, n_pins
  use chain_bodies, only: bodies_t
  use chain_loads, only: loads_t, unloaded, bearing_moment
  use body_assembly, only: body_t
  use elastic_rod, only: elastic_rod_t, most_of_a_kind
  implicit none
  private
  public :: rod_terms_t, find_terms, find_loads, set_own_equations, set_elastic_map, set_chord
  public :: elastic_rod_energy, elastic_end_forces

  !> Terms that mass matrix, loads and energy have in common, in the rod's axes e1, e2.
  type :: rod_terms_t
    real(dp) :: e1(2), e2(2)
    real(dp) :: moment(2)                      !! g [kg m]
    real(dp) :: moment_rate(2)                 !! (du', dv') [kg m/s]
    real(dp) :: inertia                        !! m22 + J [kg m^2]
    real(dp) :: inertia_rate                   !! J' [kg m^2/s]
    real(dp) :: bending(most_of_a_kind, 3)     !! coupling of eta' with B' . e1, B' . e2 and A'
    real(dp) :: axial(most_of_a_kind, 3)       !! coupling of a' with the same velocities
  end type rod_terms_t

contains

  pure subroutine find_terms(rod, bodies, motion, terms)
    type(elastic_rod_t), intent(in) :: rod
    type(bodies_t), intent(in) :: bodies
    type(motion_t), intent(in) :: motion
    type(rod_terms_t), intent(out) :: terms
    integer :: k, j
    real(dp) :: p_eta, q_eta, z_eta, z_a, ma_a

    terms%e1 = [motion%cos_rod, -motion%sin_rod]
    terms%e2 = [motion%sin_rod, motion%cos_rod]
    terms%moment = bodies%rod%mass*bodies%rod%com
    terms%moment_rate = 0
    terms%inertia = bodies%rod_term
    terms%inertia_rate = 0
    associate (n => rod%n_bending, na => rod%n_axial)
      associate (eta => motion%shape(:n), eta_rate => motion%shape_rate(:n), a => motion%shape(n + 1:n + na), &
                 a_rate => motion%shape_rate(n + 1:n + na))
        do k = 1, n
          p_eta = dot_product(rod%p(:n, k), eta)
          q_eta = rod%bending_mass*eta(k) - dot_product(rod%q(:n, k), eta)
          z_a = dot_product(rod%coupling(:na, k), a)
          terms%moment = terms%moment + [-0.5_dp*p_eta*eta(k), rod%s(k)*eta(k)]
          terms%moment_rate = terms%moment_rate + [-p_eta*eta_rate(k), rod%s(k)*eta_rate(k)]
          terms%inertia = terms%inertia + q_eta*eta(k)
          terms%inertia_rate = terms%inertia_rate + 2*q_eta*eta_rate(k)
          terms%bending(k, :) = [-p_eta, rod%s(k), -(rod%t(k) + z_a)]
        end do
        do j = 1, na
          z_eta = dot_product(rod%coupling(j, :n), eta)
          ma_a = dot_product(rod%axial_mass(:na, j), a)
          terms%moment(1) = terms%moment(1) + rod%z0(j)*a(j)
          terms%moment_rate(1) = terms%moment_rate(1) + rod%z0(j)*a_rate(j)
          terms%inertia = terms%inertia + (2*rod%z1(j) + ma_a)*a(j)
          terms%inertia_rate = terms%inertia_rate + 2*(rod%z1(j) + ma_a)*a_rate(j)
          terms%axial(j, :) = [rod%z0(j), 0.0_dp, z_eta]
        end do
      end associate
    end associate
  end subroutine find_terms

  !> Loads on the rod and inertial loads of its motion: on (B . e1, B . e2, A), and on each shape.
  pure subroutine find_loads(rod, bodies, loads, motion, terms, on_rod, on_shape)
    type(elastic_rod_t), intent(in) :: rod
    type(bodies_t), intent(in) :: bodies
    type(loads_t), intent(in) :: loads
    type(motion_t), intent(in) :: motion
    type(rod_terms_t), intent(in) :: terms
    real(dp), intent(out) :: on_rod(3), on_shape(:)   !! (n)
    real(dp) :: gravity(2), pin(2), big_end(2), moment(2), second, turn
    integer :: k, j

    associate (n => rod%n_bending, na => rod%n_axial, e1 => terms%e1, e2 => terms%e2, g => terms%moment, &
               g_rate => terms%moment_rate, m => bodies%rod%mass)
      associate (eta_rate => motion%shape_rate(:n), a_rate => motion%shape_rate(n + 1:n + na), a => motion%shape(n + 1:n + na))
        gravity = in_rod_axes(bodies%gravity)
        pin = in_rod_axes(loads%force(:, piston_pin))
        big_end = -in_rod_axes(loads%force(:, crank_pin))
        moment(piston_pin) = loads%moment(piston_pin)
        moment(crank_pin) = bearing_moment(motion%crank_pin, loads%force(:, crank_pin), loads%moment(crank_pin))
        turn = motion%rod_speed
        second = 0   ! eta'.P eta'
        do k = 1, n
          second = second + eta_rate(k)*dot_product(rod%p(:n, k), eta_rate)
        end do
        on_rod(1) = m*gravity(1) + pin(1) + big_end(1) - (2*turn*g_rate(2) - turn**2*g(1) - second)
        on_rod(2) = m*gravity(2) + pin(2) + big_end(2) + 2*turn*g_rate(1) + turn**2*g(2)
        on_rod(3) = gravity(1)*g(2) - gravity(2)*g(1) - motion%chord*pin(2) - sum(moment) - terms%inertia_rate*turn
        do k = 1, n
          on_shape(k) = 2*turn*dot_product(rod%coupling(:na, k), a_rate) &
            + turn**2*(rod%bending_mass*motion%shape(k) - dot_product(rod%q(:n, k), motion%shape(:n))) &
            + gravity(1)*terms%bending(k, 1) + gravity(2)*terms%bending(k, 2) &
            - 2*rod%shortening(k)*motion%shape(k)*pin(1) + dot_product(rod%slope(k, :), moment)
        end do
        do j = 1, na
          on_shape(n + j) = -2*turn*dot_product(rod%coupling(j, :n), eta_rate) &
            + turn**2*(rod%z1(j) + dot_product(rod%axial_mass(:na, j), a)) + gravity(1)*rod%z0(j)
        end do
        if (na > 0) on_shape(n + 1) = on_shape(n + 1) + pin(1)
        on_shape(:n + na) = on_shape(:n + na) - rod%stiffness(:n + na)*motion%shape(:n + na) &
          - rod%damping(:n + na)*motion%shape_rate(:n + na)
      end associate
    end associate

  contains

    pure function in_rod_axes(vector) result(parts)
      real(dp), intent(in) :: vector(2)
      real(dp) :: parts(2)
      parts = [dot_product(vector, terms%e1), dot_product(vector, terms%e2)]
    end function in_rod_axes
  end subroutine find_loads

  !> Mass matrix and loads of a body, in the rod's velocities.
  pure subroutine set_own_equations(rod, bodies, loads, motion, body)
    type(elastic_rod_t), intent(in) :: rod
    type(bodies_t), intent(in) :: bodies
    type(loads_t), intent(in) :: loads
    type(motion_t), intent(in) :: motion
    type(body_t), intent(inout) :: body   !! prepared by `begin`, with 3 + n velocities
    type(rod_terms_t) :: terms
    real(dp) :: on_rod(3), with(2)
    integer :: k, j

    call find_terms(rod, bodies, motion, terms)
    call find_loads(rod, bodies, loads, motion, terms, on_rod, body%load(4:))
    associate (n => rod%n_bending, na => rod%n_axial, e1 => terms%e1, e2 => terms%e2)
      body%load(1:2) = on_rod(1)*e1 + on_rod(2)*e2
      body%load(3) = on_rod(3)
      body%mass(1, 1) = bodies%rod%mass
      body%mass(2, 2) = bodies%rod%mass
      body%mass(3, 3) = terms%inertia
      call couple(3, terms%moment(2)*e1 - terms%moment(1)*e2, body%mass)
      do k = 1, n
        with = terms%bending(k, 1)*e1 + terms%bending(k, 2)*e2
        call couple(3 + k, with, body%mass)
        body%mass(3, 3 + k) = terms%bending(k, 3)
        body%mass(3 + k, 3) = terms%bending(k, 3)
        body%mass(3 + k, 3 + k) = rod%bending_mass
      end do
      do j = 1, na
        with = terms%axial(j, 1)*e1 + terms%axial(j, 2)*e2
        call couple(3 + n + j, with, body%mass)
        body%mass(3, 3 + n + j) = terms%axial(j, 3)
        body%mass(3 + n + j, 3) = terms%axial(j, 3)
        body%mass(4 + n:3 + n + na, 3 + n + j) = rod%axial_mass(:na, j)
      end do
    end associate
  end subroutine set_own_equations

  !> Couple one velocity with B_x' and B_y'.
  pure subroutine couple(i, with, mass)
    integer, intent(in) :: i
    real(dp), intent(in) :: with(2)
    real(dp), intent(inout) :: mass(:, :)
    mass(1:2, i) = with
    mass(i, 1:2) = with
  end subroutine couple

  !> Velocity map from the chain's coordinates to the rod: the chord's angle from l sin A = R sin q - o_y, and the shapes.
  pure subroutine set_elastic_map(rod, crank_length, motion, pin_at, shape_at, body)
    type(elastic_rod_t), intent(in) :: rod
    real(dp), intent(in) :: crank_length       !! R [m]
    type(motion_t), intent(in) :: motion
    integer, intent(in) :: pin_at(n_pins)      !! index of the eccentricity of a pin with clearance among the coordinates; 0: none
    integer, intent(in) :: shape_at            !! index of the first shape
    type(body_t), intent(inout) :: body        !! prepared by `begin`, with the rows of B_x' and B_y'
    real(dp) :: per_arm, chord_map(size(body%map, 2)), chord_bias
    integer :: k, pin
    associate (sa => motion%sin_rod, ca => motion%cos_rod)
      per_arm = 1/(motion%chord*ca)
      chord_map = 0
      call set_chord(rod, motion, shape_at, chord_map, chord_bias)
      body%map(3, shape_at:shape_at + rod%n - 1) = -sa*per_arm*chord_map(shape_at:shape_at + rod%n - 1)
      body%map(3, 1) = crank_length*motion%cos_crank*per_arm
      do pin = 1, n_pins
        if (pin_at(pin) > 0) body%map(3, pin_at(pin) + 1) = -per_arm
      end do
      body%bias(3) = (-crank_length*motion%sin_crank*motion%crank_speed**2 - 2*motion%chord_rate*motion%rod_speed*ca &
        + motion%chord*sa*motion%rod_speed**2 - sa*chord_bias)*per_arm
      do k = 1, rod%n
        body%map(3 + k, shape_at + k - 1) = 1
      end do
    end associate
  end subroutine set_elastic_map

  !> Map from the rates of the shapes to l', and l'' for vanishing accelerations of the shapes.
  pure subroutine set_chord(rod, motion, shape_at, map, bias)
    type(elastic_rod_t), intent(in) :: rod
    type(motion_t), intent(in) :: motion
    integer, intent(in) :: shape_at
    real(dp), intent(inout) :: map(:)   !! map from the rates of the chain's coordinates
    real(dp), intent(out) :: bias
    associate (n => rod%n_bending)
      map(shape_at:shape_at + n - 1) = -2*rod%shortening(:n)*motion%shape(:n)
      if (rod%n_axial > 0) map(shape_at + n) = 1
      bias = -2*sum(rod%shortening(:n)*motion%shape_rate(:n)**2)
    end associate
  end subroutine set_chord

  !> Kinetic energy, potential energy (0 at the crank axis) and elastic energy of the rod [J].
  pure real(dp) function elastic_rod_energy(rod, bodies, motion) result(energy)
    type(elastic_rod_t), intent(in) :: rod
    type(bodies_t), intent(in) :: bodies
    type(motion_t), intent(in) :: motion
    type(rod_terms_t) :: terms
    real(dp) :: big_end(2), velocity(2), moment(2), moment_rate(2), angular
    associate (n => rod%n_bending, na => rod%n_axial, r => bodies%crank%length, turn => motion%rod_speed)
      associate (eta_rate => motion%shape_rate(:n), a_rate => motion%shape_rate(n + 1:n + na))
        call find_terms(rod, bodies, motion, terms)
        big_end = r*[motion%cos_crank, motion%sin_crank] - motion%crank_pin
        velocity = r*motion%crank_speed*[-motion%sin_crank, motion%cos_crank] - motion%crank_pin_rate
        moment = terms%moment(1)*terms%e1 + terms%moment(2)*terms%e2
        moment_rate = (terms%moment_rate(1) + turn*terms%moment(2))*terms%e1 &
          + (terms%moment_rate(2) - turn*terms%moment(1))*terms%e2
        angular = dot_product(terms%bending(:n, 3), eta_rate) + dot_product(terms%axial(:na, 3), a_rate)
        energy = 0.5_dp*bodies%rod%mass*sum(velocity**2) + dot_product(velocity, moment_rate) + 0.5_dp*terms%inertia*turn**2 &
          + turn*angular + 0.5_dp*rod%bending_mass*sum(eta_rate**2) &
          + 0.5_dp*dot_product(a_rate, matmul(rod%axial_mass(:na, :na), a_rate)) &
          - dot_product(bodies%gravity, bodies%rod%mass*big_end + moment) + rod%strain_energy(motion)
      end associate
    end associate
  end function elastic_rod_energy

  !> Forces and moments required at the ends of the rod by its accelerations: the sum of the forces, and their moment about the big
  !> end, including moments at the ends (positive against A).
  pure subroutine elastic_end_forces(rod, bodies, motion, accelerations, force, turning)
    type(elastic_rod_t), intent(in) :: rod
    type(bodies_t), intent(in) :: bodies
    type(motion_t), intent(in) :: motion
    type(accelerations_t), intent(in) :: accelerations
    real(dp), intent(out) :: force(2), turning   !! [N], [N m]
    type(body_t) :: body
    real(dp) :: own(3 + rod%n), radius(2)
    call body%begin(3 + rod%n, 1)
    call set_own_equations(rod, bodies, unloaded, motion, body)
    radius = bodies%crank%length*[motion%cos_crank, motion%sin_crank]
    own(1:2) = [-radius(2), radius(1)]*accelerations%crank - radius*motion%crank_speed**2 - accelerations%pin(:, crank_pin)
    own(3) = accelerations%rod
    own(4:) = accelerations%shape(:rod%n)
    own(1:3) = matmul(body%mass(:3, :3 + rod%n), own) - body%load(:3)
    force = own(1:2)
    turning = -own(3)
  end subroutine elastic_end_forces
end module elastic_rod_body
