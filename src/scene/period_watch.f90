!> Detects a periodic motion: each time the crank completes a revolution, the state is compared with the states one to sixteen
!> revolutions earlier.
!>
!> Positions, rates and first-order states are compared, without the angles of crank and floating pin and the quadratures, each
!> relative to its range in the last revolutions. The motion has the period p (the shortest possible) if for three consecutive
!> periods every state differs from that p revolutions earlier by at most the tolerance, and the remaining change is expected to be
!> at most that too: differences d that shrink by the factor q from period to period leave d q/(1 - q). Without this second
!> condition a motion that approaches its limit slowly would be accepted too early. It holds for the largest difference, and for
!> each component that moves in one sense: the speed of a heavy flywheel may drift behind larger differences that vanish soon.
!> Differences below a hundredth of the tolerance are not tested for this, since they are errors of the integration. Periods are
!> multiples of the period of the gas.
!>
!> A motion that approaches its limit from alternating sides has small differences over two periods first. Before a period is told,
!> its divisors are tested: one over which the states differ by the tolerance at most is the period; one over which they still
!> approach each other is waited for. Differences over the divisor of a true period become constant.
module period_watch
  use kinds, only: dp
  use constants, only: two_pi
  use case_definition, only: case_t
  use scene_problem, only: scene_t
  use run_length, only: longest_period
  implicit none
  private
  public :: period_watch_t, noise

  integer, parameter :: repeats_needed = 3                                !! consecutive periods that must agree
  integer, parameter :: depth = (repeats_needed + 1)*longest_period       !! number of revolutions that are stored
  real(dp), parameter :: least_range = 1e-3_dp  !! least range of a component, relative to its natural size, so that a component at
                                                !! rest does not require infinite accuracy
  real(dp), parameter :: resolved = 10          !! of a bearing by itself: least difference that is told from an error of the
                                                !! integration, over the tolerance of that
  real(dp), parameter :: near = 5               !! over the tolerance: smaller differences over a divisor are waited for while they
                                                !! shrink at all
  real(dp), parameter :: approaching = 0.9_dp   !! larger ones, while they have shrunk to less than this part in up to 32
                                                !! revolutions: errors of the integration change them by less
  integer, parameter :: moves = 8               !! revolutions, or three periods, that show a drift: errors change their sense
  real(dp), parameter :: noise = 1e-2_dp            !! differences due to the integration, relative to the tolerance

  type :: period_watch_t
    logical :: is_on = .false.             !! a periodic motion ends the run; else the revolutions are only compared
    integer :: longest = longest_period    !! longest period searched [revolutions]
    real(dp) :: tolerance = 0
    real(dp) :: integration_tolerance = 0         !! relative tolerance of the integration
    integer :: most_revolutions = 0        !! largest number of revolutions of the run
    logical :: keeps_one_more = .false.    !! the run continues for one more period, the window of the output
    integer :: period = 0                  !! found [revolutions]; 0: none
    integer :: found_after = 0             !! number of revolutions made when it was found
    real(dp) :: difference = 0             !! difference between states one period apart at that time, relative to their ranges
    real(dp) :: duration = 0               !! duration of the period [s]
    logical :: has_ended = .false.         !! the run is to end at (t, y)
    integer :: window_after = -1           !! number of revolutions made when the window began; -1: it has not begun
    real(dp) :: window_start = huge(1.0_dp)   !! [s]
    real(dp) :: t = 0                      !! time at which the crank completed the last revolution [s]
    integer :: forcing = 1                 !! period of the excitation [revolutions]
    integer :: made = 0           !! number of complete revolutions
    integer, private :: earlier = 0        !! number of revolutions before the beginning
    integer, allocatable, private :: at(:)       !! indices of the components that are compared
    real(dp), allocatable, private :: natural_size(:), smallest_range(:)
    real(dp), allocatable, private :: turning(:)  !! 1 for an angle that grows with the crank angle, which is subtracted from it;
                                                  !! else 0
    logical, allocatable, private :: is_slow(:)   !! temperatures
    real(dp), allocatable, private :: states(:, :), low(:, :), high(:, :)  !! states and ranges of revolution k, in column mod(k,
                                                                           !! depth)
    real(dp), private :: times(0:depth - 1) = 0
  contains
    procedure :: choose
    procedure :: begin
    procedure :: record_point
    procedure :: end_revolution
    procedure :: change
    procedure :: fast_change
    procedure :: range_of
    procedure :: restate
    procedure :: cycle_revolutions
  end type period_watch_t

contains

  !> Revolutions of a cycle: the period of the motion if one was found, else that of the gas or of a given load, else 1.
  pure integer function cycle_revolutions(self) result(revolutions)
    class(period_watch_t), intent(in) :: self
    revolutions = merge(self%period, self%forcing, self%period > 0)
  end function cycle_revolutions

  !> The search that a case asks for.
  subroutine choose(self, case)
    class(period_watch_t), intent(inout) :: self
    type(case_t), intent(in) :: case
    self%is_on = case%run%is_until_periodic()
    self%longest = case%run%period_revolutions
    self%tolerance = case%run%periodic_tolerance
    self%integration_tolerance = case%integrator%relative_tolerance
    self%most_revolutions = case%run%most_revolutions
    self%keeps_one_more = self%is_on .and. case%output%window == 'last_period'
  end subroutine choose

  !> Begin with a scene at (t, y). Revolutions that it has made before count as a part of the largest number.
  subroutine begin(self, scene, t, y)
    class(period_watch_t), intent(inout) :: self
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t, y(:)
    real(dp) :: scales(scene%n)
    logical :: growing(scene%n)
    integer :: i
    self%at = scene%compared_states()
    call scene%layout%natural_scales(scales, growing)
    self%natural_size = scales(self%at)
    self%turning = merge(1.0_dp, 0.0_dp, growing(self%at))
    allocate (self%is_slow(size(self%at)), source=.false.)
    self%smallest_range = least_range*self%natural_size
    do i = 1, size(scene%joints)
      if (allocated(scene%joints(i)%heat)) where (self%at == scene%joints(i)%heat%at%first) self%is_slow = .true.
    end do
    if (allocated(scene%given_load)) then   ! a load that is constant lets its bearing come to rest
      where (.not. self%is_slow) self%smallest_range = max(self%smallest_range, &
        min(1.0_dp, resolved*self%integration_tolerance/max(self%tolerance, tiny(1.0_dp)))*self%natural_size)
    end if
    self%forcing = scene%forced_revolutions()
    self%earlier = int(abs(scene%crank_angle(t, y) - scene%start_angle)/two_pi)
    allocate (self%states(size(self%at), 0:depth - 1), source=0.0_dp)
    allocate (self%low(size(self%at), 0:depth - 1), source=huge(1.0_dp))
    allocate (self%high(size(self%at), 0:depth - 1), source=-huge(1.0_dp))
  end subroutine begin

  !> Account for an accepted point of the present revolution.
  pure subroutine record_point(self, y, crank_angle)
    class(period_watch_t), intent(inout) :: self
    real(dp), intent(in) :: y(:)
    real(dp), intent(in) :: crank_angle   !! [rad]
    real(dp) :: value
    integer :: place, i
    place = mod(self%made + 1, depth)
    do i = 1, size(self%at)
      value = y(self%at(i)) - self%turning(i)*crank_angle
      self%low(i, place) = min(self%low(i, place), value)
      self%high(i, place) = max(self%high(i, place), value)
    end do
  end subroutine record_point

  !> Account for the end of a revolution at (t, y). Decide whether the run is to end there (`has_ended`), or the window of the
  !> output to begin (`window_start`).
  subroutine end_revolution(self, t, y, crank_angle)
    class(period_watch_t), intent(inout) :: self
    real(dp), intent(in) :: t, y(:)
    real(dp), intent(in) :: crank_angle   !! [rad]
    integer :: next
    self%made = self%made + 1
    self%t = t
    associate (now => mod(self%made, depth))
      self%states(:, now) = y(self%at) - self%turning*crank_angle
      self%times(now) = t
      next = mod(self%made + 1, depth)
      self%low(:, next) = self%states(:, now)
      self%high(:, next) = self%states(:, now)
    end associate
    if (.not. self%is_on) return
    if (self%window_after >= 0) then
      if (self%period > 0) self%has_ended = self%made >= self%window_after + self%period
      return
    end if
    call look_for_period(self)
    if (.not. self%keeps_one_more) then
      self%has_ended = self%period > 0
    else if (self%period > 0 .or. self%made + self%earlier >= self%most_revolutions - self%longest) then
      self%window_after = self%made
      self%window_start = self%t
    end if
  end subroutine end_revolution

  !> Largest difference of the state from that p revolutions earlier, at the ends of the last p revolutions, over the range of each
  !> component in these; negative if fewer than 2 p revolutions are complete.
  pure real(dp) function change(self, p)
    class(period_watch_t), intent(in) :: self
    integer, intent(in) :: p
    real(dp) :: range(size(self%at))
    integer :: k
    change = -1
    if (self%made < 2*p) return
    change = 0
    range = self%smallest_range
    do k = self%made - p + 1, self%made
      range = max(range, self%high(:, mod(k, depth)) - self%low(:, mod(k, depth)))
    end do
    do k = self%made - p + 1, self%made
      if (k - p < 1) cycle   ! the start is not stored
      change = max(change, maxval(abs(self%states(:, mod(k, depth)) - self%states(:, mod(k - p, depth)))/range))
    end do
  end function change

  !> Largest difference of the state from that p revolutions earlier, without the temperatures, over the range of each component in
  !> the last p revolutions and at least its natural size, since it follows the temperatures; large if the run is too short.
  pure real(dp) function fast_change(self, p) result(change)
    class(period_watch_t), intent(in) :: self
    integer, intent(in) :: p
    real(dp) :: range(size(self%at))
    integer :: k
    change = huge(change)
    if (self%made - p < 1) return   ! the start is not stored
    range = self%natural_size
    do k = self%made - p + 1, self%made
      range = max(range, self%high(:, mod(k, depth)) - self%low(:, mod(k, depth)))
    end do
    associate (now => self%states(:, mod(self%made, depth)), then => self%states(:, mod(self%made - p, depth)))
      change = maxval(abs(now - then)/range, .not. self%is_slow)
    end associate
  end function fast_change

  !> Least range of the component of the state with this index.
  pure real(dp) function range_of(self, index)
    class(period_watch_t), intent(in) :: self
    integer, intent(in) :: index
    range_of = self%smallest_range(findloc(self%at, index, 1))
  end function range_of

  !> The state at the end of the last revolution has been changed.
  subroutine restate(self, y, crank_angle)
    class(period_watch_t), intent(inout) :: self
    real(dp), intent(in) :: y(:), crank_angle
    integer :: next
    next = mod(self%made + 1, depth)
    self%states(:, mod(self%made, depth)) = y(self%at) - self%turning*crank_angle
    self%low(:, next) = self%states(:, mod(self%made, depth))
    self%high(:, next) = self%low(:, next)
  end subroutine restate

  !> Search the shortest period of the stored states.
  subroutine look_for_period(self)
    class(period_watch_t), intent(inout) :: self
    real(dp) :: range(size(self%at)), newest, oldest, any_of_them, factor
    integer :: p, k, told, span
    do p = self%forcing, self%longest, self%forcing
      if (self%made < (repeats_needed + 1)*p) return
      range = self%smallest_range
      do k = self%made - p + 1, self%made
        range = max(range, self%high(:, mod(k, depth)) - self%low(:, mod(k, depth)))
      end do
      newest = largest(self%made - p + 1, self%made, p)
      if (newest > self%tolerance) cycle
      any_of_them = largest(self%made - repeats_needed*p + 1, self%made, p)
      if (any_of_them > self%tolerance) cycle
      oldest = largest(self%made - repeats_needed*p + 1, self%made - (repeats_needed - 1)*p, p)
      if (newest > noise*self%tolerance) then
        if (.not. newest < oldest) cycle
        factor = (newest/oldest)**(1.0_dp/(repeats_needed - 1))
        if (newest*factor > self%tolerance*(1 - factor)) cycle
        if (drifts(p)) cycle
      end if
      do told = self%forcing, p - 1, self%forcing   ! the divisors
        if (mod(p, told) /= 0) cycle
        newest = largest(self%made - p + 1, self%made, told)
        if (newest <= self%tolerance) exit
        if (newest <= near*self%tolerance .and. newest < largest(self%made - 2*p + 1, self%made - p, told)) return
        span = p*(min(depth/2, self%made - p - told)/p)
        if (newest < approaching*largest(self%made - span - p + 1, self%made - span, told)) return
      end do
      told = min(told, p)
      self%period = told
      self%found_after = self%made
      self%difference = largest(self%made - told + 1, self%made, told)
      self%duration = self%times(mod(self%made, depth)) - self%times(mod(self%made - told, depth))
      return
    end do

  contains

    !> Whether a component has moved in one sense from period to period and so little slower each time that what is to come exceeds
    !> the tolerance.
    logical function drifts(period)
      integer, intent(in) :: period
      real(dp) :: moved(min(max(moves, repeats_needed*period), self%made - period, depth - period)), factor
      integer :: i, j, n
      n = size(moved)
      drifts = .false.
      do i = 1, size(range)
        moved = [(self%states(i, mod(self%made - j, depth)) - self%states(i, mod(self%made - j - period, depth)), j=0, n - 1)]
        moved = moved/range(i)
        if (abs(moved(1)) <= noise*self%tolerance .or. any(.not. moved*moved(1) > 0)) cycle
        factor = (moved(1)/moved(1 + (repeats_needed - 1)*period))**(1.0_dp/(repeats_needed - 1))
        drifts = abs(moved(1))*factor > self%tolerance*(1 - factor)
        if (drifts) return
      end do
    end function drifts

    !> Largest difference of states `first` to `last` from those some revolutions earlier, relative to the ranges of their
    !> components.
    real(dp) function largest(first, last, earlier)
      integer, intent(in) :: first, last, earlier
      integer :: j
      largest = 0
      do j = first, last
        largest = max(largest, maxval(abs(self%states(:, mod(j, depth)) - self%states(:, mod(j - earlier, depth)))/range))
      end do
    end function largest
  end subroutine look_for_period
end module period_watch
