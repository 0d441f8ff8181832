!> The chain of crank, rod and piston. Since the forces of pins with clearance follow from the state, the chain separates at these
!> pins into parts with accelerations in closed form.
module mechanism_chain
  use kinds, only: dp
  use chain_motion, only: motion_t, accelerations_t, crank_pin, piston_pin, small_end, n_pins, follow_rod, &
    follow_piston, body_crank, body_big_end, body_piston, body_pin
  use chain_bodies, only: bodies_t, drive_t, undriven, weightless
  use chain_loads, only: loads_t
  use chain_reactions, only: reactions_t, reactions_of, elastic_reactions
  use ideal_chain, only: accelerate_ideal_chain, respond_ideal_chain
  use crank_rod, only: accelerate_crank_rod, respond_crank_rod
  use rod_piston, only: accelerate_rod_piston
  use free_rod, only: accelerate_free_rod
  use assembled_chain, only: accelerate_assembled
  use loose_piston, only: free_piston, add_energy_beside
  use varying_drive, only: varying_drive_t
  use elastic_members, only: elastic_members_t
  use crank_train, only: crank_train_t
  use floating_pin, only: floating_pin_t
  use elastic_rod, only: elastic_rod_t
  use elastic_rod_piece, only: accelerate_elastic_rod
  use elastic_rod_body, only: elastic_rod_energy, elastic_end_forces
  implicit none
  private
  public :: chain_t

  type :: chain_t
    type(bodies_t) :: bodies
    type(drive_t) :: drive = undriven
    type(varying_drive_t), allocatable :: varying   !! not allocated: the drive is constant
    logical :: is_loose(n_pins) = .false.   !! pins with clearance
    type(floating_pin_t), allocatable :: floating   !! not allocated: the piston pin is a part of the rod or of the piston
    type(elastic_members_t), allocatable :: elastic   !! not allocated: all bodies are rigid
    type(crank_train_t), allocatable :: train   !! not allocated: one cylinder, and no stations of the crankshaft
  contains
    procedure, non_overridable :: accelerate
    procedure, non_overridable :: accelerate_rigid
    procedure, non_overridable :: has_elastic_rod
    procedure :: has_crankshaft
    procedure :: driven_speed
    procedure, non_overridable :: move_rod
    procedure, non_overridable :: move_piston
    procedure :: body_angle
    procedure :: response
    procedure :: complete_loads
    procedure :: add_response
    procedure :: reactions
    procedure :: energy
  end type chain_t

contains

  !> Accelerations under gravity, the drive, and the loads of the gas and of pins with clearance. Also the loads of ideal pins that
  !> follow with them, and the moment of the drive [N m] on the crank or on the flywheel of an elastic crankshaft: its torque if
  !> that rotates freely, or the moment required for a prescribed speed. `solvable` is false if the mass matrix of an elastic rod is
  !> not positive definite.
  pure subroutine accelerate(self, motion, loads, accelerations, crank_moment, solvable)
    class(chain_t), intent(in) :: self
    type(motion_t), intent(in) :: motion
    type(loads_t), intent(inout) :: loads
    type(accelerations_t), intent(out) :: accelerations
    real(dp), intent(out) :: crank_moment
    logical, intent(out) :: solvable
    type(loads_t) :: acting
    if (allocated(self%floating)) then
      call self%floating%chain_loads(self%bodies, motion, loads, acting)
      call accelerate_bodies(self, motion, acting, accelerations, crank_moment, solvable)
      if (solvable) call self%floating%accelerate(self%bodies, motion, loads, accelerations)
    else
      call accelerate_bodies(self, motion, loads, accelerations, crank_moment, solvable)
    end if
  end subroutine accelerate

  !> The same without a floating pin.
  pure subroutine accelerate_bodies(self, motion, loads, accelerations, crank_moment, solvable)
    type(chain_t), intent(in) :: self
    type(motion_t), intent(in) :: motion
    type(loads_t), intent(inout) :: loads
    type(accelerations_t), intent(out) :: accelerations
    real(dp), intent(out) :: crank_moment
    logical, intent(out) :: solvable
    type(drive_t) :: drive, of_crank
    solvable = .true.
    drive = self%drive
    if (allocated(self%varying)) drive = self%varying%at(self%drive, self%driven_speed(motion), motion)
    of_crank = drive
    if (allocated(self%train)) of_crank = self%train%drive_of_crank(drive, motion)
    if (self%has_crankshaft()) of_crank = self%elastic%crankshaft%drive_of_crank(motion)
    if (self%has_elastic_rod()) then
      call accelerate_with_elastic_rod(self, of_crank, motion, loads, accelerations, crank_moment, solvable)
    else
      call self%accelerate_rigid(of_crank, motion, loads, accelerations, crank_moment)
    end if
    if (self%has_crankshaft()) &
      call self%elastic%crankshaft%accelerate_flywheel(drive, motion, accelerations%flywheel, crank_moment)
    if (allocated(self%train) .and. solvable) &
      call self%train%accelerate_stations(drive, motion, accelerations, crank_moment)
  end subroutine accelerate_bodies

  !> The same with a rigid rod and a given drive of the crank; `crank_moment` is the moment of this drive [N m].
  pure subroutine accelerate_rigid(self, drive, motion, loads, accelerations, crank_moment)
    class(chain_t), intent(in) :: self
    type(drive_t), intent(in) :: drive
    type(motion_t), intent(in) :: motion
    type(loads_t), intent(inout) :: loads
    type(accelerations_t), intent(out) :: accelerations
    real(dp), intent(out) :: crank_moment
    if (self%is_loose(piston_pin)) then
      if (self%is_loose(crank_pin)) then
        call accelerate_free_rod(self%bodies, drive, loads, motion, accelerations, crank_moment)
      else
        call accelerate_crank_rod(self%bodies, drive, loads, motion, accelerations, crank_moment)
      end if
      if (self%bodies%piston%is_loose) call free_piston(self%bodies, motion, loads, accelerations)
    else if (self%bodies%piston%is_loose) then
      call accelerate_assembled(self%bodies, drive, self%is_loose, loads, motion, accelerations, crank_moment)
      call self%complete_loads(motion, accelerations, loads)
    else if (self%is_loose(crank_pin)) then
      call accelerate_rod_piston(self%bodies, drive, motion, loads, accelerations, crank_moment)
    else
      call accelerate_ideal_chain(self%bodies, drive, motion, loads, accelerations, crank_moment)
    end if
    accelerations%rod_end = -accelerations%rod
  end subroutine accelerate_rigid

  pure subroutine accelerate_with_elastic_rod(chain, drive, motion, loads, accelerations, crank_moment, solvable)
    type(chain_t), intent(in) :: chain
    type(drive_t), intent(in) :: drive
    type(motion_t), intent(in) :: motion
    type(loads_t), intent(inout) :: loads
    type(accelerations_t), intent(out) :: accelerations
    real(dp), intent(out) :: crank_moment
    logical, intent(out) :: solvable
    associate (rod => chain%elastic%rod)
      if (chain%is_loose(piston_pin)) then
        call accelerate_elastic_rod(rod, chain%bodies, drive, chain%is_loose(crank_pin), loads, motion, accelerations, &
          crank_moment, solvable)
        if (.not. solvable) return
        if (chain%bodies%piston%is_loose) call free_piston(chain%bodies, motion, loads, accelerations)
      else
        call accelerate_assembled(chain%bodies, drive, chain%is_loose, loads, motion, accelerations, crank_moment, rod, solvable)
        if (.not. solvable) return
        call chain%complete_loads(motion, accelerations, loads)
      end if
      call turn_rod_ends(rod, accelerations)
    end associate
  end subroutine accelerate_with_elastic_rod

  !> Angular accelerations of the ends of an elastic rod.
  pure subroutine turn_rod_ends(rod, accelerations)
    type(elastic_rod_t), intent(in) :: rod
    type(accelerations_t), intent(inout) :: accelerations
    associate (n => rod%n_bending)
      accelerations%rod_end = matmul(accelerations%shape(:n), rod%slope(:n, :)) - accelerations%rod
    end associate
  end subroutine turn_rod_ends

  pure logical function has_elastic_rod(self)
    class(chain_t), intent(in) :: self
    has_elastic_rod = .false.
    if (allocated(self%elastic)) has_elastic_rod = allocated(self%elastic%rod)
  end function has_elastic_rod

  !> Whether the crankshaft is elastic.
  pure logical function has_crankshaft(self)
    class(chain_t), intent(in) :: self
    has_crankshaft = .false.
    if (allocated(self%elastic)) has_crankshaft = allocated(self%elastic%crankshaft)
  end function has_crankshaft

  !> Angular speed of the part on which the drive acts: the crank, the flywheel of an elastic crankshaft, or a station [rad/s].
  pure real(dp) function driven_speed(self, motion) result(speed)
    class(chain_t), intent(in) :: self
    type(motion_t), intent(in) :: motion
    speed = motion%crank_speed
    if (allocated(self%elastic)) speed = self%elastic%driven_speed(motion)
    if (allocated(self%train)) speed = motion%train%speed(self%train%driven)
  end function driven_speed

  !> Set the rod of a motion whose crank and offset are known, and the shapes of an elastic rod. `reachable` is false if there is no
  !> rod angle.
  pure subroutine move_rod(self, motion, reachable)
    class(chain_t), intent(in) :: self
    type(motion_t), intent(inout) :: motion
    logical, intent(out) :: reachable
    if (self%has_elastic_rod()) then
      call self%elastic%rod%follow(self%bodies%crank%length, self%bodies%piston%axis_offset, motion, reachable)
    else
      call follow_rod(self%bodies%crank%length, self%bodies%per_rod_length, self%bodies%piston%axis_offset, motion, reachable)
    end if
  end subroutine move_rod

  !> Set the piston of a motion whose crank and rod are known.
  pure subroutine move_piston(self, motion)
    class(chain_t), intent(in) :: self
    type(motion_t), intent(inout) :: motion
    if (self%has_elastic_rod()) then
      call self%elastic%rod%follow_piston(self%bodies%crank%length, motion)
    else
      call follow_piston(self%bodies%crank%length, self%bodies%rod%length, motion)
    end if
  end subroutine move_piston

  !> Angle by which a body has turned, from x to y [rad].
  pure real(dp) function body_angle(self, motion, body) result(angle)
    class(chain_t), intent(in) :: self
    type(motion_t), intent(in) :: motion
    integer, intent(in) :: body   !! see chain_motion
    select case (body)
    case (body_crank)
      angle = motion%crank_angle
    case (body_piston)
      angle = motion%tilting%tilt
    case (body_pin)
      angle = motion%pin_angle
    case default
      angle = -atan2(motion%sin_rod, motion%cos_rod)
      if (.not. self%has_elastic_rod()) return
      associate (n => self%elastic%rod%n_bending, pin => merge(crank_pin, piston_pin, body == body_big_end))
        angle = angle + dot_product(motion%shape(:n), self%elastic%rod%slope(:n, pin))
      end associate
    end select
  end function body_angle

  !> Changes of the accelerations and of the moment on the crank due to a load of pins with clearance or of the gas, on which they
  !> depend linearly. They are computed for bodies at rest without other loads, by the general assembly unless the chain has only
  !> ideal pins or clearance only at the piston pin; for an elastic rod in its deformed state but without its stiffness.
  pure subroutine response(self, motion, loads, accelerations, crank_moment)
    class(chain_t), intent(in) :: self
    type(motion_t), intent(in) :: motion
    type(loads_t), intent(in) :: loads
    type(accelerations_t), intent(out) :: accelerations
    real(dp), intent(out) :: crank_moment
    type(motion_t) :: rest
    type(loads_t) :: acting
    if (allocated(self%floating)) then
      call self%floating%chain_loads(self%bodies, motion, loads, acting)
      call respond_bodies(self, motion, acting, accelerations, crank_moment)
      rest = motion
      rest%tilting%tilt_rate = 0
      call self%floating%accelerate(weightless(self%bodies), rest, loads, accelerations)
    else
      call respond_bodies(self, motion, loads, accelerations, crank_moment)
    end if
  end subroutine response

  !> The same without a floating pin.
  pure subroutine respond_bodies(self, motion, loads, accelerations, crank_moment)
    type(chain_t), intent(in) :: self
    type(motion_t), intent(in) :: motion
    type(loads_t), intent(in) :: loads
    type(accelerations_t), intent(out) :: accelerations
    real(dp), intent(out) :: crank_moment
    type(motion_t) :: rest
    type(drive_t) :: drive
    type(elastic_rod_t), allocatable :: slack
    drive = self%drive
    if (allocated(self%train)) then
      drive%inertia = motion%train%inertia(self%train%full)
      drive%free_crank = self%train%frees_crank(self%drive)
    end if
    if (.not. (self%is_loose(crank_pin) .or. self%bodies%piston%is_loose .or. allocated(self%elastic))) then
      if (self%is_loose(piston_pin)) then
        call respond_crank_rod(self%bodies, drive, loads, motion, accelerations, crank_moment)
      else
        call respond_ideal_chain(self%bodies, drive, loads, motion, accelerations, crank_moment)
      end if
      accelerations%rod_end = -accelerations%rod
      return
    end if
    rest = motion
    rest%crank_speed = 0
    rest%rod_speed = 0
    rest%tilting%tilt_rate = 0
    rest%chord_rate = 0
    rest%shape_rate = 0
    drive%torque = 0
    drive%damping = 0
    drive%acceleration = 0
    drive%free_crank = drive%free_crank .or. self%has_crankshaft()
    if (self%has_elastic_rod()) then
      slack = self%elastic%rod
      slack%stiffness = 0
    end if
    call accelerate_assembled(weightless(self%bodies), drive, self%is_loose, loads, rest, accelerations, crank_moment, slack)
    accelerations%rod_end = -accelerations%rod
    if (allocated(slack)) call turn_rod_ends(slack, accelerations)
    accelerations%flywheel = 0
  end subroutine respond_bodies

  !> Add a multiple of a response to the accelerations.
  pure subroutine add_response(self, factor, change, accelerations)
    class(chain_t), intent(in) :: self
    real(dp), intent(in) :: factor
    type(accelerations_t), intent(in) :: change   !! see `response`
    type(accelerations_t), intent(inout) :: accelerations
    integer :: n
    accelerations%crank = accelerations%crank + factor*change%crank
    accelerations%rod = accelerations%rod + factor*change%rod
    accelerations%piston = accelerations%piston + factor*change%piston
    accelerations%pin(:, :n_pins) = accelerations%pin(:, :n_pins) + factor*change%pin(:, :n_pins)
    accelerations%rod_end = accelerations%rod_end + factor*change%rod_end
    if (allocated(self%floating)) then
      accelerations%pin(:, small_end) = accelerations%pin(:, small_end) + factor*change%pin(:, small_end)
      accelerations%pin_turn = accelerations%pin_turn + factor*change%pin_turn
    end if
    if (self%bodies%piston%is_loose) then
      accelerations%offset = accelerations%offset + factor*change%offset
      accelerations%tilt = accelerations%tilt + factor*change%tilt
    end if
    if (allocated(self%train)) then
      accelerations%station(self%train%full) = accelerations%station(self%train%full) + factor*change%crank
    end if
    if (.not. allocated(self%elastic)) return
    n = self%elastic%n_shapes()
    accelerations%shape(:n) = accelerations%shape(:n) + factor*change%shape(:n)
  end subroutine add_response

  !> Set the loads of ideal pins, from the accelerations of the bodies.
  pure subroutine complete_loads(self, motion, accelerations, loads)
    class(chain_t), intent(in) :: self
    type(motion_t), intent(in) :: motion
    type(accelerations_t), intent(in) :: accelerations
    type(loads_t), intent(inout) :: loads
    type(reactions_t) :: found
    integer :: pin
    do pin = 1, n_pins
      if (.not. self%is_loose(pin)) loads%moment(pin) = 0
      if (.not. self%is_loose(pin)) loads%force(:, pin) = 0   ! it does not enter the other loads
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
    type(loads_t) :: acting
    real(dp) :: force(2)
    if (allocated(self%floating)) then
      call self%floating%split_loads(self%bodies, motion, accelerations, loads, acting, force)
      reactions = reactions_beside(self, motion, accelerations, acting)
      call self%floating%split_reactions(loads%axial_force, force, reactions)
    else
      reactions = reactions_beside(self, motion, accelerations, loads)
    end if
  end function reactions

  !> The same without a floating pin.
  pure function reactions_beside(self, motion, accelerations, loads) result(reactions)
    type(chain_t), intent(in) :: self
    type(motion_t), intent(in) :: motion
    type(accelerations_t), intent(in) :: accelerations
    type(loads_t), intent(in) :: loads
    type(reactions_t) :: reactions
    real(dp) :: on_ends(2), turning
    if (self%has_elastic_rod()) then
      call elastic_end_forces(self%elastic%rod, self%bodies, motion, accelerations, on_ends, turning)
      reactions = elastic_reactions(self%bodies, loads, motion, accelerations, on_ends, turning)
    else
      reactions = reactions_of(self%bodies, loads, motion, accelerations)
    end if
  end function reactions_beside

  !> Kinetic and potential energy of the bodies [J].
  pure real(dp) function energy(self, motion)
    class(chain_t), intent(in) :: self
    type(motion_t), intent(in) :: motion
    if (self%has_elastic_rod()) then
      energy = self%bodies%energy_beside_rod(motion) + elastic_rod_energy(self%elastic%rod, self%bodies, motion)
    else
      energy = self%bodies%kinetic_energy(motion) + self%bodies%potential_energy(motion)
    end if
    if (allocated(self%train)) energy = energy + self%train%energy(motion)
    if (self%has_crankshaft()) energy = energy + self%elastic%crankshaft%energy(motion)
    if (self%bodies%piston%is_loose) call add_energy_beside(self%bodies, motion, energy)
    if (allocated(self%floating)) energy = energy + self%floating%energy(self%bodies, motion)
  end function energy
end module mechanism_chain
