!> Loads on the bodies of the chain other than gravity and the drive.
module chain_loads
  use kinds, only: dp
  use chain_motion, only: n_bearings
  implicit none
  private
  public :: loads_t, unloaded, force_size, bearing_moment

  !> Loads of the pins, of the gas and of the bore. The force of an ideal pin is found together with the accelerations.
  type :: loads_t
    real(dp) :: force(2, n_bearings)  !! (:, pin): force of the pin's joint on its pin [N]; the opposite force acts on the bearing.
                                      !! In the rod's bearing of a floating pin it is the force on the rod
    real(dp) :: moment(n_bearings)    !! moment on the same body about its centre, positive from x to y [N m]; for the other body
                                      !! see `bearing_moment`
    real(dp) :: axial_force         !! on the piston along -x: force of the gas minus friction of the bore [N]
    real(dp) :: bore_force  !! force of the bore on a piston with clearance, along y [N]; that of an ideal guide is a reaction
    real(dp) :: bore_moment         !! moment of the bore about the piston's centre of mass, positive from x to y [N m]
  end type loads_t

  type(loads_t), parameter :: unloaded = loads_t(0.0_dp, 0.0_dp, 0.0_dp, 0.0_dp, 0.0_dp)

contains

  !> Magnitude of a force [N].
  pure real(dp) function force_size(force)
    real(dp), intent(in) :: force(2)
    force_size = sqrt(force(1)**2 + force(2)**2)   ! without the scaling of norm2
  end function force_size

  !> Moment on the bearing about its centre [N m], from the eccentricity [m], the force [N] on the pin and the moment on it.
  !> Forces and moments on the two bodies balance about every point, so that a joint does not change their total angular momentum.
  pure real(dp) function bearing_moment(eccentricity, force, moment)
    real(dp), intent(in) :: eccentricity(2), force(2), moment
    bearing_moment = -(moment + eccentricity(1)*force(2) - eccentricity(2)*force(1))
  end function bearing_moment
end module chain_loads
