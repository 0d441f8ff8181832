!> The ends of the revolutions of the crank.
!>
!> Revolution k ends when the crank has turned by 2 pi k from the start of the run, in the sense of its starting speed (from rest:
!> of its torque). If the crank swings back, it is still in the revolution that it has reached.
module revolutions
  use kinds, only: dp
  use constants, only: two_pi
  use ode_method, only: ode_method_t
  use scene_problem, only: scene_t
  use crank_passage, only: find_passage
  implicit none
  private
  public :: revolutions_t

  real(dp), parameter :: rounding = 1e-9_dp   !! of the crank angle at the end of a run [rad]

  type :: revolutions_t
    real(dp) :: start_angle = 0      !! crank angle at the start of the run [rad]
    real(dp) :: direction = 1        !! sense in which the crank turns: 1 or -1
    integer :: ended = 0             !! number of revolutions that have ended
    integer :: n = 0                 !! number of them that ended in the last step
    real(dp), allocatable :: t(:)    !! times at which those ended [s]
    real(dp), allocatable :: y(:, :) !! (component, end): states at these times
  contains
    procedure :: begin
    procedure :: find_ends
    procedure :: angle
    procedure :: is_complete
  end type revolutions_t

contains

  !> Begin at (t, y). A run that goes on from another one has made revolutions, and may be inside another one.
  subroutine begin(self, scene, t, y, start_angle)
    class(revolutions_t), intent(inout) :: self
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t, y(:)
    real(dp), intent(in) :: start_angle   !! crank angle at the start of the whole run [rad]
    self%direction = sign(1.0_dp, scene%chain%drive%torque)
    if (abs(scene%start_speed) > 0) self%direction = sign(1.0_dp, scene%start_speed)
    self%start_angle = start_angle
    self%ended = max(0, floor((self%direction*(scene%crank_angle(t, y) - start_angle) + rounding)/two_pi))
    self%n = 0
    allocate (self%t(1), self%y(size(y), 1))
  end subroutine begin

  !> Find the ends of revolutions in the last step of the method before t_to, up to which the solution is final.
  subroutine find_ends(self, method, scene, t_to)
    class(revolutions_t), intent(inout) :: self
    class(ode_method_t), intent(inout) :: method
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t_to     !! [s]
    real(dp) :: crank_angle
    self%n = 0
    if (t_to < method%t) then
      call method%interpolate(t_to, self%y(:, 1))
      crank_angle = scene%crank_angle(t_to, self%y(:, 1))
    else
      crank_angle = scene%crank_angle(t_to, method%y)
    end if
    do while (self%direction*(crank_angle - self%angle(self%ended + 1)) >= 0)
      self%n = self%n + 1
      self%ended = self%ended + 1
      if (self%n > size(self%t)) then
        self%t = [self%t, self%t]
        self%y = reshape(self%y, [size(self%y, 1), size(self%t)], pad=[0.0_dp])
      end if
      call find_passage(method, scene, self%angle(self%ended), self%direction, method%t_old, t_to, 0.0_dp, self%t(self%n), &
        self%y(:, self%n))
    end do
  end subroutine find_ends

  !> Crank angle at the end of revolution k [rad].
  pure real(dp) function angle(self, k)
    class(revolutions_t), intent(in) :: self
    integer, intent(in) :: k
    angle = self%start_angle + self%direction*two_pi*k
  end function angle

  !> Whether the present revolution is complete at the end of a run but for rounding.
  pure logical function is_complete(self, crank_angle)
    class(revolutions_t), intent(in) :: self
    real(dp), intent(in) :: crank_angle   !! [rad]
    real(dp) :: travel
    travel = self%direction*(crank_angle - self%start_angle)
    is_complete = abs(travel - two_pi*(self%ended + 1)) <= rounding*(1 + self%ended)
  end function is_complete
end module revolutions
