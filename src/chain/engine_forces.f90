!> Forces of the frame on an engine of several cylinders: on the throws of its shaft, in its cylinders, and on the whole of it.
module engine_forces
  use kinds, only: dp
  use chain_motion, only: motion_t, accelerations_t
  use chain_reactions, only: reactions_t
  use ideal_cylinders, only: cylinder_forces_t
  use crank_train, only: crank_train_t
  use train_motion, only: most_cylinders
  implicit none
  private
  public :: engine_forces_t

  !> Forces and moments in the axes of the full cylinder, and those of the other cylinders in their own axes.
  type :: engine_forces_t
    real(dp) :: force(2) = 0         !! of the frame on the engine [N]
    real(dp) :: moment(3) = 0        !! about the point of the shaft with axial position 0 [N m]
    real(dp) :: throw(2, most_cylinders) = 0   !! of the frame on each throw [N]
    type(cylinder_forces_t) :: cylinder(most_cylinders)   !! of the other cylinders
  contains
    procedure :: find
    procedure :: add_up
    procedure :: on_shaft
  end type engine_forces_t

contains

  !> Find the forces on the throws and in the cylinders, from the reactions of the mechanism.
  pure subroutine find(self, train, motion, accelerations, full)
    class(engine_forces_t), intent(inout) :: self
    type(crank_train_t), intent(in) :: train
    type(motion_t), intent(in) :: motion
    type(accelerations_t), intent(in) :: accelerations
    type(reactions_t), intent(in) :: full
    integer :: i
    self%throw = 0
    self%throw(:, train%full_throw) = full%crank_bearing
    do i = 1, size(train%cylinders)
      associate (it => train%cylinders(i), at => motion%train)
        self%cylinder(i) = it%forces(at%angle(i), at%speed(it%station), accelerations%station(it%station), at%gas_force(i))
        self%throw(:, it%throw) = self%throw(:, it%throw) + turned(self%cylinder(i)%reactions%crank_bearing, it%bank)
      end associate
    end do
  end subroutine find

  !> Add up the forces of all cylinders, which have been found, and their moments.
  pure subroutine add_up(self, train, motion, full)
    class(engine_forces_t), intent(inout) :: self
    type(crank_train_t), intent(in) :: train
    type(motion_t), intent(in) :: motion
    type(reactions_t), intent(in) :: full
    integer :: i
    self%force = 0
    self%moment = 0
    call add(self, train%axis_offset, full, motion%piston_position, train%full_axial_position, 0.0_dp)
    do i = 1, size(train%cylinders)
      associate (it => train%cylinders(i), found => self%cylinder(i))
        call add(self, train%axis_offset, found%reactions, found%piston_position, it%axial_position, it%bank)
      end associate
    end do
  end subroutine add_up

  !> Add the forces of a cylinder at the axial position z [m], whose axes are turned by its bank. About the shaft turn those of the
  !> guide and, with an offset of the axis, those along the axis: of the gas on the head, and of the friction of the bore.
  pure subroutine add(self, axis_offset, reactions, piston_position, z, bank)
    type(engine_forces_t), intent(inout) :: self
    real(dp), intent(in) :: axis_offset   !! of every cylinder axis from the crank axis [m]
    type(reactions_t), intent(in) :: reactions
    real(dp), intent(in) :: piston_position, z, bank
    real(dp) :: force(2)
    force = turned(reactions%frame, bank)
    self%force = self%force + force
    self%moment = self%moment + [-z*force(2), z*force(1), &
      axis_offset*(reactions%crank_bearing(1) - reactions%frame(1)) - piston_position*reactions%guide]
  end subroutine add

  !> Force of the frame on the shaft at main bearing b, between the throws b - 1 and b: each throw loads its two bearings by halves
  !> [N].
  pure function on_shaft(self, b, n_throws) result(force)
    class(engine_forces_t), intent(in) :: self
    integer, intent(in) :: b, n_throws
    real(dp) :: force(2)
    force = 0
    if (b > 1) force = 0.5_dp*self%throw(:, b - 1)
    if (b <= n_throws) force = force + 0.5_dp*self%throw(:, b)
  end function on_shaft

  !> A vector turned from x towards y [rad].
  pure function turned(vector, angle)
    real(dp), intent(in) :: vector(2), angle
    real(dp) :: turned(2)
    turned = [vector(1)*cos(angle) - vector(2)*sin(angle), vector(1)*sin(angle) + vector(2)*cos(angle)]
  end function turned
end module engine_forces
