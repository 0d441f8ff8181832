!> What acts on the bodies of the chain besides gravity and the drive.
module chain_loads
  use gudgeon_kinds, only: dp
  use chain_motion, only: n_pins
  implicit none
  private
  public :: loads_t, unloaded, force_size, bearing_moment

  !> Loads of the pins, of the gas and of the bore. Of an ideal pin the force is found with the accelerations.
  type :: loads_t
    real(dp) :: force(2, n_pins)    !! (:, pin): of the pin's joint on its journal [N]; the bearing receives the opposite
    real(dp) :: moment(n_pins)      !! on the journal about its centre, from x to y [N m]; the bearing's is `bearing_moment`
    real(dp) :: axial_force         !! on the piston along -x: of the gas, less the bore's friction [N]
    real(dp) :: bore_force          !! of the bore on a piston with clearance there, along y [N]; of an ideal guide it is a reaction
    real(dp) :: bore_moment         !! and its moment about the piston's centre of mass, from x to y [N m]
  end type loads_t

  type(loads_t), parameter :: unloaded = loads_t(0.0_dp, 0.0_dp, 0.0_dp, 0.0_dp, 0.0_dp)

contains

  !> Size of a force [N].
  pure real(dp) function force_size(force)
    real(dp), intent(in) :: force(2)
    force_size = sqrt(force(1)**2 + force(2)**2)   ! without the scaling of norm2
  end function force_size

  !> Moment on the bearing about its centre [N m], from the eccentricity [m], the force [N] on the journal and the moment on it: the
  !> two bodies' moments and forces balance about every point, so that a joint leaves the angular momentum of both as it is.
  pure real(dp) function bearing_moment(eccentricity, force, moment)
    real(dp), intent(in) :: eccentricity(2), force(2), moment
    bearing_moment = -(moment + eccentricity(1)*force(2) - eccentricity(2)*force(1))
  end function bearing_moment
end module chain_loads
