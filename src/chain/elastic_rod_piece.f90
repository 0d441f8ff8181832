!> Chain with an elastic rod and clearance at the piston pin: crank and rod on one side, piston on the other; the crank pin may have
!> clearance. The shapes of the rod are eliminated first: their own mass matrix is constant, and few terms couple them with the
!> motion of the rod's axes. The remaining equations have the order of those of a rigid rod.
module elastic_rod_piece
  use kinds, only: dp
  use chain_motion, only: motion_t, accelerations_t, crank_pin, piston_pin
  use chain_bodies, only: bodies_t, drive_t
  use chain_loads, only: loads_t
  use free_crank, only: accelerate_crank, crank_pin_acceleration
  use small_cholesky, only: factorise_cholesky, solve_cholesky
  use elastic_rod, only: elastic_rod_t
  use elastic_rod_body, only: rod_terms_t, find_terms, find_loads
  implicit none
  private
  public :: accelerate_elastic_rod

contains

  !> Accelerations, and the moment on the crank (see `accelerate_crank_rod`). `solvable` is false if the mass matrix is not positive
  !> definite: the deformation of the rod is beyond the range of its equations.
  pure subroutine accelerate_elastic_rod(rod, bodies, drive, crank_pin_is_loose, loads, motion, accelerations, crank_moment, &
                                         solvable)
    type(elastic_rod_t), intent(in) :: rod
    type(bodies_t), intent(in) :: bodies
    type(drive_t), intent(in) :: drive
    logical, intent(in) :: crank_pin_is_loose
    type(loads_t), intent(in) :: loads
    type(motion_t), intent(in) :: motion
    type(accelerations_t), intent(out) :: accelerations
    real(dp), intent(out) :: crank_moment
    logical, intent(out) :: solvable
    type(rod_terms_t) :: terms
    type(loads_t) :: acting
    real(dp) :: mass(3, 3), force(3), on_shape(rod%n), own(3), big_end(2)

    acting = loads
    if (.not. crank_pin_is_loose) then
      acting%force(:, crank_pin) = 0
      acting%moment(crank_pin) = 0
    end if
    call find_terms(rod, bodies, motion, terms)
    call find_loads(rod, bodies, acting, motion, terms, force, on_shape)
    mass = 0
    mass(1, 1) = bodies%rod%mass
    mass(2, 2) = bodies%rod%mass
    mass(3, :) = [terms%moment(2), -terms%moment(1), terms%inertia]
    mass(1:2, 3) = mass(3, 1:2)
    call eliminate_shapes(rod, terms, on_shape, mass, force)
    if (crank_pin_is_loose) then
      call accelerate_crank(bodies, drive, motion, loads, accelerations%crank, crank_moment)
      own = force
      call factorise_cholesky(3, mass, solvable)
      if (.not. solvable) return
      call solve_cholesky(3, mass, own)
      big_end = own(1)*terms%e1 + own(2)*terms%e2
      accelerations%pin(:, crank_pin) = crank_pin_acceleration(bodies, motion, accelerations%crank) - big_end
    else
      call turn_with_crank(bodies, drive, motion, terms, mass, force, accelerations%crank, own, crank_moment, solvable)
      if (.not. solvable) return
      accelerations%pin(:, crank_pin) = 0
    end if
    accelerations%rod = own(3)
    call find_shapes(rod, terms, on_shape, own, accelerations%shape)
    accelerations%piston = bodies%gravity(1) - (loads%axial_force + loads%force(1, piston_pin))*bodies%per_piston_mass
    accelerations%pin(:, piston_pin) = pin_acceleration(rod, motion, terms, own, accelerations%shape) &
      - [accelerations%piston, 0.0_dp]
  end subroutine accelerate_elastic_rod

  !> Eliminate the shapes from the equations of (B . e1, B . e2, A).
  pure subroutine eliminate_shapes(rod, terms, on_shape, mass, force)
    type(elastic_rod_t), intent(in) :: rod
    type(rod_terms_t), intent(in) :: terms
    real(dp), intent(in) :: on_shape(:)
    real(dp), intent(inout) :: mass(3, 3), force(3)
    real(dp) :: freed(rod%n_axial), per_mass
    integer :: i, j, k
    associate (n => rod%n_bending, na => rod%n_axial)
      per_mass = 1/rod%bending_mass
      do k = 1, n
        do i = 1, 3
          mass(:, i) = mass(:, i) - terms%bending(k, :)*(terms%bending(k, i)*per_mass)
        end do
        force = force - terms%bending(k, :)*(on_shape(k)*per_mass)
      end do
      if (na == 0) return
      do i = 1, 3, 2   ! the axial shapes do not contribute perpendicular to the chord
        do j = 1, na
          freed(j) = dot_product(rod%axial_inverse(:na, j), terms%axial(:na, i))
        end do
        do j = 1, 3, 2
          mass(j, i) = mass(j, i) - dot_product(terms%axial(:na, j), freed)
        end do
        force(i) = force(i) - dot_product(freed, on_shape(n + 1:n + na))
      end do
    end associate
  end subroutine eliminate_shapes

  !> Accelerations of the shapes from those of the rod's axes.
  pure subroutine find_shapes(rod, terms, on_shape, own, shape)
    type(elastic_rod_t), intent(in) :: rod
    type(rod_terms_t), intent(in) :: terms
    real(dp), intent(in) :: on_shape(:), own(3)
    real(dp), intent(inout) :: shape(:)
    real(dp) :: left(rod%n_axial)
    integer :: j, k
    associate (n => rod%n_bending, na => rod%n_axial)
      do k = 1, n
        shape(k) = (on_shape(k) - dot_product(terms%bending(k, :), own))/rod%bending_mass
      end do
      do j = 1, na
        left(j) = on_shape(n + j) - dot_product(terms%axial(j, :), own)
      end do
      do j = 1, na
        shape(n + j) = dot_product(rod%axial_inverse(:na, j), left)
      end do
    end associate
  end subroutine find_shapes

  !> Solve for q'' and the rod's A'' together if the crank carries the big end.
  pure subroutine turn_with_crank(bodies, drive, motion, terms, mass, force, acceleration, own, crank_moment, solvable)
    type(bodies_t), intent(in) :: bodies
    type(drive_t), intent(in) :: drive
    type(motion_t), intent(in) :: motion
    type(rod_terms_t), intent(in) :: terms
    real(dp), intent(in) :: mass(3, 3), force(3)
    real(dp), intent(out) :: acceleration, own(3), crank_moment
    logical, intent(out) :: solvable
    real(dp) :: arm(2), by_crank(3), centripetal(3), m11, m12, on_crank, on_rod, determinant
    associate (r => bodies%crank%length, sq => motion%sin_crank, cq => motion%cos_crank, m22 => mass(3, 3))
      arm = r*[-sq, cq]
      by_crank = [dot_product(arm, terms%e1), dot_product(arm, terms%e2), 0.0_dp]
      centripetal = -r*motion%crank_speed**2*[cq*terms%e1(1) + sq*terms%e1(2), cq*terms%e2(1) + sq*terms%e2(2), 0.0_dp]
      m11 = bodies%crank_inertia + drive%inertia + dot_product(by_crank, matmul(mass, by_crank))
      m12 = dot_product(by_crank, mass(:, 3))
      on_crank = drive%torque - drive%damping*motion%crank_speed &
        + (bodies%crank_own_weight(1)*sq + bodies%crank_own_weight(2)*cq) &
        + dot_product(by_crank, force - matmul(mass, centripetal))
      on_rod = force(3) - dot_product(mass(:, 3), centripetal)
      crank_moment = drive%torque
      acceleration = drive%acceleration
      if (drive%free_crank) then
        determinant = m11*m22 - m12**2
        solvable = determinant > 0 .and. m22 > 0
        if (solvable) acceleration = (on_crank*m22 - on_rod*m12)/determinant
      else
        solvable = m22 > 0
      end if
      own = 0
      if (.not. solvable) return
      own = centripetal + by_crank*acceleration
      own(3) = (on_rod - m12*acceleration)/m22
      if (.not. drive%free_crank) crank_moment = drive%torque + m11*acceleration + m12*own(3) - on_crank
    end associate
  end subroutine turn_with_crank

  !> Acceleration (x, y) of the centre of the piston pin [m/s^2].
  pure function pin_acceleration(rod, motion, terms, own, shape) result(a)
    type(elastic_rod_t), intent(in) :: rod
    type(motion_t), intent(in) :: motion
    type(rod_terms_t), intent(in) :: terms
    real(dp), intent(in) :: own(3)     !! of (B . e1, B . e2, A)
    real(dp), intent(in) :: shape(:)   !! of the shapes
    real(dp) :: a(2), chord
    associate (n => rod%n_bending)
      chord = -2*sum(rod%shortening(:n)*(motion%shape_rate(:n)**2 + motion%shape(:n)*shape(:n)))
      if (rod%n_axial > 0) chord = chord + shape(n + 1)
    end associate
    a = (own(1) + chord - motion%chord*motion%rod_speed**2)*terms%e1 &
      + (own(2) - 2*motion%chord_rate*motion%rod_speed - motion%chord*own(3))*terms%e2
  end function pin_acceleration
end module elastic_rod_piece
