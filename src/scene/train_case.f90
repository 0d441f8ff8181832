!> Parameters of several cylinders on one crankshaft: the cylinders, the stations of the shaft, and its dampers.
module train_case
  use kinds, only: dp
  use text_tools, only: integer_text
  use model_parameters, only: has_parameters_t, parameter_list_t
  use train_motion, only: most_stations, most_cylinders, most_rings
  implicit none
  private
  public :: cylinder_case_t, shaft_case_t, damper_case_t, full_cylinder, number_throws, list_value, order_cylinders
  public :: most_stations, most_cylinders, most_rings

  !> A cylinder. Exactly one is that of the mechanism; masses and inertias are those of the others.
  type, extends(has_parameters_t) :: cylinder_case_t
    logical :: full = .false.             !! it is that of the mechanism
    integer :: station = 0                !! from 1 on; 0: not given
    real(dp) :: phase_deg = 0, bank_deg = 0
    integer :: throw = 0                  !! from 1 on; 0: not given
    real(dp) :: axial_position = 0        !! [m]
    real(dp) :: pressure_scale = 1, heat_scale = 1
    logical :: gas = .true.
    real(dp) :: piston_mass = 0, rod_mass = 0, rod_inertia = 0, rod_com(2) = 0
    real(dp) :: crank_mass = 0, crank_inertia = 0, crank_com(2) = 0
  contains
    procedure :: parameters => cylinder_parameters
  end type cylinder_case_t

  !> An elastic shaft between stations. A list of one value stands for all.
  type, extends(has_parameters_t) :: shaft_case_t
    integer :: n_inertia = 1, n_stiffness = 1, n_damping = 1, n_absolute = 1, n_loss = 1   !! numbers of values
    real(dp) :: inertia(most_stations) = 0             !! [kg m^2]
    real(dp) :: stiffness(most_stations) = 0           !! [N m/rad]
    real(dp) :: damping(most_stations) = 0             !! [N m s/rad]
    real(dp) :: absolute_damping(most_stations) = 0    !! [N m s/rad]
    real(dp) :: absolute_damping_speed = 0             !! [rad/s]
    real(dp) :: loss_factor(most_stations) = 0
    real(dp) :: loss_frequency = 0                     !! [rad/s]
    integer :: drive_station = 0
  contains
    procedure :: parameters => shaft_parameters
    procedure :: is_given
    procedure :: driven
    procedure :: segment_damping
  end type shaft_case_t

  !> A torsional vibration damper: a ring on a station.
  type, extends(has_parameters_t) :: damper_case_t
    integer :: station = 0
    character(len=:), allocatable :: kind              !! 'rubber' or 'viscous'
    real(dp) :: inertia = 0, stiffness = 0, damping = 0, loss_factor = 0, loss_frequency = 0
  contains
    procedure :: parameters => damper_parameters
    procedure :: ring_damping
  end type damper_case_t

contains

  subroutine cylinder_parameters(self, list)
    class(cylinder_case_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call list%add('full', self%full, 'this is the cylinder that all other groups describe; none: the first', '.false.')
    call list%add('station', self%station, 'station of its throw; required with lists in &crankshaft, else left out', &
      '>= 1', '0')
    call list%add('phase_deg', self%phase_deg, &
      'angle of its throw ahead of a mark of the shaft in the whole working cycle: 0 and 360 are one throw, a turn apart', &
      'degrees', '>= -1440 and <= 1440', '0.0', usual='0 to 1440')
    call list%add('bank_deg', self%bank_deg, 'angle of its axis from a mark of the engine, positive from x to y', 'degrees', &
      '>= -360 and <= 360', '0.0', usual='0 to 360')
    call list%add('throw', self%throw, 'number of its throw along the shaft, the same for rods on one pin; 0: its own, the next', &
      '>= 1', '0')
    call list%add('axial_position', self%axial_position, 'position along the shaft, for moments; z is x cross y', 'm', &
      default='0.0', usual='0 to 20')
    call list%add('pressure_scale', self%pressure_scale, 'factor on the absolute pressure', range='> 0 and <= 10', default='1.0', &
      usual='0.1 to 2')
    call list%add('heat_scale', self%heat_scale, &
      'factor on the heat of an engine; 0: the cylinder misfires or is motored, its compression remains', range='>= 0 and <= 10', &
      default='1.0', usual='0.1 to 2')
    call list%add('gas', self%gas, '.false.: no force of the gas, for a cylinder that is driven', '.true.')
    call list%add('piston_mass', self%piston_mass, 'as in &mechanism, as all following keys; default: its value', 'kg', '> 0', &
      '', example='0.91', usual='1e-4 to 1e4')
    call list%add('rod_mass', self%rod_mass, 'mass of its rod', 'kg', '>= 0', '', example='1.36', usual='1e-4 to 1e4')
    call list%add('rod_inertia', self%rod_inertia, 'moment of inertia of its rod', 'kg m^2', '>= 0', '', example='0.010', &
      usual='1e-9 to 1e5')
    call list%add('rod_com', self%rod_com, 'centre of mass of its rod', 'm', default='', example='0.0508, 0.0', usual='0 to 10')
    call list%add('crank_mass', self%crank_mass, &
      'mass of the crank of its throw; 0 where the throw is also that of the full or of an earlier cylinder', 'kg', '>= 0', '', &
      example='0.80', usual='1e-3 to 1e5')
    call list%add('crank_inertia', self%crank_inertia, 'moment of inertia of that crank', 'kg m^2', '>= 0', '', example='0.006', &
      usual='1e-8 to 1e6')
    call list%add('crank_com', self%crank_com, 'centre of mass of that crank', 'm', default='', example='0.0', usual='0 to 2')
  end subroutine cylinder_parameters

  subroutine shaft_parameters(self, list)
    class(shaft_case_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call list%list_of_reals('inertia', self%inertia, self%n_inertia, 'instead of the keys above: inertias of 2 to 16 stations '// &
      'from the front, without rods, pistons and crank bodies', 'kg m^2', '>= 0', '0.0', usual='1e-7 to 1e6')
    call list%list_of_reals('stiffness', self%stiffness, self%n_stiffness, &
      'torsional stiffness between neighbouring stations, or one for all', 'N m/rad', '> 0', '0.0', usual='10 to 1e9')
    call list%list_of_reals('damping', self%damping, self%n_damping, 'damping between neighbouring stations, or one for all', &
      'N m s/rad', '>= 0', '0.0', usual='1e-6 to 1e4')
    call list%list_of_reals('absolute_damping', self%absolute_damping, self%n_absolute, &
      'damping moment of each station per speed beyond absolute_damping_speed, or one for all', 'N m s/rad', '>= 0', '0.0', &
      usual='1e-6 to 1e4')
    call list%add('absolute_damping_speed', self%absolute_damping_speed, &
      'speed of a station at which its absolute damping has no moment', 'rad/s', default='0.0', usual='1 to 2100')
    call list%list_of_reals('loss_factor', self%loss_factor, self%n_loss, 'loss factor of the segments, or one for all: a '// &
      'viscous damping of the same loss at loss_frequency', range='>= 0 and <= 1', default='0.0', usual='1e-4 to 1')
    call list%add('loss_frequency', self%loss_frequency, 'angular frequency at which loss_factor holds', 'rad/s', '> 0', '0.0', &
      usual='1 to 1e5')
    call list%add('drive_station', self%drive_station, 'station where drive and load act and the speed is held; 0: the last', &
      '>= 1', '0')
  end subroutine shaft_parameters

  subroutine damper_parameters(self, list)
    class(damper_case_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call list%add('station', self%station, 'station on which it sits', '>= 1', example='1')
    call list%word('kind', self%kind, 'rubber, viscous', 'rubber', 'rubber: a ring on a spring; viscous: a ring in oil')
    call list%add('inertia', self%inertia, 'moment of inertia of its ring', 'kg m^2', '> 0', example='0.004', usual='1e-7 to 1e5')
    call list%add('stiffness', self%stiffness, 'torsional stiffness of rubber', 'N m/rad', '> 0', '0.0', example='1.2e4', &
      usual='1 to 1e9')
    call list%add('damping', self%damping, 'damping moment per speed of the ring on its station; required of viscous', &
      'N m s/rad', '>= 0', '0.0', example='3.0', usual='1e-6 to 1e5')
    call list%add('loss_factor', self%loss_factor, 'loss factor of rubber, as in &crankshaft', range='>= 0 and <= 1', &
      default='0.0', usual='1e-4 to 1')
    call list%add('loss_frequency', self%loss_frequency, 'angular frequency at which loss_factor holds', 'rad/s', '> 0', '0.0', &
      usual='1 to 1e5')
  end subroutine damper_parameters

  !> Whether the shaft is given by lists of stations.
  pure logical function is_given(self)
    class(shaft_case_t), intent(in) :: self
    is_given = self%n_inertia > 1 .or. any(self%stiffness(:self%n_stiffness) > 0) .or. self%inertia(1) > 0
  end function is_given

  !> The driven station.
  pure integer function driven(self)
    class(shaft_case_t), intent(in) :: self
    driven = self%drive_station
    if (driven == 0) driven = self%n_inertia
  end function driven

  !> Value j of a list of n values, of which one stands for all.
  pure real(dp) function list_value(values, n, j) result(value)
    real(dp), intent(in) :: values(:)
    integer, intent(in) :: n, j
    value = values(merge(1, j, n == 1))
  end function list_value

  !> Damping of segment j: that given, and that of the loss factor [N m s/rad].
  pure real(dp) function segment_damping(self, j) result(damping)
    class(shaft_case_t), intent(in) :: self
    integer, intent(in) :: j
    damping = list_value(self%damping, self%n_damping, j)
    if (self%loss_frequency > 0) damping = damping + &
      list_value(self%loss_factor, self%n_loss, j)*list_value(self%stiffness, self%n_stiffness, j)/self%loss_frequency
  end function segment_damping

  !> The same of a ring on its station.
  pure real(dp) function ring_damping(self) result(damping)
    class(damper_case_t), intent(in) :: self
    damping = self%damping
    if (self%loss_frequency > 0) damping = damping + self%loss_factor*self%stiffness/self%loss_frequency
  end function ring_damping

  !> Index of the full cylinder.
  pure integer function full_cylinder(cylinders) result(full)
    type(cylinder_case_t), intent(in) :: cylinders(:)
    full = max(1, findloc(cylinders%full, .true., 1))
  end function full_cylinder

  !> The cylinders in the order in which the shaft brings them to the same point of the cycle, from cylinder 1 on: 1-3-4-2; with a
  !> plus between those at the same instant.
  pure subroutine order_cylinders(behind, period, order, gaps)
    real(dp), intent(in) :: behind(:)   !! angles of the shaft by which they come later than any one of them, in the unit of:
    real(dp), intent(in) :: period      !! angle of a whole cycle
    character(len=:), allocatable, intent(out) :: order
    real(dp), intent(out) :: gaps(:)    !! in this order, from each to the next; the last one to the first
    real(dp), parameter :: same = 1e-6_dp
    real(dp) :: left(size(behind)), before
    integer :: i, next
    left = modulo(behind - behind(1) + same, period) - same
    order = ''
    before = 0
    do i = 1, size(behind)
      next = minloc(left, 1)
      if (i > 1) order = order//trim(merge('+', '-', left(next) - before < same))
      gaps(i) = left(next)
      order = order//integer_text(next)
      before = left(next)
      left(next) = huge(before)
    end do
    gaps = [gaps(2:), period] - gaps
  end subroutine order_cylinders

  !> The throws of all cylinders, from 1 on, and which of them have the body of the crank of their throw: the full cylinder, and the
  !> first of a throw that is not the full one's.
  pure subroutine number_throws(cylinders, throw, has_crank)
    type(cylinder_case_t), intent(in) :: cylinders(:)
    integer, intent(out) :: throw(:)
    logical, intent(out) :: has_crank(:)
    integer :: i, full
    do i = 1, size(cylinders)
      throw(i) = cylinders(i)%throw
      if (throw(i) == 0) throw(i) = maxval([0, throw(:i - 1)]) + 1
    end do
    full = full_cylinder(cylinders)
    do i = 1, size(cylinders)
      has_crank(i) = i == full .or. throw(i) /= throw(full) .and. .not. any(throw(:i - 1) == throw(i))
    end do
  end subroutine number_throws
end module train_case
