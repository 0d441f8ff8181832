!> Records what several cylinders on one crankshaft do: largest twists and torques, fluctuation of the speed, power of dampers, and
!> amplitudes of twist and torque by order; with the natural frequencies of the shaft and the firing order.
!>
!> Between two evaluated points a quantity is the cubic through its values and rates there: the steps resolve the fastest shape.
module train_record
  use kinds, only: dp
  use constants, only: two_pi, gauss_points, gauss_weights
  use text_tools, only: integer_text
  use number_text, only: short_text
  use run_state, only: run_state_t
  use run_length, only: longest_period
  use chain_motion, only: motion_t, accelerations_t
  use train_motion, only: most_stations, most_rings
  use crank_train, only: crank_train_t
  use torsional_modes, only: find_modes
  use peak_search, only: sample_t, top_of_cubic
  use scene_problem, only: scene_t, evaluation_t
  use train_case, only: order_cylinders
  use train_builder, only: mean_inertias
  implicit none
  private
  public :: train_record_t, train_result_t

  integer, parameter :: most_orders = 24          !! half orders: orders 0.5, 1, ... 12
  integer, parameter :: most_shown = 3            !! modes whose shapes are reported
  integer, parameter :: most_curves = most_stations   !! front twist and torques of segments

  !> A result: the name of its declaration, its own name, and its value or text.
  type :: train_result_t
    character(len=40) :: declared = '', name = ''
    real(dp) :: value = 0
    character(len=:), allocatable :: text
  end type train_result_t

  !> Curves at one instant, with their rates.
  type :: point_t
    real(dp) :: t = 0
    real(dp) :: twist(most_stations) = 0, twist_rate(most_stations) = 0
    real(dp) :: torque(most_stations) = 0, torque_rate(most_stations) = 0
    real(dp) :: speed(2) = 0, speed_rate(2) = 0   !! of the driven and of the first station
    real(dp) :: angle = 0                         !! of the driven station [rad]
    real(dp) :: loss(most_rings) = 0              !! power of the damping of rings [W]
  end type point_t

  !> Results of one revolution.
  type :: turn_t
    real(dp) :: duration = 0
    real(dp) :: largest(2) = -huge(1.0_dp), smallest(2) = huge(1.0_dp)   !! speeds [rad/s]
    real(dp) :: loss(most_rings) = 0              !! [J]
    real(dp) :: twist(most_stations) = 0, torque(most_stations) = 0   !! largest sizes [rad], [N m]
    complex(dp) :: order(most_orders, most_curves) = 0   !! integrals over the angle
  end type turn_t

  type :: train_record_t
    logical :: is_present = .false.
    real(dp), allocatable :: frequency(:), shape(:, :)   !! natural frequencies [rad/s] and shapes
    real(dp) :: max_twist(most_stations) = 0, max_torque(most_stations) = 0
    type(point_t), private :: last
    logical, private :: has_jumped = .false.      !! rates have changed since the last point
    type(turn_t), private :: present
    type(turn_t), allocatable, private :: turns(:)   !! revolution k in element mod(k, longest_period)
  contains
    procedure :: prepare
    procedure :: declare
    procedure :: begin
    procedure :: search
    procedure :: record_values
    procedure :: change_rates
    procedure :: end_revolution
    procedure :: results
  end type train_record_t

contains

  !> Prepare the record for a scene, and compute its natural frequencies.
  subroutine prepare(self, scene)
    class(train_record_t), intent(out) :: self
    type(scene_t), intent(in) :: scene
    real(dp), allocatable :: inertia(:)
    integer, allocatable :: rubber(:)
    integer :: i
    self%is_present = allocated(scene%chain%train)
    if (.not. self%is_present) return
    allocate (self%turns(0:longest_period - 1))
    associate (train => scene%chain%train)
      if (.not. train%is_chain) return
      call mean_inertias(train, scene%chain%bodies, inertia)
      rubber = pack([(i, i=1, size(train%rings))], .not. train%rings%is_viscous)
      call find_modes(inertia, train%stiffness(:train%n - 1), [(train%rings(rubber(i))%station, i=1, size(rubber))], &
        [(train%rings(rubber(i))%inertia, i=1, size(rubber))], [(train%rings(rubber(i))%stiffness, i=1, size(rubber))], &
        merge(0, train%driven, scene%chain%drive%free_crank), self%frequency, self%shape)
    end associate
  end subroutine prepare

  !> Declare the extremes so far.
  subroutine declare(self, list)
    class(train_record_t), intent(inout) :: self
    type(run_state_t), intent(inout) :: list
    if (.not. self%is_present) return
    call list%add('max_station_twists', self%max_twist, 'rad', 'largest twists of the stations')
    call list%add('max_segment_torques', self%max_torque, 'N m', 'largest torques of the segments')
  end subroutine declare

  !> Let the first interval begin at t, where the scene has been evaluated.
  subroutine begin(self, scene, t, now)
    class(train_record_t), intent(inout) :: self
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t
    type(evaluation_t), intent(in) :: now
    if (.not. self%is_present) return
    call find_point(scene%chain%train, t, now%motion, now%accelerations, self%last)
    self%present = turn_t()
    self%has_jumped = .false.
    call self%record_values(scene, now)
  end subroutine begin

  !> The rates change at an event: the next interval does not begin with those of the last point.
  pure subroutine change_rates(self)
    class(train_record_t), intent(inout) :: self
    self%has_jumped = .true.
  end subroutine change_rates

  !> Account for the interval between the last point and t, where the scene has been evaluated.
  subroutine search(self, scene, t, now, has_cycles)
    class(train_record_t), intent(inout) :: self
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t
    type(evaluation_t), intent(in) :: now
    logical, intent(in) :: has_cycles   !! results of revolutions are wanted
    if (self%is_present) call follow(self, scene, t, now, has_cycles)
  end subroutine search

  subroutine follow(self, scene, t, now, has_cycles)
    type(train_record_t), intent(inout) :: self
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t
    type(evaluation_t), intent(in) :: now
    logical, intent(in) :: has_cycles   !! results of revolutions are wanted
    type(point_t) :: next
    real(dp) :: h
    integer :: j
    associate (train => scene%chain%train, turn => self%present)
      call find_point(train, t, now%motion, now%accelerations, next)
      h = t - self%last%t
      if (h > 0) then
        if (self%has_jumped) call straighten(self%last, next, h)
        do j = 1, merge(train%n, 0, train%is_chain)
          call climb(h, self%last%twist(j), self%last%twist_rate(j), next%twist(j), next%twist_rate(j), turn%twist(j))
          call climb(h, -self%last%twist(j), -self%last%twist_rate(j), -next%twist(j), -next%twist_rate(j), turn%twist(j))
          call climb(h, self%last%torque(j), self%last%torque_rate(j), next%torque(j), next%torque_rate(j), turn%torque(j))
          call climb(h, -self%last%torque(j), -self%last%torque_rate(j), -next%torque(j), -next%torque_rate(j), turn%torque(j))
        end do
        self%max_twist = max(self%max_twist, turn%twist)
        self%max_torque = max(self%max_torque, turn%torque)
        do j = 1, 2
          call climb(h, self%last%speed(j), self%last%speed_rate(j), next%speed(j), next%speed_rate(j), turn%largest(j))
          turn%smallest(j) = -turn%smallest(j)
          call climb(h, -self%last%speed(j), -self%last%speed_rate(j), -next%speed(j), -next%speed_rate(j), turn%smallest(j))
          turn%smallest(j) = -turn%smallest(j)
        end do
        turn%duration = turn%duration + h
        turn%loss = turn%loss + 0.5_dp*h*(self%last%loss + next%loss)
        if (train%is_chain .and. has_cycles) call add_orders(train, self%last, next, h, turn%order)
      end if
    end associate
    self%last = next
    self%has_jumped = .false.
  end subroutine follow

  !> Account for the values of one evaluation.
  pure subroutine record_values(self, scene, now)
    class(train_record_t), intent(inout) :: self
    type(scene_t), intent(in) :: scene
    type(evaluation_t), intent(in) :: now
    integer :: j
    if (.not. self%is_present) return
    associate (train => scene%chain%train)
      do j = 1, merge(train%n, 0, train%is_chain)
        self%max_twist(j) = max(self%max_twist(j), abs(now%motion%train%twist(j)))
        if (j < train%n) self%max_torque(j) = max(self%max_torque(j), abs(train%segment_torque(now%motion, j)))
      end do
    end associate
  end subroutine record_values

  !> End a revolution, the last point of which has been searched; `number` counts them from 1 on.
  subroutine end_revolution(self, number)
    class(train_record_t), intent(inout) :: self
    integer, intent(in) :: number
    if (.not. self%is_present) return
    self%turns(mod(number, longest_period)) = self%present
    self%present = turn_t()
  end subroutine end_revolution

  pure subroutine find_point(train, t, motion, accelerations, point)
    type(crank_train_t), intent(in) :: train
    real(dp), intent(in) :: t
    type(motion_t), intent(in) :: motion
    type(accelerations_t), intent(in) :: accelerations
    type(point_t), intent(out) :: point
    integer :: i, j, k
    point%t = t
    associate (at => motion%train, n => train%n)
      point%twist(:n) = at%twist(:n)
      point%twist_rate(:n) = at%speed(:n) - motion%crank_speed
      do j = 1, n - 1
        point%torque(j) = train%segment_torque(motion, j)
        point%torque_rate(j) = train%stiffness(j)*(at%speed(j + 1) - at%speed(j)) &
          + train%damping(j)*(accelerations%station(j + 1) - accelerations%station(j))
      end do
      do i = 1, 2
        k = merge(train%driven, 1, i == 1)
        point%speed(i) = at%speed(k)
        point%speed_rate(i) = accelerations%station(k)
      end do
      point%angle = motion%crank_angle + at%twist(train%driven)
      do i = 1, size(train%rings)
        point%loss(i) = train%rings(i)%damping*(at%ring_speed(i) - at%speed(train%rings(i)%station))**2
      end do
    end associate
  end subroutine find_point

  !> Take all rates of an interval as the differences of the values: the rates at its beginning are not known.
  pure subroutine straighten(left, right, h)
    type(point_t), intent(inout) :: left
    type(point_t), intent(in) :: right
    real(dp), intent(in) :: h
    left%twist_rate = 2*(right%twist - left%twist)/h - right%twist_rate
    left%torque_rate = 2*(right%torque - left%torque)/h - right%torque_rate
    left%speed_rate = 2*(right%speed - left%speed)/h - right%speed_rate
  end subroutine straighten

  !> Raise `largest` to the maximum of the cubic with these values and rates at the ends of an interval of length h.
  pure subroutine climb(h, left, left_rate, right, right_rate, largest)
    real(dp), intent(in) :: h, left, left_rate, right, right_rate
    real(dp), intent(inout) :: largest
    real(dp) :: top
    logical :: is_inside
    call top_of_cubic(sample_t(0.0_dp, left, left_rate), sample_t(h, right, right_rate), top, is_inside)
    largest = max(largest, left, right, top)
  end subroutine climb

  !> Add the integrals over the angle of the driven station in an interval, by three points of Gauss and Legendre.
  pure subroutine add_orders(train, left, right, h, order)
    type(crank_train_t), intent(in) :: train
    type(point_t), intent(in) :: left, right
    real(dp), intent(in) :: h
    complex(dp), intent(inout) :: order(:, :)
    real(dp) :: value(train%n), angle, turning
    complex(dp) :: step, factor
    integer :: i, j, k
    do i = 1, size(gauss_points)
      angle = cubic(left%angle, left%speed(1), right%angle, right%speed(1), h, gauss_points(i))
      turning = left%speed(1) + gauss_points(i)*(right%speed(1) - left%speed(1))
      value(1) = front(train, [(cubic(left%twist(j), left%twist_rate(j), right%twist(j), right%twist_rate(j), h, gauss_points(i)), &
        j=1, train%n)])
      do j = 1, train%n - 1
        value(j + 1) = cubic(left%torque(j), left%torque_rate(j), right%torque(j), right%torque_rate(j), h, gauss_points(i))
      end do
      step = exp(cmplx(0.0_dp, -0.5_dp*angle, dp))
      factor = gauss_weights(i)*h*turning
      do k = 1, most_orders
        factor = factor*step
        do j = 1, train%n
          order(k, j) = order(k, j) + factor*value(j)
        end do
      end do
    end do
  end subroutine add_orders

  !> Twist of the front end against the driven station, or of the rear end if the front is driven.
  pure real(dp) function front(train, twist)
    type(crank_train_t), intent(in) :: train
    real(dp), intent(in) :: twist(:)
    front = twist(merge(train%n, 1, train%driven == 1)) - twist(train%driven)
  end function front

  !> The cubic with these values and rates at the ends of an interval of length h, at the share s of it.
  pure real(dp) function cubic(left, left_rate, right, right_rate, h, s)
    real(dp), intent(in) :: left, left_rate, right, right_rate, h, s
    real(dp) :: rise
    rise = right - left
    cubic = left + s*(h*left_rate + s*(3*rise - h*(2*left_rate + right_rate) + s*(h*(left_rate + right_rate) - 2*rise)))
  end function cubic

  !> The results of a run that has ended, with those of its last whole cycle of some revolutions, 0 if it has none.
  function results(self, scene, last, revolutions) result(list)
    class(train_record_t), intent(in) :: self
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: last, revolutions   !! number of the last revolution; of the cycle
    type(train_result_t), allocatable :: list(:)
    type(turn_t) :: cycle
    integer :: n, k, j
    allocate (list(1000))
    n = 0
    associate (train => scene%chain%train)
      call add('firing_order', 'firing_order', text=firing_order(scene))
      if (train%is_chain) call add_modes()
      if (revolutions > 0) then
        do k = last - revolutions + 1, last
          associate (turn => self%turns(mod(k, longest_period)))
            cycle%duration = cycle%duration + turn%duration
            cycle%largest = max(cycle%largest, turn%largest)
            cycle%smallest = min(cycle%smallest, turn%smallest)
            cycle%loss = cycle%loss + turn%loss
            cycle%twist = max(cycle%twist, turn%twist)
            cycle%torque = max(cycle%torque, turn%torque)
            cycle%order = cycle%order + turn%order
          end associate
        end do
        call add('cyclic_irregularity', 'cyclic_irregularity', irregularity(1))
        if (train%is_chain) call add_cycle()
        if (train%is_chain) call add_extremes('cycle_', cycle%torque, cycle%twist)
      end if
      if (train%is_chain) call add_extremes('', self%max_torque, self%max_twist)
    end associate
    list = list(:n)

  contains

    subroutine add(declared, name, value, text)
      character(len=*), intent(in) :: declared, name
      real(dp), intent(in), optional :: value
      character(len=*), intent(in), optional :: text
      n = n + 1
      list(n)%declared = declared
      list(n)%name = name
      if (present(value)) list(n)%value = value
      if (present(text)) list(n)%text = text
    end subroutine add

    real(dp) function irregularity(i)
      integer, intent(in) :: i
      irregularity = (cycle%largest(i) - cycle%smallest(i))*cycle%duration/(two_pi*revolutions)
    end function irregularity

    subroutine add_modes()
      character(len=:), allocatable :: mode
      integer :: body, ring
      do k = 1, size(self%frequency)
        call add('natural_frequency_N', 'natural_frequency_'//integer_text(k), self%frequency(k)/two_pi)
      end do
      do k = 1, min(most_shown, size(self%frequency))
        mode = 'mode_'//integer_text(k)//'_'
        do body = 1, scene%chain%train%n
          call add('mode_N_station_J', mode//'station_'//integer_text(body), self%shape(body, k))
        end do
        do ring = 1, size(scene%chain%train%rings)
          if (scene%chain%train%rings(ring)%is_viscous) cycle
          call add('mode_N_damper_R', mode//'damper_'//integer_text(ring), self%shape(body, k))
          body = body + 1
        end do
      end do
    end subroutine add_modes

    subroutine add_cycle()
      real(dp) :: amplitude
      integer :: every
      call add('front_irregularity', 'front_irregularity', irregularity(2))
      do j = 1, size(scene%chain%train%rings)
        call add('cycle_mean_damper_R_power', 'cycle_mean_damper_'//integer_text(j)//'_power', cycle%loss(j)/cycle%duration)
      end do
      every = merge(1, 2, mod(revolutions, 2) == 0)
      do j = 1, scene%chain%train%n
        do k = every, most_orders, every
          amplitude = 2*abs(cycle%order(k, j))/(two_pi*revolutions)
          if (j == 1) then
            call add('cycle_front_twist_order_H', 'cycle_front_twist_order_'//short_text(0.5_dp*k), amplitude)
          else
            call add('cycle_segment_J_torque_order_H', 'cycle_segment_'//integer_text(j - 1)//'_torque_order_'// &
              short_text(0.5_dp*k), amplitude)
          end if
        end do
      end do
    end subroutine add_cycle

    subroutine add_extremes(of, torque, twist)
      character(len=*), intent(in) :: of   !! the beginning of the names: of the last cycle or of the run
      real(dp), intent(in) :: torque(:), twist(:)
      do j = 1, scene%chain%train%n - 1
        call add(of//'max_segment_J_torque', of//'max_segment_'//integer_text(j)//'_torque', torque(j))
      end do
      do j = 1, scene%chain%train%n
        if (j /= scene%chain%train%full) &
          call add(of//'max_station_J_twist', of//'max_station_'//integer_text(j)//'_twist', twist(j))
      end do
    end subroutine add_extremes
  end function results

  !> See `order_cylinders`.
  function firing_order(scene) result(text)
    type(scene_t), intent(in) :: scene
    character(len=:), allocatable :: text
    real(dp), dimension(size(scene%chain%train%cylinders) + 1) :: behind, gaps
    real(dp) :: period
    integer :: i
    associate (train => scene%chain%train)
      behind(train%full_number) = 0
      do i = 1, size(train%cylinders)
        behind(train%cylinders(i)%number) = -sign(1.0_dp, scene%start_speed)*(train%cylinders(i)%shift)
      end do
      period = two_pi
      if (allocated(scene%gas)) period = scene%gas%revolutions*two_pi
      call order_cylinders(behind, period, text, gaps)
    end associate
  end function firing_order
end module train_record
