!> Follows the pressure of the gas, the speed of the crank and the angle of a floating pin: their extremes in each revolution,
!> searched inside the steps.
module machine_record
  use kinds, only: dp
  use chain_motion, only: body_pin
  use ode_method, only: ode_method_t
  use scene_problem, only: scene_t, evaluation_t
  use peak_search, only: sample_t, peak_search_t, may_peak
  use cycle_statistics, only: cycle_t
  implicit none
  private
  public :: machine_record_t, turning_point

  !> Quantities that are searched: the pressure, the speed and its negative.
  integer, parameter :: of_pressure = 1, of_speed = 2, of_negative_speed = 3

  type :: machine_record_t
    private
    real(dp) :: t = 0                                     !! end of the last interval that was searched [s]
    real(dp) :: angle = 0, speed = 0, acceleration = 0    !! of the crank at that time [rad], [rad/s], [rad/s^2]
    real(dp) :: pin_angle = 0, pin_speed = 0              !! of a floating pin [rad], [rad/s]
  contains
    procedure, non_overridable :: begin
    procedure, non_overridable :: search
  end type machine_record_t

contains

  !> Let the next interval begin at t, where the scene has been evaluated.
  pure subroutine begin(self, scene, t, now)
    class(machine_record_t), intent(inout) :: self
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t
    type(evaluation_t), intent(in) :: now
    self%t = t
    self%angle = now%motion%crank_angle
    self%speed = now%motion%crank_speed
    self%acceleration = 0
    if (scene%crank_moves) self%acceleration = now%accelerations%crank
    if (.not. allocated(scene%chain%floating)) return
    self%pin_angle = now%motion%pin_angle
    self%pin_speed = now%motion%turning(body_pin)
  end subroutine begin

  !> Search between the end of the last interval and t, where the scene is evaluated. Both must lie inside the last step.
  subroutine search(self, method, scene, t, now, cycle)
    class(machine_record_t), intent(inout) :: self
    class(ode_method_t), intent(inout) :: method
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t
    type(evaluation_t), intent(in) :: now
    type(cycle_t), intent(inout) :: cycle   !! extremes of the present revolution
    type(machine_record_t) :: next
    call next%begin(scene, t, now)
    if (allocated(scene%gas)) call search_one(of_pressure, cycle%max_pressure, cycle%max_pressure_angle)
    if (scene%crank_moves) then
      call search_one(of_speed, cycle%max_speed)
      call search_one(of_negative_speed, cycle%max_negative_speed)
    else
      cycle%max_speed = max(cycle%max_speed, next%speed)
      cycle%max_negative_speed = max(cycle%max_negative_speed, -next%speed)
    end if
    if (allocated(scene%chain%floating)) call follow_pin(self, next, cycle)
    call self%begin(scene, t, now)

  contains

    !> Search the largest value of a quantity, if it may exceed `largest`.
    subroutine search_one(quantity, largest, angle)
      integer, intent(in) :: quantity
      real(dp), intent(inout) :: largest
      real(dp), intent(inout), optional :: angle   !! crank angle there [rad]
      type(peak_search_t) :: peak
      type(sample_t) :: left, right
      left = sample_at(self, scene, quantity)
      right = sample_at(next, scene, quantity)
      call peak%begin(left, right)
      if (left%slope > 0 .and. right%slope < 0) then
        if (may_peak(left%t, left%value, left%slope, right%t, right%value, right%slope, largest)) call climb(quantity, peak)
      end if
      if (.not. peak%value(1) > largest) return
      largest = peak%value(1)
      if (present(angle)) angle = angle_at(peak%t(1))
    end subroutine search_one

    !> Crank angle at a time inside the step [rad].
    real(dp) function angle_at(time)
      real(dp), intent(in) :: time
      real(dp) :: y(scene%n)
      call method%interpolate(time, y)
      angle_at = scene%crank_angle(time, y)
    end function angle_at

    !> Search the peak of a quantity that rises and then falls.
    subroutine climb(quantity, peak)
      integer, intent(in) :: quantity
      type(peak_search_t), intent(inout) :: peak
      real(dp) :: time
      logical :: is_done
      do
        call peak%next_time(time, is_done)
        if (is_done) exit
        call peak%add_value(time, value_at(quantity, time))
      end do
    end subroutine climb

    !> The value of a quantity at a time inside the step.
    real(dp) function value_at(quantity, time) result(value)
      integer, intent(in) :: quantity
      real(dp), intent(in) :: time
      type(machine_record_t) :: point
      type(sample_t) :: sample
      real(dp) :: y(scene%n)
      call method%interpolate(time, y)
      point%angle = scene%crank_angle(time, y)
      point%speed = scene%crank_speed(time, y)
      sample = sample_at(point, scene, quantity)
      value = sample%value
    end function value_at
  end subroutine search

  !> Account for the angle of a floating pin between two points: where it turns back, that of the cubic through angles and speeds.
  pure subroutine follow_pin(left, right, cycle)
    type(machine_record_t), intent(in) :: left, right
    type(cycle_t), intent(inout) :: cycle
    real(dp) :: farthest
    farthest = left%pin_angle + turning_point(right%t - left%t, right%pin_angle - left%pin_angle, left%pin_speed, right%pin_speed)
    cycle%max_pin_angle = max(cycle%max_pin_angle, left%pin_angle, right%pin_angle, farthest)
    cycle%min_pin_angle = min(cycle%min_pin_angle, left%pin_angle, right%pin_angle, farthest)
  end subroutine follow_pin

  !> Angle [rad] from the beginning of a span of time to where a rotation turns back, on the cubic through the angle `rise` at its
  !> end and the speeds at both ends; 0 if these have the same sign. The speed of the cubic is
  !> v0 (1 - s)^2 + 2 middle s (1 - s) + v1 s^2.
  pure real(dp) function turning_point(span, rise, v0, v1) result(angle)
    real(dp), intent(in) :: span, rise, v0, v1   !! [s], [rad], [rad/s]
    real(dp) :: middle, s
    angle = 0
    if (.not. (span > 0 .and. v0*v1 < 0)) return
    middle = 3*rise/span - v0 - v1
    s = v0/(v0 - middle + sign(sqrt(middle**2 - v0*v1), v0))
    angle = span*s*(v0*(1 - s + s**2/3) + middle*s*(1 - 2*s/3) + v1*s**2/3)
  end function turning_point

  !> Value and slope of a quantity at a point.
  pure type(sample_t) function sample_at(point, scene, quantity) result(sample)
    type(machine_record_t), intent(in) :: point
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: quantity
    sample%t = point%t
    select case (quantity)
    case (of_pressure)
      sample%value = scene%gas%pressure(point%angle)
      sample%slope = scene%gas%force_slope(point%angle)/scene%gas%cylinder%area*point%speed
    case (of_speed)
      sample%value = point%speed
      sample%slope = point%acceleration
    case default
      sample%value = -point%speed
      sample%slope = -point%acceleration
    end select
  end function sample_at
end module machine_record
