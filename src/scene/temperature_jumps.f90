!> Jumps of the temperatures of films to their settled values, in a run until the motion is periodic. A film settles over
!> thousands of cycles, the rest of the motion within some: after a cycle in which the other states repeat, each temperature is set
!> to where its change in a cycle is expected to be 0.
!>
!> The first jump follows from the heat that leaves for each kelvin, u = rho c_p Q + G: over a cycle T' = -u (T - T_s)/C with mean u
!> gives T_s = T + dT/(1 - exp(-Int u dt/C)). Later ones follow by the secant through the last two changes. The settled temperature
!> does not depend on the jumps, since the motion must repeat over plain cycles after the last one. Of jumps that the tolerance of
!> the integration may explain ("small") only a few are made; more only while each is smaller than half the one before and the
!> temperature still changes from cycle to cycle by more than the errors of the integration.
module temperature_jumps
  use kinds, only: dp
  use film_heat, only: uptake
  use scene_problem, only: scene_t
  use period_watch, only: period_watch_t, noise
  use run_length, only: longest_period
  implicit none
  private
  public :: temperature_jumps_t

  real(dp), parameter :: fast_repeats = 1e-3_dp    !! change of the other states in a cycle, relative to their ranges
  real(dp), parameter :: farthest = 25             !! longest jump [K]
  integer, parameter :: most_small_jumps = 3
  real(dp), parameter :: shrunk = 0.5_dp           !! largest size of a further small jump, relative to the jump before
  integer, parameter :: depth = longest_period + 1

  !> The film of one joint.
  type :: film_t
    logical :: is_known = .false.       !! the following are
    real(dp) :: temperature = 0         !! at the beginning of a former cycle [K]
    real(dp) :: change = 0              !! of it in that cycle [K]
    integer :: small_jumps = 0          !! number of jumps below the error of the settled temperature
    real(dp) :: last_jump = 0           !! size of the last jump, small or not [K]
    real(dp) :: slope = 0               !! of this change over the temperature; 0: not known [-]
    real(dp) :: begin(0:depth - 1) = 0, sum(0:depth - 1) = 0   !! temperature [K] and integral of u [J/K] at the end of revolution
                                                               !! k, in element mod(k, depth)
  end type film_t

  type :: temperature_jumps_t
    logical :: is_due = .false.         !! the integration is to go on with the new temperatures
    real(dp), allocatable, private :: jump(:)        !! of the temperature at each joint [K]
    type(film_t), allocatable, private :: films(:)   !! of each joint
    integer, private :: cycle = 0       !! over which changes are known [revolutions]
    integer, private :: since = -1      !! number of revolutions made when the present temperatures began; -1: the start
  contains
    procedure :: consider
    procedure :: make
  end type temperature_jumps_t

contains

  !> The motion has completed a revolution with the state y: find out whether temperatures are to jump.
  subroutine consider(self, scene, periods, y, tolerances)
    class(temperature_jumps_t), intent(inout) :: self
    type(scene_t), intent(in) :: scene
    type(period_watch_t), intent(in) :: periods
    real(dp), intent(in) :: y(:)
    real(dp), intent(in) :: tolerances(:)   !! of the integration, of each component
    real(dp) :: target, error
    integer :: i, p, made
    made = periods%made
    if (self%since < 0) self%since = made
    if (.not. allocated(self%films)) allocate (self%films(size(scene%joints)), self%jump(size(scene%joints)))
    do i = 1, size(scene%joints)
      if (.not. allocated(scene%joints(i)%heat)) cycle
      associate (heat => scene%joints(i)%heat, film => self%films(i))
        film%begin(mod(made, depth)) = y(heat%at%first)
        film%sum(mod(made, depth)) = y(heat%sums%first + uptake - 1)
      end associate
    end do
    self%jump = 0
    do p = periods%forcing, min(periods%longest, made - self%since), periods%forcing
      if (mod(made - self%since, p) /= 0 .or. periods%fast_change(p) > fast_repeats) cycle   ! at the same phase of the cycle
      if (p /= self%cycle) self%films%is_known = .false.
      if (p /= self%cycle) self%films%slope = 0
      self%cycle = p
      do i = 1, size(scene%joints)
        if (.not. allocated(scene%joints(i)%heat)) cycle
        associate (film => self%films(i), now => mod(made, depth), then => mod(made - p, depth), &
            at => scene%joints(i)%heat%at%first)
          call find_settled(film, film%begin(then), film%begin(now) - film%begin(then), (film%sum(now) - film%sum(then))/ &
            scene%joints(i)%heat%given%heat_capacity, tolerances(at), target, error)
          target = target - film%begin(now)
          if (abs(target) <= error) film%small_jumps = film%small_jumps + 1
          if (film%small_jumps > most_small_jumps .and. (abs(target) >= shrunk*film%last_jump .or. &
            abs(film%change) <= noise*periods%tolerance*periods%range_of(at))) cycle
          if (abs(target) > periods%tolerance*periods%range_of(at)) self%jump(i) = target
          film%last_jump = abs(target)
        end associate
      end do
      exit
    end do
    self%is_due = any(abs(self%jump) > 0)
    if (self%is_due) self%since = made
  end subroutine consider

  !> The settled temperature and its error [K] by the change d of the temperature t in a cycle. The slope of the change over the
  !> temperature is only taken from temperatures that differ by much more than this error, or by so much that errors hardly matter.
  subroutine find_settled(film, t, d, exponent, tolerance, settled, error)
    type(film_t), intent(inout) :: film
    real(dp), intent(in) :: t, d, tolerance   !! [K]; tolerance of d
    real(dp), intent(in) :: exponent          !! Int u dt/C over the cycle
    real(dp), intent(out) :: settled, error
    real(dp), parameter :: apart = 10, far = 0.5_dp   ! over that error; [K]
    real(dp) :: first_slope, slope
    first_slope = exp(-max(exponent, tiny(1.0_dp))) - 1
    if (.not. film%slope < 0) film%slope = first_slope
    if (film%is_known .and. abs(t - film%temperature) > min(apart*tolerance/abs(film%slope), far)) then
      slope = (d - film%change)/(t - film%temperature)
      if (slope < 0) film%slope = slope
    end if
    film%is_known = .true.
    film%temperature = t
    film%change = d
    settled = t - min(max(d/film%slope, -farthest), farthest)
    error = tolerance/abs(film%slope)
  end subroutine find_settled

  !> Make the jumps in a scene and its state.
  subroutine make(self, scene, y)
    class(temperature_jumps_t), intent(inout) :: self
    type(scene_t), intent(inout) :: scene
    real(dp), intent(inout) :: y(:)
    integer :: i
    self%is_due = .false.
    do i = 1, size(scene%joints)
      if (.not. abs(self%jump(i)) > 0) cycle
      associate (heat => scene%joints(i)%heat)
        y(heat%at%first) = y(heat%at%first) + self%jump(i)
        heat%jumped = heat%jumped + self%jump(i)
        heat%jumps = heat%jumps + 1
        self%films(i)%begin(mod(self%since, depth)) = y(heat%at%first)
      end associate
    end do
  end subroutine make
end module temperature_jumps
