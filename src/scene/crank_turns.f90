!> Ends a run when a free crank has made a given number of turns. Turns are counted by the crank angle, not by the time.
!>
!> The crank must not stop or turn back before that. The sense of the turns is that of the starting speed. If the crank starts from
!> rest, it is the sense in which it has first moved by one degree (or by half of the wanted angle, if that is less). A crank that
!> creeps without stopping is stopped by `turn_limit_t`, which limits the time for one turn.
module crank_turns
  use kinds, only: dp
  use constants, only: two_pi, degree
  use ode_problem, only: event_continue, event_stop
  implicit none
  private
  public :: crank_turns_t, new_crank_turns, wear_cycle_t, n_turn_events, all_made, turned_back, turn_limit_t

  integer, parameter :: n_turn_events = 2  !! event functions: the crank angle still to go, and the crank speed against the sense of
                                           !! the turns

  !> State of the count.
  integer, parameter :: on_the_way = 0, all_made = 1, turned_back = 2

  type :: crank_turns_t
    real(dp) :: wanted = 0         !! number of turns
    character(len=29) :: key = '&integrator crank_revolutions'   !! key of the case file that asks for the turns
    integer :: outcome = on_the_way
    real(dp), private :: start_angle = 0
    integer, private :: sense = 0  !! sense of rotation: 1, -1, or 0 if the crank has not left its start yet
  contains
    procedure :: made
    procedure :: events
    procedure :: pass
  end type crank_turns_t

  !> Limit of the time that the crank may take for one turn.
  type :: turn_limit_t
    real(dp) :: longest = huge(1.0_dp)   !! [s]
    logical :: is_over = .false.         !! the limit has been exceeded: the run is to end
    integer, private :: made = 0         !! largest number of whole turns made so far
    real(dp), private :: since = 0       !! time at which they had been made [s]
  contains
    procedure :: begin
    procedure :: follow
    procedure :: limit_end
  end type turn_limit_t

  !> Turns of the crank in either sense after which something is due again.
  type :: wear_cycle_t
    integer :: turns = 1           !! number of turns
    real(dp) :: begin = 0          !! crank angle at which the present ones began [rad]
  contains
    procedure :: event
    procedure :: is_over
  end type wear_cycle_t

contains

  !> A count that begins at the given crank angle.
  pure function new_crank_turns(wanted, start_angle, start_speed) result(turns)
    real(dp), intent(in) :: wanted        !! > 0
    real(dp), intent(in) :: start_angle   !! [rad]
    real(dp), intent(in) :: start_speed   !! [rad/s]
    type(crank_turns_t) :: turns
    turns%wanted = wanted
    turns%start_angle = start_angle
    if (abs(start_speed) > 0) turns%sense = nint(sign(1.0_dp, start_speed))
  end function new_crank_turns

  !> Number of turns between the start and a crank angle, in the sense of the turns.
  pure real(dp) function made(self, crank_angle)
    class(crank_turns_t), intent(in) :: self
    real(dp), intent(in) :: crank_angle   !! [rad]
    made = abs(crank_angle - self%start_angle)/two_pi
  end function made

  !> Event functions of a free crank: it has reached the end of the run (or, from rest, has left its start far enough to know its
  !> sense of rotation), and it turns back. The rate of the second would need an evaluation of the scene. It is not given; the
  !> search for events therefore samples steps in which the speed changes fourfold.
  pure subroutine events(self, crank_angle, crank_speed, g, g_rate)
    class(crank_turns_t), intent(in) :: self
    real(dp), intent(in) :: crank_angle, crank_speed   !! [rad], [rad/s]
    real(dp), intent(out) :: g(n_turn_events), g_rate(n_turn_events)
    real(dp) :: travel
    travel = crank_angle - self%start_angle
    g_rate(2) = 0
    if (self%sense == 0) then
      g = [travel**2 - min(degree, 0.5_dp*two_pi*self%wanted)**2, -1.0_dp]
      g_rate(1) = 2*travel*crank_speed
    else
      g = [self%sense*travel - two_pi*self%wanted, -self%sense*crank_speed]
      g_rate(1) = self%sense*crank_speed
    end if
  end subroutine events

  !> Handle one of the two events.
  pure subroutine pass(self, index, crank_angle, action)
    class(crank_turns_t), intent(inout) :: self
    integer, intent(in) :: index
    real(dp), intent(in) :: crank_angle   !! [rad]
    integer, intent(out) :: action
    action = event_stop
    if (self%sense == 0) then
      self%sense = nint(sign(1.0_dp, crank_angle - self%start_angle))
      action = event_continue
    else
      self%outcome = merge(all_made, turned_back, index == 1)
    end if
  end subroutine pass

  !> Event function of the end of the turns, and its rate.
  pure subroutine event(self, crank_angle, crank_speed, g, g_rate)
    class(wear_cycle_t), intent(in) :: self
    real(dp), intent(in) :: crank_angle, crank_speed   !! [rad], [rad/s]
    real(dp), intent(out) :: g, g_rate
    g = (crank_angle - self%begin)**2 - (two_pi*self%turns)**2
    g_rate = 2*(crank_angle - self%begin)*crank_speed
  end subroutine event

  !> Whether the turns end at a crank angle, within rounding. At the end of a run rounding decides whether the event is met.
  pure logical function is_over(self, crank_angle)
    class(wear_cycle_t), intent(in) :: self
    real(dp), intent(in) :: crank_angle   !! [rad]
    real(dp), parameter :: rounding = 1e-9_dp   !! [rad]
    is_over = abs(abs(crank_angle - self%begin) - two_pi*self%turns) <= rounding
  end function is_over

  !> Begin at time t, `turns` turns away from the start.
  pure subroutine begin(self, t, turns)
    class(turn_limit_t), intent(inout) :: self
    real(dp), intent(in) :: t       !! [s]
    real(dp), intent(in) :: turns   !! >= 0
    self%made = floor(turns)
    self%since = t
  end subroutine begin

  !> Report that the crank is `turns` turns away from its start at time t.
  pure subroutine follow(self, t, turns)
    class(turn_limit_t), intent(inout) :: self
    real(dp), intent(in) :: t       !! [s]
    real(dp), intent(in) :: turns   !! >= 0
    if (turns < self%made + 1) return
    self%made = floor(turns)
    self%since = t
  end subroutine follow

  !> Move t_end to the instant at which the time for the next turn is over, if that is earlier.
  pure subroutine limit_end(self, t_end)
    class(turn_limit_t), intent(inout) :: self
    real(dp), intent(inout) :: t_end   !! [s]
    self%is_over = t_end - self%since > self%longest
    if (self%is_over) t_end = self%since + self%longest
  end subroutine limit_end
end module crank_turns
