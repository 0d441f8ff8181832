!> The chain crank - rod - piston. Where the forces of its loose pins are known from the state, it falls into pieces that each have
!> a closed form on one page.
module gudgeon_chain
  use gudgeon_kinds, only: dp
  use chain_motion, only: motion_t, accelerations_t, crank_pin, piston_pin, n_pins, follow_rod, follow_piston
  use chain_bodies, only: bodies_t, drive_t, weightless
  use chain_loads, only: loads_t
  use chain_reactions, only: reactions_t, reactions_of
  use ideal_chain, only: accelerate_ideal_chain
  use crank_rod, only: accelerate_crank_rod, respond_crank_rod
  use rod_piston, only: accelerate_rod_piston
  use free_rod, only: accelerate_free_rod
  use assembled_chain, only: accelerate_assembled
  use loose_piston, only: free_piston, kinetic_energy_beside, height_beside
  implicit none
  private
  public :: chain_t

  type :: chain_t
    type(bodies_t) :: bodies
    type(drive_t) :: drive
    logical :: is_loose(n_pins) = .false.   !! pins with clearance
  contains
    procedure, non_overridable :: accelerate
    procedure, non_overridable :: move_rod
    procedure, non_overridable :: move_piston
    procedure :: response
    procedure :: complete_loads
    procedure :: reactions
    procedure :: energy
  end type chain_t

contains

  !> Accelerations under gravity, the drive and the loads of gas and loose pins; the loads of ideal pins that the piece finds with
  !> them; and the moment on the crank [N m]: the drive's torque if the crank is free, the moment that holds its speed if not.
  pure subroutine accelerate(self, motion, loads, accelerations, crank_moment)
    class(chain_t), intent(in) :: self
    type(motion_t), intent(in) :: motion
    type(loads_t), intent(inout) :: loads
    type(accelerations_t), intent(out) :: accelerations
    real(dp), intent(out) :: crank_moment
    if (self%bodies%piston%is_loose) then
      call accelerate_with_loose_piston(self, motion, loads, accelerations, crank_moment)
    else if (self%is_loose(crank_pin)) then
      if (self%is_loose(piston_pin)) then
        call accelerate_free_rod(self%bodies, self%drive, loads, motion, accelerations, crank_moment)
      else
        call accelerate_rod_piston(self%bodies, self%drive, motion, loads, accelerations, crank_moment)
      end if
    else if (self%is_loose(piston_pin)) then
      call accelerate_crank_rod(self%bodies, self%drive, loads, motion, accelerations, crank_moment)
    else
      call accelerate_ideal_chain(self%bodies, self%drive, motion, loads, accelerations, crank_moment)
    end if
  end subroutine accelerate

  !> The same where the piston has clearance in its bore: with clearance at its pin too it is a piece of its own.
  pure subroutine accelerate_with_loose_piston(chain, motion, loads, accelerations, crank_moment)
    type(chain_t), intent(in) :: chain
    type(motion_t), intent(in) :: motion
    type(loads_t), intent(inout) :: loads
    type(accelerations_t), intent(out) :: accelerations
    real(dp), intent(out) :: crank_moment
    if (.not. chain%is_loose(piston_pin)) then
      call accelerate_assembled(chain%bodies, chain%drive, chain%is_loose, loads, motion, accelerations, crank_moment)
      call chain%complete_loads(motion, accelerations, loads)
      return
    end if
    if (chain%is_loose(crank_pin)) then
      call accelerate_free_rod(chain%bodies, chain%drive, loads, motion, accelerations, crank_moment)
    else
      call accelerate_crank_rod(chain%bodies, chain%drive, loads, motion, accelerations, crank_moment)
    end if
    call free_piston(chain%bodies, motion, loads, accelerations)
  end subroutine accelerate_with_loose_piston

  !> The rod of a motion whose crank and offset are known. `reachable` is false where it cannot be.
  pure subroutine move_rod(self, motion, reachable)
    class(chain_t), intent(in) :: self
    type(motion_t), intent(inout) :: motion
    logical, intent(out) :: reachable
    call follow_rod(self%bodies%crank%length, self%bodies%per_rod_length, motion, reachable)
  end subroutine move_rod

  !> The piston of a motion whose crank and rod are known.
  pure subroutine move_piston(self, motion)
    class(chain_t), intent(in) :: self
    type(motion_t), intent(inout) :: motion
    call follow_piston(self%bodies%crank%length, self%bodies%rod%length, motion)
  end subroutine move_piston

  !> What a load of loose pins or of the gas adds to the accelerations and to the moment on the crank, in which all loads are
  !> linear: the bodies at rest, nothing else acting. By the general assembly, but for the piece that scenes of one joint have.
  pure subroutine response(self, motion, loads, accelerations, crank_moment)
    class(chain_t), intent(in) :: self
    type(motion_t), intent(in) :: motion
    type(loads_t), intent(in) :: loads
    type(accelerations_t), intent(out) :: accelerations
    real(dp), intent(out) :: crank_moment
    type(motion_t) :: rest
    if (self%is_loose(piston_pin) .and. .not. (self%is_loose(crank_pin) .or. self%bodies%piston%is_loose)) then
      call respond_crank_rod(self%bodies, self%drive, loads, motion, accelerations, crank_moment)
      return
    end if
    rest = motion
    rest%crank_speed = 0
    rest%rod_speed = 0
    rest%tilting%tilt_rate = 0
    call accelerate_assembled(weightless(self%bodies), drive_t(self%drive%free_crank), self%is_loose, loads, rest, accelerations, &
      crank_moment)
  end subroutine response

  !> The loads of ideal pins, from the bodies' accelerations.
  pure subroutine complete_loads(self, motion, accelerations, loads)
    class(chain_t), intent(in) :: self
    type(motion_t), intent(in) :: motion
    type(accelerations_t), intent(in) :: accelerations
    type(loads_t), intent(inout) :: loads
    type(reactions_t) :: found
    integer :: pin
    do pin = 1, n_pins
      if (.not. self%is_loose(pin)) loads%moment(pin) = 0
      if (.not. self%is_loose(pin)) loads%force(:, pin) = 0   ! it has no part in the rest
    end do
    found = self%reactions(motion, accelerations, loads)
    if (.not. self%is_loose(crank_pin)) loads%force(:, crank_pin) = -found%crankpin
    if (.not. self%is_loose(piston_pin)) loads%force(:, piston_pin) = -found%pin
  end subroutine complete_loads

  !> Forces between the bodies and on the frame.
  pure function reactions(self, motion, accelerations, loads)
    class(chain_t), intent(in) :: self
    type(motion_t), intent(in) :: motion
    type(accelerations_t), intent(in) :: accelerations
    type(loads_t), intent(in) :: loads
    type(reactions_t) :: reactions
    reactions = reactions_of(self%bodies, loads, motion, accelerations)
  end function reactions

  !> Kinetic and potential energy of the bodies [J].
  pure real(dp) function energy(self, motion)
    class(chain_t), intent(in) :: self
    type(motion_t), intent(in) :: motion
    energy = self%bodies%kinetic_energy(motion) + self%bodies%potential_energy(motion)
    if (.not. self%bodies%piston%is_loose) return
    associate (b => self%bodies)
      energy = energy + kinetic_energy_beside(b%piston, motion) - b%piston%mass*dot_product(b%gravity, height_beside(motion))
    end associate
  end function energy
end module gudgeon_chain
