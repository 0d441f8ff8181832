!> The change of the energy of crank, rod and piston along a motion, computed only from the positions of their centres of mass:
!> velocities are complex-step derivatives of the positions in quadruple precision, which are exact in double precision.
module energy_of_bodies
  use kinds, only: dp
  use chain_bodies, only: bodies_t
  implicit none
  private
  public :: energy_slope

  integer, parameter :: qp = selected_real_kind(30)

contains

  !> dE/dt [W] of kinetic and potential energy, for coordinates (q, c_x, c_y, e_x, e_y) with these values, rates and accelerations;
  !> for a piston with clearance in its bore also y of its centre of mass and its tilt. The crank pin is at R (cos q, sin q), the
  !> rod's big end at this position minus c, its small end at the distance e_y from the axis of the guide.
  !> What the offset of that axis adds to the potential energy is constant.
  real(dp) function energy_slope(bodies, z, z_rate, z_acceleration)
    type(bodies_t), intent(in) :: bodies
    real(dp), intent(in) :: z(:), z_rate(:), z_acceleration(:)
    real(qp), parameter :: dt = 1e-11_qp
    energy_slope = real((energy_after(dt) - energy_after(-dt))/(2*dt), dp)

  contains

    real(qp) function energy_after(t)
      real(qp), intent(in) :: t
      real(qp), parameter :: step = 1e-40_qp
      complex(qp) :: moved(size(z))
      complex(qp) :: place(9)
      real(qp) :: rate(9)
      moved = cmplx(z + z_rate*t + 0.5_qp*z_acceleration*t**2, step*(z_rate + z_acceleration*t), qp)
      place = places(bodies, moved)
      rate = aimag(place)/step
      associate (b => bodies, p => real(place, qp))
        energy_after = 0.5_qp*(b%crank%mass*sum(rate(1:2)**2) + b%crank%inertia*rate(3)**2 + b%rod%mass*sum(rate(4:5)**2) &
          + b%rod%inertia*rate(6)**2 + b%piston%mass*sum(rate(7:8)**2) + b%piston%inertia*rate(9)**2) &
          - b%crank%mass*dot_product(b%gravity, p(1:2)) - b%rod%mass*dot_product(b%gravity, p(4:5)) &
          - b%piston%mass*dot_product(b%gravity, p(7:8))
      end associate
    end function energy_after
  end function energy_slope

  !> Centre of mass and angle of the crank, of the rod, and of the piston.
  function places(bodies, z) result(p)
    type(bodies_t), intent(in) :: bodies
    complex(qp), intent(in) :: z(:)
    complex(qp) :: p(9), big_end(2), along(2), across(2), sine, centre(2)
    associate (r => bodies%crank%length, l => bodies%rod%length, crank => bodies%crank%com, rod => bodies%rod%com)
      p(1:2) = crank(1)*[cos(z(1)), sin(z(1))] + crank(2)*[-sin(z(1)), cos(z(1))]
      p(3) = z(1)
      big_end = r*[cos(z(1)), sin(z(1))] - z(2:3)
      p(8:9) = 0
      centre = 0
      if (size(z) > 5) then
        p(8:9) = z(6:7)
        centre = bodies%piston%com(1)*[cos(z(7)), sin(z(7))] + bodies%piston%com(2)*[-sin(z(7)), cos(z(7))]
      end if
      sine = (bodies%piston%axis_offset + p(8) - centre(2) + z(5) - big_end(2))/l   ! of the angle from the big end to the small end
      along = [sqrt(1 - sine**2), sine]
      across = [-along(2), along(1)]
      p(4:5) = big_end + rod(1)*along + rod(2)*across
      p(6) = atan(along(2)/along(1))
      p(7) = big_end(1) + l*along(1) - z(4) + centre(1)
    end associate
  end function places
end module energy_of_bodies
