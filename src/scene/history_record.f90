!> Records what the film with memory of a joint is given over the last cycle of a run, row by row: the load on the pin and its
!> eccentricity, in the frame of the bearing, and the speed of the pin relative to it. The same of the film of the run stands beside
!> it, for comparison.
module history_record
  use kinds, only: dp
  use constants, only: degree
  use error_handling, only: error_t, fail, status_integration
  use case_definition, only: case_t
  use joint_places, only: place_of
  use film_figures, only: film_figures_t
  use film_history, only: film_history_t, film_duty_t
  use film_law, only: table_watch_t
  use measured_curve, only: measured_curve_t
  use scene_problem, only: scene_t, evaluation_t
  implicit none
  private
  public :: history_record_t

  integer, parameter :: n_values = 10
  integer, parameter :: of_time = 1, of_angle = 2, of_speed = 3, of_x = 4, of_y = 5, of_load_x = 6, of_load_y = 7, &
    of_thickness = 8, of_pressure = 9, of_viscosity = 10

  type :: history_record_t
    integer :: spot = 0                        !! of the joint, see `joint_places`
    type(film_history_t) :: history            !! result of `march`
    type(film_duty_t) :: duty                  !! result: what the film was given
    real(dp), allocatable :: angle(:)          !! result: crank angles of its rows, those of the duty but the first [rad]
    real(dp), allocatable :: quick_thickness(:), quick_pressure(:)   !! result: of the film of the run there [m], [Pa]
    logical, private :: has_load = .true.
    logical, private :: is_steady = .false.    !! nothing changes that the film is given
    real(dp) :: cycle = 0                      !! crank angle of the cycle [rad]
    type(measured_curve_t), private :: feed    !! supply pressure over the crank angle
    real(dp), allocatable, private :: kept(:, :)   !! (quantity, row)
    integer, private :: n = 0                  !! rows kept
  contains
    procedure :: prepare
    procedure :: add
    procedure :: march
  end type history_record_t

contains

  !> Prepare for the joint at a spot of a case, whose film is marched.
  subroutine prepare(self, case, spot)
    class(history_record_t), intent(inout) :: self
    type(case_t), intent(in) :: case
    integer, intent(in) :: spot
    self%spot = spot
    associate (joint => case%joints(place_of(spot)))
      call joint%make_history(self%history)
      if (allocated(case%output%snapshot_times)) self%history%field_times = case%output%snapshot_times
      self%has_load = joint%history%march%drive == 'load'
      self%cycle = joint%history%march%cycle_deg*degree
      if (allocated(joint%history%supply)) self%feed = joint%history%supply%feed
    end associate
    if (allocated(case%load)) self%is_steady = self%has_load .and. case%load%is_steady() .and. .not. (case%drive%ramp_time > 0 &
      .or. self%feed%is_wanted() .or. self%history%supply%fixed_to_pin)
    allocate (self%kept(n_values, 1024))
  end subroutine prepare

  !> Keep a row of the run, and discard those before the last cycle when there is no more room.
  subroutine add(self, scene, t, now)
    class(history_record_t), intent(inout) :: self
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t
    type(evaluation_t), intent(in) :: now
    type(film_figures_t) :: film
    real(dp) :: turned(2), axes(2, 2)
    if (self%n == size(self%kept, 2)) call make_space(self)
    self%n = self%n + 1
    associate (joint => scene%joints(scene%joint_at(self%spot)), it => now%joint(scene%joint_at(self%spot)), &
      row => self%kept(:, self%n))
      turned = scene%turned(now, scene%joint_at(self%spot))
      associate (turn => turned(2))
        axes = reshape([cos(turn), -sin(turn), sin(turn), cos(turn)], [2, 2])   ! from x, y to those of the bearing
      end associate
      row(of_time) = t
      row(of_angle) = now%motion%crank_angle
      row(of_speed) = it%pin_angular_speed - it%bearing_speed
      row(of_x:of_y) = matmul(axes, it%eccentricity)
      row(of_load_x:of_load_y) = -matmul(axes, it%force)
      row(of_thickness) = -it%penetration
      film = joint%film_figures(it)
      row(of_pressure) = film%max_pressure
      row(of_viscosity) = joint%viscosity(it)/self%history%viscosity
    end associate
  end subroutine add

  !> Make room for another row: discard those before the last cycle, and take more if that was little.
  subroutine make_space(self)
    class(history_record_t), intent(inout) :: self
    real(dp), allocatable :: more(:, :)
    integer :: first
    first = first_row(self)
    self%kept(:, :self%n - first + 1) = self%kept(:, first:self%n)
    self%n = self%n - first + 1
    if (2*self%n < size(self%kept, 2)) return
    allocate (more(n_values, 2*size(self%kept, 2)))
    more(:, :self%n) = self%kept(:, :self%n)
    call move_alloc(more, self%kept)
  end subroutine make_space

  !> The first row of the last cycle.
  pure integer function first_row(self)
    class(history_record_t), intent(in) :: self
    real(dp), parameter :: rounding = 1e-9_dp
    do first_row = self%n, 2, -1
      if (abs(self%kept(of_angle, self%n) - self%kept(of_angle, first_row)) >= self%cycle*(1 - rounding)) return
    end do
  end function first_row

  !> March the film over the last cycle, or find its steady state with what it is given at the end of the run. It has the mean over
  !> its rows of the viscosity of the run's film, which follows its temperature and, if it thins, its mean shear rate in each row.
  !> `watch` receives its progress and may stop it.
  !> Errors (status_integration): the run has no whole cycle; the film cannot be marched; `watch` stopped it.
  subroutine march(self, watch, error)
    class(history_record_t), intent(inout) :: self
    class(table_watch_t), intent(inout) :: watch
    type(error_t), allocatable, intent(out) :: error
    real(dp) :: turned
    integer :: first
    if (.not. allocated(self%history%rows)) allocate (self%history%rows(0))
    first = first_row(self)
    turned = 0
    if (self%n > 1) turned = abs(self%kept(of_angle, self%n) - self%kept(of_angle, first))
    if (self%is_steady) first = self%n
    if (turned < 0.999_dp*self%cycle .and. .not. (self%is_steady .and. self%n > 0)) then
      call fail(error, 'film_history: the rows of the run have no whole cycle of cycle_deg', status_integration)
      return
    end if
    associate (kept => self%kept(:, first:self%n), ends => self%kept(:, min(first + 1, self%n):self%n))
      self%duty%time = kept(of_time, :)
      self%duty%pin_speed = kept(of_speed, :)
      self%duty%eccentricity = kept(of_x:of_y, :)
      if (self%has_load) self%duty%load = kept(of_load_x:of_load_y, :)
      if (self%feed%is_wanted()) self%duty%supply_pressure = fed_pressure(self, kept(of_angle, :)/degree)
      self%angle = ends(of_angle, :)
      self%quick_thickness = ends(of_thickness, :)
      self%quick_pressure = ends(of_pressure, :)
      self%history%viscosity = self%history%viscosity*sum(ends(of_viscosity, :))/size(self%angle)   ! that of the run
    end associate
    call self%history%march(self%duty, error, watch)
    if (allocated(error)) error%message = 'film_history: '//error%message
  end subroutine march

  !> The supply pressure at crank angles [degrees]: linear between the rows of its table, which repeats after a cycle [Pa].
  pure real(dp) function fed_at(self, angle) result(pressure)
    class(history_record_t), intent(in) :: self
    real(dp), intent(in) :: angle
    real(dp) :: at, next, part
    integer :: i, n
    n = size(self%feed%x)
    at = self%feed%x(1) + modulo(angle - self%feed%x(1), self%cycle/degree)
    i = count(self%feed%x <= at)
    next = self%feed%x(1) + self%cycle/degree
    if (i < n) next = self%feed%x(i + 1)
    part = (at - self%feed%x(i))/(next - self%feed%x(i))
    pressure = self%feed%y(i) + part*(self%feed%y(mod(i, n) + 1) - self%feed%y(i))
  end function fed_at

  pure function fed_pressure(self, angles) result(pressures)
    class(history_record_t), intent(in) :: self
    real(dp), intent(in) :: angles(:)   !! [degrees]
    real(dp) :: pressures(size(angles))
    integer :: i
    pressures = [(fed_at(self, angles(i)), i=1, size(angles))]
  end function fed_pressure
end module history_record
