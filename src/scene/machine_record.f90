!> Follows the largest pressure of the gas in each revolution. It is searched inside the steps, over the crank angle, on which it
!> depends alone.
module machine_record
  use kinds, only: dp
  use constants, only: degree
  use scene_problem, only: scene_t, evaluation_t
  use working_gas, only: working_gas_t
  use peak_search, only: sample_t, peak_search_t, may_peak
  use cycle_statistics, only: cycle_t
  implicit none
  private
  public :: machine_record_t, turning_point

  !> Largest turn of the crank in which the pressure has at most one peak [rad].
  real(dp), parameter :: short_turn = degree

  type :: machine_record_t
    private
    real(dp) :: t = 0                                     !! end of the last interval that was searched [s]
    real(dp) :: angle = 0, speed = 0                      !! of the crank at that time [rad], [rad/s]
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
  end subroutine begin

  !> Search between the end of the last interval and t, where the scene is evaluated. Both must lie inside the last step.
  subroutine search(self, scene, t, now, cycle)
    class(machine_record_t), intent(inout) :: self
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t
    type(evaluation_t), intent(in) :: now
    type(cycle_t), intent(inout) :: cycle   !! extremes of the present revolution
    type(machine_record_t) :: next
    call next%begin(scene, t, now)
    if (allocated(scene%gas) .and. .not. scene%has_charge) call search_pressure(scene%gas, self, next, cycle)
    call self%begin(scene, t, now)
  end subroutine search

  !> Search the largest pressure of the gas between two points. It follows from the crank angle alone, which may turn back between
  !> them.
  subroutine search_pressure(gas, left, right, cycle)
    type(working_gas_t), intent(in) :: gas
    type(machine_record_t), intent(in) :: left, right
    type(cycle_t), intent(inout) :: cycle
    real(dp) :: farthest
    farthest = left%angle + turning_point(right%t - left%t, right%angle - left%angle, left%speed, right%speed)
    call search_turn(gas, left%angle, farthest, cycle)
    call search_turn(gas, farthest, right%angle, cycle)
  end subroutine search_pressure

  !> Search the largest pressure between two crank angles, turn by short turn.
  subroutine search_turn(gas, from, to, cycle)
    type(working_gas_t), intent(in) :: gas
    real(dp), intent(in) :: from, to   !! [rad]
    type(cycle_t), intent(inout) :: cycle
    type(peak_search_t) :: peak
    type(sample_t) :: left, right
    real(dp) :: angle, way
    logical :: is_done
    integer :: i, n
    n = max(1, ceiling(abs(to - from)/short_turn))
    way = sign(1.0_dp, to - from)
    left = sample_t(way*from, gas%pressure(from), way*slope_at(from))
    do i = 1, n
      angle = from + i*(to - from)/n
      right = sample_t(way*angle, gas%pressure(angle), way*slope_at(angle))
      call peak%begin(left, right)
      is_done = .not. may_peak(left%t, left%value, left%slope, right%t, right%value, right%slope, cycle%max_pressure)
      do while (.not. is_done)
        call peak%next_time(angle, is_done)
        if (.not. is_done) call peak%add_value(angle, gas%pressure(way*angle))
      end do
      if (peak%value(1) > cycle%max_pressure) cycle%max_pressure_angle = way*peak%t(1)
      cycle%max_pressure = max(cycle%max_pressure, peak%value(1))
      left = right
    end do

  contains

    !> Slope of the pressure over the crank angle [Pa/rad].
    pure real(dp) function slope_at(angle)
      real(dp), intent(in) :: angle
      slope_at = gas%force_slope(angle)/gas%cylinder%area
    end function slope_at
  end subroutine search_turn

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
end module machine_record
