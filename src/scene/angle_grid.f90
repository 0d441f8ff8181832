!> A grid of equally spaced crank angles, and the instants at which the crank passes them. A crank that turns back passes some of
!> them again.
module angle_grid
  use kinds, only: dp
  use constants, only: two_pi
  use ode_method, only: ode_method_t
  use scene_problem, only: scene_t
  use crank_passage, only: find_passage
  implicit none
  private
  public :: angle_grid_t

  !> Angle number k of the grid is `origin` + 2 pi k/`per_revolution`.
  type :: angle_grid_t
    real(dp) :: origin = 0                     !! [rad]
    real(dp) :: per_revolution = 0             !! number of angles in a revolution; 0: no grid
    real(dp), private :: last = 0              !! number k of the angle that the crank passed last, a whole number
    real(dp), private :: side = 0              !! position of the crank relative to that angle: 1 above it, -1 below it, 0 at it
  contains
    procedure :: begin
    procedure :: next_passage
    procedure :: is_due
  end type angle_grid_t

contains

  !> Angle number k [rad].
  pure real(dp) function angle(self, k)
    class(angle_grid_t), intent(in) :: self
    real(dp), intent(in) :: k
    angle = self%origin + two_pi*(k/self%per_revolution)
  end function angle

  !> Start the grid at the initial crank angle. `is_on_grid` is true if that is an angle of the grid, up to the rounding of degrees.
  pure subroutine begin(self, crank_angle, is_on_grid)
    class(angle_grid_t), intent(inout) :: self
    real(dp), intent(in) :: crank_angle   !! [rad]
    logical, intent(out) :: is_on_grid
    real(dp) :: place
    place = (crank_angle - self%origin)/two_pi*self%per_revolution
    self%last = anint(place)
    is_on_grid = abs(crank_angle - angle(self, self%last)) <= 4*epsilon(1.0_dp)*max(1.0_dp, abs(crank_angle), abs(self%origin))
    self%side = 0
    if (.not. is_on_grid) self%side = sign(1.0_dp, crank_angle - angle(self, self%last))
  end subroutine begin

  !> Find the next time between t_from and t_to at which the crank is at an angle of the grid. Both times must lie inside the last
  !> step of the method, and the crank must not turn back between them. Call it repeatedly until `is_found` is false.
  subroutine next_passage(self, method, scene, t_from, t_to, t, y, is_found)
    class(angle_grid_t), intent(inout) :: self
    class(ode_method_t), intent(inout) :: method
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t_from, t_to     !! [s]
    real(dp), intent(out) :: t               !! [s]
    real(dp), intent(inout) :: y(:)          !! state at that time
    logical, intent(out) :: is_found
    real(dp) :: target, sense, crank_angle
    call method%interpolate(t_to, y)
    crank_angle = scene%crank_angle(t_to, y)
    call find_target(self, crank_angle, target, sense, is_found)
    t = t_to
    if (is_found) then
      call find_passage(method, scene, angle(self, target), sense, t_from, t_to, 0.0_dp, t, y)
      self%last = target
      self%side = sense
    else if (.not. abs(self%side) > 0 .and. abs(crank_angle - angle(self, self%last)) > 0) then
      self%side = sign(1.0_dp, crank_angle - angle(self, self%last))
    end if
  end subroutine next_passage

  !> Number of the grid angle that the crank passes next on its way to `crank_angle`, and the sense in which it passes it.
  pure subroutine find_target(self, crank_angle, target, sense, is_found)
    class(angle_grid_t), intent(in) :: self
    real(dp), intent(in) :: crank_angle   !! [rad]
    real(dp), intent(out) :: target, sense
    logical, intent(out) :: is_found
    target = self%last
    if (self%side >= 0) target = target + 1
    sense = 1
    is_found = crank_angle >= angle(self, target)
    if (self%side < 0) is_found = crank_angle > angle(self, target)   ! it has turned back, and is not at the angle any more
    if (is_found) return
    target = self%last
    if (self%side <= 0) target = target - 1
    sense = -1
    is_found = crank_angle <= angle(self, target)
    if (self%side > 0) is_found = crank_angle < angle(self, target)
  end subroutine find_target

  !> Whether the crank is at the next angle of the grid, within `rounding`, and the value of that angle.
  pure subroutine is_due(self, crank_angle, rounding, is_on_grid, grid_angle)
    class(angle_grid_t), intent(in) :: self
    real(dp), intent(in) :: crank_angle   !! [rad]
    real(dp), intent(in) :: rounding      !! [rad]
    logical, intent(out) :: is_on_grid
    real(dp), intent(out) :: grid_angle   !! [rad]
    real(dp) :: nearest_one
    nearest_one = anint((crank_angle - self%origin)/two_pi*self%per_revolution)
    grid_angle = angle(self, nearest_one)
    is_on_grid = abs(nearest_one - self%last) > 0 .and. abs(crank_angle - grid_angle) <= rounding
  end subroutine is_due
end module angle_grid
