!> The load of a bearing without a mechanism: constant, or a table over the crank angle, and the bodies with which the load, the
!> journal and the bearing turn.
!>
!> The rod has the angle A from the axis of the cylinder, sin A = crank_to_rod sin q. The axes of the load are fixed (x along the
!> cylinder, towards the crank angle 0), turn with the crank (x from its axis to its pin), or with the rod (x from the crank pin to
!> the piston pin).
module bearing_load
  use kinds, only: dp
  use constants, only: degree
  use model_parameters, only: has_parameters_t, parameter_list_t, any_angle
  use measured_curve, only: measured_curve_t
  use monotone_cubic, only: monotone_cubic_t, new_periodic_cubic
  implicit none
  private
  public :: bearing_load_t

  character(len=*), parameter :: bodies = 'fixed, crank, rod'

  type, extends(has_parameters_t) :: bearing_load_t
    type(measured_curve_t) :: curve          !! crank angle [degrees] and load [N], or its two components, within one period
    real(dp) :: load(2) = 0                  !! constant, instead of the table [N]
    integer :: period_deg = 0
    real(dp) :: offset_deg = 0               !! crank angle at angle 0 of the table
    real(dp) :: direction_deg = 0            !! of the axis x of the table from that of the frame, towards y
    real(dp) :: factor = 1                   !! multiplies the load
    character(len=:), allocatable :: frame, journal, bearing   !! fixed, crank or rod
    real(dp) :: crank_to_rod = 0             !! crank length over rod length
    character(len=:), allocatable :: interpolation   !! linear or cubic
    ! set by `prepare`
    real(dp), private :: period = 0          !! [rad]
    real(dp), allocatable, private :: angle(:), force(:, :)   !! rows (0:n) with that of the next period [rad], (2, 0:n) [N]
    type(monotone_cubic_t), allocatable, private :: cubic(:)  !! of both components; not allocated: linear between the rows
    ! state: where the crank is
    integer, private :: row = 0              !! the row before the crank
    integer, private :: turn = 0             !! periods made
  contains
    procedure :: parameters
    procedure :: revolutions
    procedure :: is_steady
    procedure :: needs_rod
    procedure :: prepare
    procedure :: start
    procedure :: n_events
    procedure :: event
    procedure :: pass
    procedure :: at
  end type bearing_load_t

contains

  subroutine parameters(self, list)
    class(bearing_load_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call self%curve%parameters(list, 'table', &
      'CSV file with columns crank_angle[deg],load[N] or crank_angle[deg],load_x[N],load_y[N], path relative to the case file', &
      default='', example='load.csv')
    call list%add('load', self%load, 'constant load along x and y of the frame, instead of table', 'N', default='0.0', &
      usual='0.1 to 1e7')
    call list%add('period_deg', self%period_deg, 'period of the table, a multiple of 360 degrees', '>= 360 and <= 5760', '720')
    call list%add('offset_deg', self%offset_deg, 'crank angle of the simulation at angle 0 of the table', 'degrees', &
      '>= -5760 and <= 5760', '0.0', usual='0 to 5760')
    call list%add('direction_deg', self%direction_deg, &
      'turns the load, with one column its direction, from x towards y of the frame', 'degrees', any_angle, &
      default='0.0', usual='0 to 720')
    call list%add('factor', self%factor, 'multiplies the load', range='> 0', default='1.0', usual='1e-6 to 1e6')
    call list%word('frame', self%frame, bodies, 'fixed', &
      'axes of the load: fixed; crank: x from its axis to its pin; rod: x from the crank pin to the piston pin')
    call list%word('journal', self%journal, bodies, 'crank', 'the body with which the journal turns')
    call list%word('bearing', self%bearing, bodies, 'fixed', 'the body with which the bearing turns')
    call list%add('crank_to_rod', self%crank_to_rod, 'crank length over rod length; required where rod is named', &
      range='> 0 and < 1', default='0.0', usual='0.05 to 0.7')
    call list%word('interpolation', self%interpolation, 'linear, cubic', 'linear', &
      'between the rows; cubic: monotone, with a continuous slope')
  end subroutine parameters

  !> Number of revolutions after which the load repeats.
  pure integer function revolutions(self)
    class(bearing_load_t), intent(in) :: self
    revolutions = self%period_deg/360
  end function revolutions

  !> Whether a film in a bearing that does not turn, whose pin turns evenly with an even crank, always has the same load.
  pure logical function is_steady(self)
    class(bearing_load_t), intent(in) :: self
    is_steady = .not. self%curve%is_wanted() .and. self%frame == 'fixed' .and. self%journal == 'crank' .and. self%bearing == 'fixed'
  end function is_steady

  !> Whether one of the bodies is the rod.
  pure logical function needs_rod(self)
    class(bearing_load_t), intent(in) :: self
    needs_rod = self%frame == 'rod' .or. self%journal == 'rod' .or. self%bearing == 'rod'
  end function needs_rod

  !> Prepare for the table that has been read, or for the constant load.
  subroutine prepare(self)
    class(bearing_load_t), intent(inout) :: self
    real(dp) :: turned(2, 2), direction
    integer :: i, n
    if (.not. self%curve%is_wanted()) then   ! one row
      self%curve%x = [0.0_dp]
      self%curve%y = self%load(:1)
      self%curve%z = self%load(2:)
    end if
    n = size(self%curve%x)
    direction = self%direction_deg*degree
    turned = self%factor*reshape([cos(direction), sin(direction), -sin(direction), cos(direction)], [2, 2])
    self%period = self%period_deg*degree
    allocate (self%angle(0:n), self%force(2, 0:n))
    self%angle(:n - 1) = (self%curve%x + self%offset_deg)*degree
    do i = 0, n - 1
      self%force(:, i) = matmul(turned, [self%curve%y(i + 1), self%curve%z(i + 1)])
    end do
    self%angle(n) = self%angle(0) + self%period
    self%force(:, n) = self%force(:, 0)
    if (self%interpolation /= 'cubic' .or. n == 1) return
    allocate (self%cubic(2))
    do i = 1, 2
      self%cubic(i) = new_periodic_cubic(self%angle(:n - 1), self%force(i, :n - 1), self%period)
    end do
  end subroutine prepare

  !> Begin at a crank angle [rad] and a speed [rad/s]; at a row, within rounding, the speed decides on which side of it.
  pure subroutine start(self, crank_angle, speed)
    class(bearing_load_t), intent(inout) :: self
    real(dp), intent(in) :: crank_angle, speed
    real(dp) :: along
    self%turn = floor((crank_angle - self%angle(0))/self%period)
    along = crank_angle - self%turn*self%period
    self%row = count(self%angle(1:ubound(self%angle, 1) - 1) <= along)
    if (speed < 0 .and. distance(self, self%row, crank_angle) <= 0) call step(self, -1)
    if (speed > 0 .and. -distance(self, self%row + 1, crank_angle) <= 0) call step(self, 1)
  end subroutine start

  !> Angle from a row to the crank [rad], 0 within rounding.
  pure real(dp) function distance(self, row, crank_angle)
    class(bearing_load_t), intent(in) :: self
    integer, intent(in) :: row
    real(dp), intent(in) :: crank_angle
    distance = crank_angle - (self%angle(row) + self%turn*self%period)
    if (abs(distance) <= 8*epsilon(1.0_dp)*max(1.0_dp, abs(crank_angle))) distance = 0
  end function distance

  !> Go on to the next row (1) or back to the row before (-1).
  pure subroutine step(self, way)
    class(bearing_load_t), intent(inout) :: self
    integer, intent(in) :: way
    self%row = self%row + way
    if (self%row == ubound(self%angle, 1)) then
      self%row = 0
      self%turn = self%turn + 1
    else if (self%row < 0) then
      self%row = ubound(self%angle, 1) - 1
      self%turn = self%turn - 1
    end if
  end subroutine step

  !> Number of event functions: the load of a linear table has a kink at each row, a constant one has none.
  pure integer function n_events(self)
    class(bearing_load_t), intent(in) :: self
    n_events = merge(0, 1, allocated(self%cubic) .or. size(self%angle) == 2)
  end function n_events

  !> The passage of the next row in the sense of the crank speed [rad], and its rate.
  pure subroutine event(self, crank_angle, speed, g, g_rate)
    class(bearing_load_t), intent(in) :: self
    real(dp), intent(in) :: crank_angle, speed
    real(dp), intent(out) :: g, g_rate
    integer :: next
    next = self%row + merge(1, 0, speed >= 0)
    g = sign(1.0_dp, speed)*(crank_angle - (self%angle(next) + self%turn*self%period))
    g_rate = abs(speed)
  end subroutine event

  !> The crank has passed that row.
  pure subroutine pass(self, speed)
    class(bearing_load_t), intent(inout) :: self
    real(dp), intent(in) :: speed
    call step(self, merge(1, -1, speed >= 0))
  end subroutine pass

  !> The load of the journal on its bearing in the axes of the frame [N]. A linear table is continued beyond the present rows, so
  !> that the load is smooth in a step.
  pure function at(self, crank_angle) result(load)
    class(bearing_load_t), intent(in) :: self
    real(dp), intent(in) :: crank_angle   !! [rad]
    real(dp) :: load(2)
    real(dp) :: share
    if (allocated(self%cubic)) then
      load = [self%cubic(1)%value(crank_angle), self%cubic(2)%value(crank_angle)]
    else
      associate (i => self%row)
        share = (crank_angle - (self%angle(i) + self%turn*self%period))/(self%angle(i + 1) - self%angle(i))
        load = self%force(:, i) + share*(self%force(:, i + 1) - self%force(:, i))
      end associate
    end if
  end function at
end module bearing_load
