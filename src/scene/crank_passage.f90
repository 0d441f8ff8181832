!> Finds the instants at which the crank passes an angle or turns back, on the interpolant of the last step of a method.
module crank_passage
  use kinds, only: dp
  use ode_method, only: ode_method_t
  use root_search, only: bracket_t, next_abscissa, narrow
  use scene_problem, only: scene_t
  implicit none
  private
  public :: find_passage, find_turning

contains

  !> Find the first time between t_from and t_to, both inside the last step, at which the crank is at or beyond `target`. The crank
  !> must be beyond it at t_to; if it is beyond it at t_from already, the result is t_from. The state at that time is returned in y.
  subroutine find_passage(method, scene, target, sense, t_from, t_to, closeness, t, y)
    class(ode_method_t), intent(inout) :: method
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: target         !! crank angle [rad]
    real(dp), intent(in) :: sense          !! 1: beyond means larger angles, -1: smaller ones
    real(dp), intent(in) :: t_from, t_to   !! [s]
    real(dp), intent(in) :: closeness  !! tolerance of the time, relative to the length of the step; 0: as close as rounding allows
    real(dp), intent(out) :: t             !! [s]
    real(dp), intent(inout) :: y(:)
    type(bracket_t) :: bracket
    bracket = bracket_t(t_from, t_to, beyond(t_from), max(0.0_dp, beyond(t_to)), 0, abs(t_to - method%t_old))
    t = t_from
    if (bracket%fa < 0) then
      do while (abs(bracket%b - bracket%a) > closeness*bracket%width .and. bracket%fb > 0)
        t = next_abscissa(bracket)
        if (.not. (t > bracket%a .and. t < bracket%b)) exit
        call narrow(bracket, t, beyond(t))
      end do
      t = bracket%b
    end if
    call method%interpolate(t, y)

  contains

    !> Angle by which the crank is beyond its target at a time [rad].
    real(dp) function beyond(time)
      real(dp), intent(in) :: time
      call method%interpolate(time, y)
      beyond = sense*(scene%crank_angle(time, y) - target)
    end function beyond
  end subroutine find_passage

  !> Whether a free crank turns back between t_from and t_to, both inside the last step, and the time at which it does.
  subroutine find_turning(method, scene, t_from, t_to, turns, t, y)
    class(ode_method_t), intent(inout) :: method
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t_from, t_to   !! [s]
    logical, intent(out) :: turns
    real(dp), intent(out) :: t             !! [s]; t_to if it does not turn back
    real(dp), intent(inout) :: y(:)        !! work space for a state
    type(bracket_t) :: bracket
    real(dp) :: speed_from, speed_to
    t = t_to
    call method%interpolate(t_from, y)
    speed_from = scene%crank_speed(t_from, y)
    call method%interpolate(t_to, y)
    speed_to = scene%crank_speed(t_to, y)
    turns = (speed_from > 0 .and. speed_to < 0) .or. (speed_from < 0 .and. speed_to > 0)
    if (.not. turns) return
    bracket = bracket_t(t_from, t_to, -abs(speed_from), abs(speed_to), 0, abs(t_to - t_from))
    do
      t = next_abscissa(bracket)
      if (.not. (t > bracket%a .and. t < bracket%b)) exit
      call method%interpolate(t, y)
      call narrow(bracket, t, sign(1.0_dp, speed_to)*scene%crank_speed(t, y))
      if (.not. bracket%fb > 0) exit
    end do
    t = bracket%b
  end subroutine find_turning
end module crank_passage
