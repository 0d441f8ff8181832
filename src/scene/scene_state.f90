!> The state of a scene as named numbers, from which another run may start.
submodule (scene_problem) scene_state
  use constants, only: two_pi
  use crank_turns, only: new_crank_turns
  implicit none

  real(dp), parameter :: longest_time = 1e9_dp   !! [s]

contains

  module procedure declare
    real(dp) :: angle, speed, since_wear
    real(dp) :: angles(most_cylinders), speeds(most_cylinders)   ! of the other cylinders
    integer :: n
    integer :: i
    list%of_totals = .true.
    call list%add('time', t, 's', 'time that the run has reached')
    if (list%sets .and. .not. (t >= 0 .and. t <= longest_time)) then
      call list%refuse('time', 'must be >= 0 and <= 1e9')
      t = 0
    end if
    call list%add('work', y(self%work_at), 'J', 'work of all forces and the drive on the bodies')
    list%of_totals = .false.
    angle = self%crank_angle(t, y)
    speed = self%crank_speed(t, y)
    call list%add('crank_angle', angle, 'rad', 'crank angle from the cylinder axis')
    call list%add('crank_speed', speed, 'rad/s', 'crank speed')
    if (list%sets) call turn_to(self, t, y, angle, speed, list%goes_on)
    do i = 1, self%n_joints
      call self%joints(i)%declare(list, y)
    end do
    do i = 1, size(self%carried)
      call self%carried(i)%declare(list, self%joints(self%carried(i)%joint), y)
    end do
    if (allocated(self%chain%floating)) call self%chain%floating%declare(list, y)
    if (allocated(self%guide)) call self%guide%declare(list, y)
    if (allocated(self%chain%elastic)) call self%chain%elastic%declare(list, t, y, angle, speed)
    if (allocated(self%chain%train)) call self%chain%train%declare(list, t, y, angle, speed)
    if (allocated(self%gas)) call self%gas%declare(list, y, angle, speed)
    if (allocated(self%other_gas)) then
      call other_cranks(self, t, y, angles, speeds)
      n = size(self%chain%train%cylinders)
      if (n > 0) call self%other_gas%declare(list, self%gas, y, angles(:n), speeds(:n))
    end if
    if (.not. allocated(self%wear_cycle)) return
    since_wear = angle - self%wear_cycle%begin
    list%of_totals = .true.
    call list%add('wear_cycle_angle', since_wear, 'rad', 'angle that the crank has turned since the bore changed its shape')
    list%of_totals = .false.
    if (.not. list%sets) return
    self%wear_cycle%begin = angle - since_wear
    if (self%wear_cycle%is_over(angle) .or. .not. list%goes_on) self%wear_cycle%begin = angle
  end procedure declare

  !> Begin with the crank at an angle [rad], which is reduced by whole cycles of the machine unless a run goes on, and a speed
  !> [rad/s].
  subroutine turn_to(scene, t, y, angle, speed, goes_on)
    type(scene_t), intent(inout) :: scene
    real(dp), intent(in) :: t, speed
    real(dp), intent(inout) :: y(:), angle
    logical, intent(in) :: goes_on
    character(len=:), allocatable :: key
    real(dp) :: cycle
    if (.not. goes_on) then
      cycle = scene%forced_revolutions()*two_pi
      angle = modulo(angle, cycle)
      scene%start_angle = angle
    end if
    if (scene%crank_moves) then
      y(scene%crank%position) = angle
      y(scene%crank%rate) = speed
    else
      scene%start_angle = scene%start_angle + (angle - scene%crank_angle(t, y))
    end if
    if (.not. allocated(scene%turns)) return
    key = scene%turns%key
    scene%turns = new_crank_turns(scene%turns%wanted, scene%start_angle, speed)
    scene%turns%key = key
  end subroutine turn_to
end submodule scene_state
