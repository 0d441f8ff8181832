!> Limits that end a run which does not get on: the time for a turn of the crank, and the number of evaluations in a revolution.
module run_limits
  use kinds, only: dp
  use constants, only: two_pi
  use crank_turns, only: turn_limit_t
  use case_definition, only: case_t
  use scene_builder, only: longest_turn
  implicit none
  private
  public :: run_limits_t

  type :: run_limits_t
    type(turn_limit_t) :: turn_limit             !! time limit for a turn, if turns of the crank end the run
    integer :: max_evaluations_per_revolution = 0   !! largest number of evaluations in one revolution, or in the time of the first
                                                    !! revolution; 0: no limit
    real(dp) :: revolution_time = huge(1.0_dp)      !! duration of a revolution at the starting speed [s]
    logical :: over_budget = .false.                !! the run is to end because that number was exceeded
    integer, private :: evaluations_then = 0        !! number of evaluations at the beginning of the present revolution
    real(dp), private :: time_then = 0, travel_then = 0   !! time [s] and crank travel [rad] at that beginning
  contains
    procedure :: choose
    procedure :: follow
  end type run_limits_t

contains

  !> The limits of a case; `revolution_time` is the duration of a revolution at the starting speed [s].
  subroutine choose(self, case, revolution_time)
    class(run_limits_t), intent(inout) :: self
    type(case_t), intent(in) :: case
    real(dp), intent(in) :: revolution_time
    self%turn_limit%longest = longest_turn(case)
    self%max_evaluations_per_revolution = case%integrator%max_evaluations_per_revolution
    self%revolution_time = revolution_time
  end subroutine choose

  !> Account for an accepted point. A revolution that takes longer than the first would have taken is counted as ended there: a
  !> crank at rest must not use an unlimited number of evaluations.
  subroutine follow(self, time, travel, evaluations)
    class(run_limits_t), intent(inout) :: self
    real(dp), intent(in) :: time, travel   !! [s], [rad]
    integer, intent(in) :: evaluations     !! number so far
    call self%turn_limit%follow(time, abs(travel)/two_pi)
    if (self%max_evaluations_per_revolution <= 0) return
    if (abs(travel - self%travel_then) >= two_pi .or. time - self%time_then >= self%revolution_time) then
      self%travel_then = travel
      self%time_then = time
      self%evaluations_then = evaluations
    end if
    self%over_budget = evaluations - self%evaluations_then >= self%max_evaluations_per_revolution
  end subroutine follow
end module run_limits
