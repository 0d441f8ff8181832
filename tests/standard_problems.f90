!> The standard battery for non-stiff integrators: DETEST classes A-E and the discontinuous class F (Hull, Enright,
!> Fellen & Sedgwick 1972, SIAM J. Numer. Anal. 9, 603; class F: Enright & Pryce 1987, ACM TOMS 13, 1), the Arenstorf orbit
!> and the Pleiades (Hairer, Norsett & Wanner 1993, II.0 and II.10).
!>
!> The discontinuities of class F are events; f changes its branch only at events.
module standard_problems
  use kinds, only: dp
  use constants, only: pi
  use ode_problem, only: ode_problem_t, event_continue
  use ode_method, only: ode_settings_t
  implicit none
  private
  public :: standard_problem_t, new_standard_problem, standard_settings, number_of, n_standard_problems, names

  integer, parameter :: n_standard_problems = 32
  character(len=9), parameter :: names(n_standard_problems) = [character(len=9) :: 'A1', 'A2', 'A3', 'A4', 'A5', 'B1', &
    'B2', 'B3', 'B4', 'B5', 'C1', 'C2', 'C3', 'C4', 'C5', 'D1', 'D2', 'D3', 'D4', 'D5', 'E1', 'E2', 'E3', 'E4', 'E5', &
    'F1', 'F2', 'F3', 'F4', 'F5', 'Arenstorf', 'Pleiades']

  !> One of the problems, y' = f(t, y) on 0 <= t <= t_end.
  type, extends(ode_problem_t) :: standard_problem_t
    character(len=9) :: name = ''
    real(dp) :: t_end = 20
    real(dp) :: max_step = huge(1.0_dp)   !! F4 needs it for the spike of width 0.5 at t = 5; f is constant elsewhere
    real(dp) :: eccentricity = 0   !! eccentricity of the orbit, class D
    integer :: part = 0            !! number of discontinuities passed, class F
  contains
    procedure :: derivatives
    procedure :: events => discontinuities
    procedure :: handle_event => pass_discontinuity
    procedure :: next_kink_time => at_infinite_slope
  end type standard_problem_t

  !> Mass of the sun and the inner planets together, masses of the outer planets, gravitational constant (C5).
  real(dp), parameter :: gravitation = 2.95912208286_dp, sun = 1.00000597682_dp
  real(dp), parameter :: planet(5) = [0.000954786104043_dp, 0.000285583733151_dp, 0.0000437273164546_dp, &
    0.0000517759138449_dp, 0.00000277777777778_dp]

contains

  !> Problem `number` and its initial state.
  subroutine new_standard_problem(number, problem, y)
    integer, intent(in) :: number
    type(standard_problem_t), intent(out) :: problem
    real(dp), allocatable, intent(out) :: y(:)
    problem%name = names(number)
    select case (names(number)(1:1))
    case ('A', 'B')
      y = small_start(names(number))
    case ('C')
      y = large_start(names(number))
    case ('D')
      problem%eccentricity = 0.1_dp + 0.2_dp*(number - 16)
      associate (e => problem%eccentricity)
        y = [1 - e, 0.0_dp, 0.0_dp, sqrt((1 + e)/(1 - e))]
      end associate
    case default
      y = small_start(names(number))
    end select
    if (names(number)(1:1) == 'F') problem%n_events = 1
    if (names(number) == 'F4') problem%max_step = 0.5_dp
    if (number == 31) then
      y = [0.994_dp, 0.0_dp, 0.0_dp, -2.00158510637908252240537862224_dp]
      problem%t_end = 17.0652165601579625588917206249_dp
    else if (number == 32) then
      y = [3.0_dp, 3.0_dp, -1.0_dp, -3.0_dp, 2.0_dp, -2.0_dp, 2.0_dp, 3.0_dp, -3.0_dp, 2.0_dp, 0.0_dp, 0.0_dp, -4.0_dp, &
        4.0_dp, 0.0_dp, 0.0_dp, 0.0_dp, 0.0_dp, 0.0_dp, 1.75_dp, -1.5_dp, 0.0_dp, 0.0_dp, 0.0_dp, -1.25_dp, 1.0_dp, &
        0.0_dp, 0.0_dp]
      problem%t_end = 3
    end if
    problem%n = size(y)
  end subroutine new_standard_problem

  integer pure function number_of(name)
    character(len=*), intent(in) :: name
    integer :: i
    number_of = 0
    do i = 1, n_standard_problems
      if (names(i) == name) number_of = i
    end do
  end function number_of

  !> Settings with one tolerance for all components, relative and absolute.
  pure function standard_settings(problem, tolerance) result(settings)
    class(standard_problem_t), intent(in) :: problem
    real(dp), intent(in) :: tolerance
    type(ode_settings_t) :: settings
    allocate (settings%relative(problem%n), source=tolerance)
    allocate (settings%absolute(problem%n), source=tolerance)
    settings%span = problem%t_end
    settings%max_step = problem%max_step
  end function standard_settings

  function small_start(name) result(y)
    character(len=*), intent(in) :: name
    real(dp), allocatable :: y(:)
    select case (name)
    case ('A5')
      y = [4.0_dp]
    case ('B1')
      y = [1.0_dp, 3.0_dp]
    case ('B2')
      y = [2.0_dp, 0.0_dp, 1.0_dp]
    case ('B3')
      y = [1.0_dp, 0.0_dp, 0.0_dp]
    case ('B4')
      y = [3.0_dp, 0.0_dp, 0.0_dp]
    case ('B5')
      y = [0.0_dp, 1.0_dp, 1.0_dp]
    case ('E1')
      y = [0.6713967071418030_dp, 0.09540051444747446_dp]
    case ('E2')
      y = [2.0_dp, 0.0_dp]
    case ('E4')
      y = [30.0_dp, 0.0_dp]
    case ('E3', 'E5', 'F1', 'F3')
      y = [0.0_dp, 0.0_dp]
    case ('F2')
      y = [110.0_dp]
    case default
      y = [1.0_dp]
    end select
  end function small_start

  function large_start(name) result(y)
    character(len=*), intent(in) :: name
    real(dp), allocatable :: y(:)
    if (name == 'C5') then
      y = [3.42947415189_dp, 3.35386959711_dp, 1.35494901715_dp, 6.64145542550_dp, 5.97156957878_dp, 2.18231499728_dp, &
        11.2630437207_dp, 14.6952576794_dp, 6.27960525067_dp, -30.1552268759_dp, 1.65699966404_dp, 1.43785752721_dp, &
        -21.1238353380_dp, 28.4465098142_dp, 15.3882659679_dp, -0.557160570446_dp, 0.505696783289_dp, 0.230578543901_dp, &
        -0.415570776342_dp, 0.365682722812_dp, 0.169143213293_dp, -0.325325669158_dp, 0.189706021964_dp, &
        0.0877265322780_dp, -0.0240476254170_dp, -0.287659532608_dp, -0.117219543175_dp, -0.176860753121_dp, &
        -0.216393453025_dp, -0.0148647893090_dp]
    else
      allocate (y(merge(51, 10, name == 'C4')))
      y = 0
      y(1) = 1
    end if
  end function large_start

  pure subroutine derivatives(self, t, y, dydt, in_domain)
    class(standard_problem_t), intent(in) :: self
    real(dp), intent(in) :: t, y(self%n)
    real(dp), intent(out) :: dydt(self%n)
    logical, intent(out) :: in_domain
    in_domain = .true.
    select case (self%name(1:1))
    case ('A')
      if (self%name == 'Arenstorf') then
        dydt = three_bodies(y)
      else
        dydt(1) = single(self%name, t, y(1))
      end if
    case ('B')
      dydt = small_system(self%name, y)
    case ('C')
      dydt = moderate_system(self%name, y)
    case ('D')
      dydt(1:2) = y(3:4)
      dydt(3:4) = -y(1:2)/(y(1)**2 + y(2)**2)**1.5_dp
    case ('E')
      dydt = second_order(self%name, t, y)
    case ('F')
      dydt = discontinuous(self%name, self%part, t, y)
    case default
      dydt = pleiades(y)
    end select
  end subroutine derivatives

  pure real(dp) function single(name, t, y)
    character(len=*), intent(in) :: name
    real(dp), intent(in) :: t, y
    select case (name)
    case ('A1')
      single = -y
    case ('A2')
      single = -y**3/2
    case ('A3')
      single = y*cos(t)
    case ('A4')
      single = y/4*(1 - y/20)
    case default
      single = (y - t)/(y + t)
    end select
  end function single

  pure function small_system(name, y) result(f)
    character(len=*), intent(in) :: name
    real(dp), intent(in) :: y(:)
    real(dp) :: f(size(y)), r
    select case (name)
    case ('B1')
      f = [2*(y(1) - y(1)*y(2)), -(y(2) - y(1)*y(2))]
    case ('B2')
      f = [-y(1) + y(2), y(1) - 2*y(2) + y(3), y(2) - y(3)]
    case ('B3')
      f = [-y(1), y(1) - y(2)**2, y(2)**2]
    case ('B4')
      r = sqrt(y(1)**2 + y(2)**2)
      f = [-y(2) - y(1)*y(3)/r, y(1) - y(2)*y(3)/r, y(1)/r]
    case default
      f = [y(2)*y(3), -y(1)*y(3), -0.51_dp*y(1)*y(2)]
    end select
  end function small_system

  pure function moderate_system(name, y) result(f)
    character(len=*), intent(in) :: name
    real(dp), intent(in) :: y(:)
    real(dp) :: f(size(y)), pull(3, 5), cube(5)
    integer :: i, j, n
    n = size(y)
    select case (name)
    case ('C1')
      f = [-y(1), y(1:n - 2) - y(2:n - 1), y(n - 1)]
    case ('C2')
      f = [-y(1), [((i - 1)*y(i - 1) - i*y(i), i=2, n - 1)], (n - 1)*y(n - 1)]
    case ('C3', 'C4')
      f = -2*y
      f(2:) = f(2:) + y(:n - 1)
      f(:n - 1) = f(:n - 1) + y(2:)
    case default
      f(1:15) = y(16:30)
      do j = 1, 5
        cube(j) = sum(y(3*j - 2:3*j)**2)**1.5_dp
      end do
      do j = 1, 5
        pull(:, j) = -(sun + planet(j))*y(3*j - 2:3*j)/cube(j)
        do i = 1, 5
          if (i == j) cycle
          associate (other => y(3*i - 2:3*i), own => y(3*j - 2:3*j))
            pull(:, j) = pull(:, j) + planet(i)*((other - own)/sum((other - own)**2)**1.5_dp - other/cube(i))
          end associate
        end do
      end do
      f(16:30) = gravitation*reshape(pull, [15])
    end select
  end function moderate_system

  pure function second_order(name, t, y) result(f)
    character(len=*), intent(in) :: name
    real(dp), intent(in) :: t, y(:)
    real(dp) :: f(size(y))
    f(1) = y(2)
    select case (name)
    case ('E1')
      f(2) = -(y(2)/(t + 1) + (1 - 0.25_dp/(t + 1)**2)*y(1))
    case ('E2')
      f(2) = (1 - y(1)**2)*y(2) - y(1)
    case ('E3')
      f(2) = y(1)**3/6 - y(1) + 2*sin(2.78535_dp*t)
    case ('E4')
      f(2) = 0.032_dp - 0.4_dp*y(2)**2
    case default
      f(2) = sqrt(1 + y(2)**2)/(25 - t)
    end select
  end function second_order

  !> Class F between two discontinuities, after `part` of them.
  pure function discontinuous(name, part, t, y) result(f)
    character(len=*), intent(in) :: name
    integer, intent(in) :: part
    real(dp), intent(in) :: t, y(:)
    real(dp) :: f(size(y)), way
    integer :: i
    way = merge(1.0_dp, -1.0_dp, mod(part, 2) == 0)
    select case (name)
    case ('F1')
      f = [y(2), 0.2_dp*y(2) - (pi**2 + 0.01_dp)*y(1) + way]
    case ('F2')
      f = 55 - merge(1.5_dp, 0.5_dp, way > 0)*y
    case ('F3')
      f = [y(2), 0.01_dp*y(2)*(1 - y(1)**2) - y(1) - way*sin(pi*t)]
    case ('F4')
      if (part == 0) then
        f = -2/21.0_dp - 120*(t - 5)/(1 + 4*(t - 5)**2)**16
      else
        f = -2*y
      end if
    case default
      f = 0
      do i = 1, 19
        f = f + sign(abs(t - i)**(1/3.0_dp), t - i)
      end do
      f = f*y*(4/3.0_dp)/sum([(i**(4/3.0_dp), i=1, 19)])
    end select
  end function discontinuous

  pure function three_bodies(y) result(f)
    real(dp), intent(in) :: y(:)
    real(dp) :: f(size(y)), d1, d2
    real(dp), parameter :: mu = 0.012277471_dp
    d1 = ((y(1) + mu)**2 + y(2)**2)**1.5_dp
    d2 = ((y(1) - 1 + mu)**2 + y(2)**2)**1.5_dp
    f = [y(3), y(4), y(1) + 2*y(4) - (1 - mu)*(y(1) + mu)/d1 - mu*(y(1) - 1 + mu)/d2, &
      y(2) - 2*y(3) - (1 - mu)*y(2)/d1 - mu*y(2)/d2]
  end function three_bodies

  pure function pleiades(y) result(f)
    real(dp), intent(in) :: y(:)
    real(dp) :: f(size(y)), cube
    integer :: i, j
    f(1:14) = y(15:28)
    f(15:28) = 0
    do i = 1, 7
      do j = 1, 7
        if (i == j) cycle
        cube = ((y(i) - y(j))**2 + (y(7 + i) - y(7 + j))**2)**1.5_dp
        f(14 + i) = f(14 + i) + j*(y(j) - y(i))/cube
        f(21 + i) = f(21 + i) + j*(y(7 + j) - y(7 + i))/cube
      end do
    end do
  end function pleiades

  !> The next discontinuity: t = 1, 2, ... 19, in F4 t = 10.
  pure subroutine discontinuities(self, t, y, g, g_rate)
    class(standard_problem_t), intent(in) :: self
    real(dp), intent(in) :: t, y(self%n)
    real(dp), intent(out) :: g(self%n_events), g_rate(self%n_events)
    g = t - (self%part + 1)
    if (self%name == 'F4') g = t - 10*(self%part + 1)
    if (self%part >= 19) g = -1
    g_rate = 1
  end subroutine discontinuities

  !> The solution of F5 varies with the cubic root of the time to its discontinuities.
  pure real(dp) function at_infinite_slope(self, t, y)
    class(standard_problem_t), intent(in) :: self
    real(dp), intent(in) :: t, y(:)
    at_infinite_slope = huge(t)
    if (self%name == 'F5' .and. self%part < 19 .and. t < self%part + 1) at_infinite_slope = self%part + 1
  end function at_infinite_slope

  subroutine pass_discontinuity(self, index, t, y, action)
    class(standard_problem_t), intent(inout) :: self
    integer, intent(in) :: index
    real(dp), intent(in) :: t
    real(dp), intent(inout) :: y(:)
    integer, intent(out) :: action
    self%part = self%part + index
    action = event_continue
  end subroutine pass_discontinuity
end module standard_problems
