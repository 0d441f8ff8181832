!> Results of the revolutions of the crank, and samples at the instants at which it passes a given angle.
module cycle_watch
  use kinds, only: dp
  use constants, only: two_pi
  use ode_method, only: ode_method_t
  use joint_places, only: n_spots
  use film_heat, only: n_sums
  use cylinder_charge, only: n_charge_sums
  use scene_problem, only: scene_t, evaluation_t, phase_contact
  use crank_passage, only: find_passage
  use revolutions, only: revolutions_t
  use trace_columns, only: column_list_t, row_values
  use cycle_statistics, only: cycle_t, cycle_statistics_t, skirt, most_parts
  use run_length, only: longest_period
  use machine_record, only: machine_record_t
  implicit none
  private
  public :: cycle_watch_t

  real(dp), parameter :: rounding = 1e-9_dp   !! of the crank angle at the end of a run [rad]

  !> Follows one run. It can be used again for another run, and keeps its allocated memory.
  type :: cycle_watch_t
    integer :: settle = 0                          !! number of revolutions at the start that are left out of the statistics
    integer :: uncounted = 0                       !! number of revolutions left out in the present run
    logical :: keeps_cycles = .false.              !! keep the results of every revolution counted
    logical :: wants_answers = .false.             !! the answers of the last cycle are wanted too
    type(cycle_statistics_t) :: statistics         !! of the revolutions counted
    type(cycle_t), allocatable :: cycles(:)        !! results of the first statistics%cycles revolutions counted, if they are kept
    type(column_list_t) :: strobe_list             !! columns to be sampled once in each revolution, at one crank angle
    real(dp) :: strobe_angle = 0                   !! that crank angle [rad]
    integer :: most_strobes = 0                    !! largest number of samples, from the first revolution counted; 0: no limit
    integer :: strobes = 0                         !! number of samples taken; sample i is in revolution uncounted + i
    real(dp), allocatable :: strobe_values(:, :)   !! (columns, strobes)
    real(dp) :: direction = 1                      !! sense in which the crank turns: 1 or -1
    type(cycle_t), allocatable :: recent(:)   !! from 0: revolution k in element mod(k, longest_period), of the last that ended
    real(dp) :: pin_turn = 0              !! of a floating pin in the revolutions followed [rad]
    real(dp), private :: pin_angle = 0    !! its angle at the start of the present one
    type(machine_record_t), private :: machine
    real(dp), private :: works(most_parts) = 0, energy = 0   !! at the start of the revolution [J]
    real(dp), private :: heat(n_sums, n_spots) = 0          !! integrals of the heat of films then
    real(dp), private :: gas(n_charge_sums) = 0              !! integrals of the gas then
    type(cycle_t), private :: present
    integer :: ended = 0                  !! number of revolutions that have ended
    integer :: followed = 0               !! number of those that have results: a run that goes on begins inside one
    integer, private :: passed = 0                 !! number of times that the crank has passed the strobe angle
    real(dp), private :: start_angle = 0, strobe_offset = 0, initial_energy = 0
    real(dp), private :: t = 0                     !! time of the last point [s]
    real(dp), private :: cycle_start = 0           !! time at which the present revolution began [s]
    real(dp), private :: force_integral(n_spots) = 0, loss = 0   !! at the start of the revolution
    logical, private :: has_strobe = .false.
    logical, private :: is_whole = .true.          !! the present revolution has been followed from its beginning
    real(dp), allocatable, private :: y(:)         !! work space for a state
  contains
    procedure :: begin
    procedure :: count_from
    procedure :: end_cycle
    procedure :: record_strobes
    procedure :: record_pin
    procedure :: record_turn
    procedure :: record_valve
    procedure :: search_machine
    procedure :: has_cycle
    procedure :: last_cycle
    procedure :: film_change
    procedure :: record_point
    procedure :: record_skirt
    procedure :: finish
  end type cycle_watch_t

contains

  !> Begin a run at (t, y), where the scene has been evaluated if that is inside the model.
  subroutine begin(self, scene, t, y, now, in_domain, initial_energy, crank)
    class(cycle_watch_t), intent(inout) :: self
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t, y(:)
    type(evaluation_t), intent(in) :: now
    logical, intent(in) :: in_domain
    real(dp), intent(in) :: initial_energy   !! [J]
    type(revolutions_t), intent(in) :: crank   !! its revolutions so far
    if (in_domain) call self%machine%begin(scene, t, now)
    if (.not. allocated(self%recent)) allocate (self%recent(0:longest_period - 1))
    self%statistics = cycle_statistics_t()
    self%present = cycle_t()
    self%uncounted = self%settle
    self%ended = crank%ended
    self%followed = 0
    self%pin_turn = 0
    if (in_domain .and. allocated(scene%chain%floating)) self%pin_angle = now%motion%pin_angle
    self%direction = crank%direction
    self%start_angle = crank%start_angle
    self%is_whole = abs(scene%crank_angle(t, y) - crank%angle(crank%ended)) <= rounding
    self%passed = 0
    self%strobes = 0
    self%t = t
    self%cycle_start = t
    self%force_integral = 0
    self%loss = scene%joint_loss(t, y)
    self%works = 0
    if (allocated(scene%parts)) self%works(:size(scene%parts)) = scene%works(t, y)
    self%heat = heat_of(scene, y)
    self%gas = scene%charge_totals(t, y)
    self%energy = 0
    if (in_domain) self%energy = scene%energy(now)
    self%initial_energy = initial_energy
    self%strobe_offset = two_pi - modulo(-self%direction*(self%strobe_angle - self%start_angle), two_pi)
    self%has_strobe = .false.
    if (allocated(self%strobe_list%id)) self%has_strobe = size(self%strobe_list%id) > 0
    if (.not. allocated(self%cycles)) allocate (self%cycles(16))
    if (self%has_strobe .and. .not. allocated(self%strobe_values)) &
      allocate (self%strobe_values(size(self%strobe_list%id), 16))
    self%y = y
  end subroutine begin

  !> Discard the revolutions so far, and count those that begin after the given number of revolutions.
  pure subroutine count_from(self, revolutions)
    class(cycle_watch_t), intent(inout) :: self
    integer, intent(in) :: revolutions
    self%uncounted = revolutions
    self%statistics = cycle_statistics_t()
    self%strobes = 0
  end subroutine count_from

  !> Sample the columns at the strobe angle, if the crank has passed it before (t_to, y_to), perhaps several times.
  subroutine record_strobes(self, method, scene, t_to, y_to)
    class(cycle_watch_t), intent(inout) :: self
    class(ode_method_t), intent(inout) :: method
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t_to, y_to(:)
    real(dp) :: travel, t
    if (.not. self%has_strobe) return
    travel = travel_at(self, scene, t_to, y_to)
    do while (travel >= next_strobe(self))
      t = passage(self, method, scene, next_strobe(self), t_to)
      call strobe(self, scene, t, self%y)
    end do
  end subroutine record_strobes

  !> Account for an angle [rad] that a pin has turned through in its bearing.
  pure subroutine record_turn(self, pin, angle)
    class(cycle_watch_t), intent(inout) :: self
    integer, intent(in) :: pin
    real(dp), intent(in) :: angle
    self%present%pin(pin)%turning = self%present%pin(pin)%turning + angle
  end subroutine record_turn

  !> Account for an event of the valves of a port that have a mass, before it: the reed may meet its seat or its stop.
  pure subroutine record_valve(self, scene, port, y)
    class(cycle_watch_t), intent(inout) :: self
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: port
    real(dp), intent(in) :: y(:)
    associate (charge => scene%gas%charge)
      self%present%valve_speed(port) = max(self%present%valve_speed(port), &
        charge%reeds%impact_speed(charge%valves(port), port, y))
    end associate
  end subroutine record_valve

  !> Search the last step, up to t, where the scene is evaluated, for the largest pressure of the gas and the extreme angles of a
  !> floating pin in the present revolution.
  subroutine search_machine(self, scene, t, now)
    class(cycle_watch_t), intent(inout) :: self
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t
    type(evaluation_t), intent(in) :: now
    call self%machine%search(scene, t, now, self%present)
  end subroutine search_machine

  !> Whether the last cycle of so many revolutions is whole and known.
  pure logical function has_cycle(self, revolutions)
    class(cycle_watch_t), intent(in) :: self
    integer, intent(in) :: revolutions
    has_cycle = self%followed >= revolutions .and. revolutions <= longest_period
  end function has_cycle

  !> The last revolutions together, as one cycle, or those up to `earlier` revolutions before; all must have been followed.
  pure type(cycle_t) function last_cycle(self, revolutions, earlier) result(cycle)
    class(cycle_watch_t), intent(in) :: self
    integer, intent(in) :: revolutions
    integer, intent(in), optional :: earlier
    type(cycle_statistics_t) :: sum
    integer :: k, last
    last = self%ended
    if (present(earlier)) last = last - earlier
    do k = last - revolutions + 1, last
      call sum%add(self%recent(mod(k, longest_period)))
    end do
    cycle = sum%total
  end function last_cycle

  !> Change of the smallest film thickness of a pin from the last cycle but one to the last, relative to the former [-]; 0 before
  !> the end of the third cycle, since the first one begins anywhere, and where the surfaces touch.
  pure real(dp) function film_change(self, pin, revolutions)
    class(cycle_watch_t), intent(in) :: self
    integer, intent(in) :: pin           !! spot, see `joint_places`
    integer, intent(in) :: revolutions   !! in a cycle
    type(cycle_t) :: last, before
    film_change = 0
    if (self%followed < 3*revolutions .or. 2*revolutions > longest_period) return
    last = self%last_cycle(revolutions)
    before = self%last_cycle(revolutions, revolutions)
    associate (now => last%pin(pin)%min_film_thickness, then => before%pin(pin)%min_film_thickness)
      if (now > 0 .and. then > 0) film_change = (now - then)/then
    end associate
  end function film_change

  !> Account for the largest force [N], the smallest film thickness [m] and the impacts of a pin in the present revolution.
  pure subroutine record_pin(self, pin, force, film_thickness, may_touch, impacts)
    class(cycle_watch_t), intent(inout) :: self
    integer, intent(in) :: pin
    real(dp), intent(in) :: force
    real(dp), intent(in), optional :: film_thickness   !! of a pin with clearance
    logical, intent(in), optional :: may_touch         !! it may penetrate
    integer, intent(in), optional :: impacts           !! contacts that began
    associate (c => self%present%pin(pin))
      c%max_force = force
      if (.not. present(film_thickness)) return
      c%min_film_thickness = film_thickness
      if (may_touch) c%max_penetration = max(0.0_dp, -film_thickness)
      c%impacts = impacts
    end associate
  end subroutine record_pin

  !> Account for an accepted point at time t in the present revolution.
  pure subroutine record_point(self, scene, t)
    class(cycle_watch_t), intent(inout) :: self
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t
    integer :: i
    do i = 1, scene%n_joints
      if (scene%joints(i)%phase /= phase_contact) cycle
      associate (c => self%present%pin(scene%joints(i)%spot))
        c%contact_time = c%contact_time + (t - self%t)
      end associate
    end do
    if (allocated(scene%guide)) then
      if (any(scene%guide%touches)) self%present%pin(skirt)%contact_time = self%present%pin(skirt)%contact_time + (t - self%t)
    end if
    self%t = t
  end subroutine record_point

  !> Account for the largest penetration and force of the corners of the skirt in the present revolution, and their impacts.
  pure subroutine record_skirt(self, penetration, force, impacts)
    class(cycle_watch_t), intent(inout) :: self
    real(dp), intent(in) :: penetration, force   !! [m], [N]
    integer, intent(in) :: impacts               !! contacts that began
    self%present%pin(skirt)%max_penetration = penetration
    self%present%pin(skirt)%max_force = force
    self%present%pin(skirt)%impacts = impacts
  end subroutine record_skirt

  !> End the run at (t, y): the crank may be at the strobe angle but for rounding.
  subroutine finish(self, scene, t, y)
    class(cycle_watch_t), intent(inout) :: self
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t, y(:)
    if (.not. self%has_strobe) return
    if (abs(travel_at(self, scene, t, y) - next_strobe(self)) <= rounding*(1 + self%passed)) call strobe(self, scene, t, y)
  end subroutine finish

  !> Angle turned through since the start, in the sense of the revolutions [rad].
  pure real(dp) function travel_at(self, scene, t, y)
    class(cycle_watch_t), intent(in) :: self
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t, y(:)
    travel_at = self%direction*(scene%crank_angle(t, y) - self%start_angle)
  end function travel_at

  !> Angle of travel at which the crank passes the strobe angle next [rad].
  pure real(dp) function next_strobe(self)
    class(cycle_watch_t), intent(in) :: self
    next_strobe = self%strobe_offset + two_pi*self%passed
  end function next_strobe

  !> The first time in the last step, up to t_to, at which the travel reaches `target`, or the beginning of the step if it had
  !> reached it before. The state there, taken from the interpolant, is returned in y. If the method stepped to that instant
  !> instead, means would change by 2e-5 at most (simulation I from six crank angles at tolerance 1e-4; 2e-6 at 1e-6).
  real(dp) function passage(self, method, scene, target, t_to)
    class(cycle_watch_t), intent(inout) :: self
    class(ode_method_t), intent(inout) :: method
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: target, t_to
    call find_passage(method, scene, self%start_angle + self%direction*target, self%direction, method%t_old, t_to, 1e-12_dp, &
      passage, self%y)
  end function passage

  !> End the present revolution at (t, y), where the scene has been evaluated.
  subroutine end_cycle(self, scene, t, y, now)
    class(cycle_watch_t), intent(inout) :: self
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t, y(:)
    type(evaluation_t), intent(in) :: now
    real(dp) :: force_integral(n_spots), loss, works(most_parts), energy, heat(n_sums, n_spots), &
      gas(n_charge_sums)
    integer :: i
    force_integral = scene%force_integrals(y)
    loss = scene%joint_loss(t, y)
    energy = scene%energy(now)
    works = 0
    if (allocated(scene%parts)) works(:size(scene%parts)) = scene%works(t, y)
    call self%record_point(scene, t)
    self%present%duration = t - self%cycle_start
    self%present%pin(:n_spots)%force_integral = force_integral - self%force_integral
    self%present%dissipated_energy = loss - self%loss
    self%present%start = self%cycle_start
    self%present%work = works - self%works
    self%present%energy_change = energy - self%energy
    gas = scene%charge_totals(t, y)
    self%present%gas = gas - self%gas
    self%gas = gas
    if (allocated(scene%gas)) then
      if (allocated(scene%gas%charge)) self%present%opening_temperature = scene%gas%charge%opening_temperature
    end if
    if (allocated(scene%chain%floating)) then
      self%present%pin_turn = now%motion%pin_angle - self%pin_angle
      self%pin_angle = now%motion%pin_angle
      if (self%is_whole) self%pin_turn = self%pin_turn + self%present%pin_turn
    end if
    heat = heat_of(scene, y)
    do i = 1, n_spots
      self%present%pin(i)%heat = heat(:, i) - self%heat(:, i)
    end do
    self%ended = self%ended + 1
    self%recent(mod(self%ended, longest_period)) = self%present
    if (self%is_whole) self%followed = self%followed + 1
    if (self%is_whole .and. self%ended > self%uncounted) then
      call self%statistics%add(self%present)
      if (self%keeps_cycles) then
        associate (n => self%statistics%cycles)
          if (n > size(self%cycles)) self%cycles = [self%cycles, self%cycles]   ! more room
          self%cycles(n) = self%present
        end associate
      end if
    end if
    self%is_whole = .true.
    self%present = cycle_t()
    self%cycle_start = t
    self%force_integral = force_integral
    self%loss = loss
    self%works = works
    self%energy = energy
    self%heat = heat
  end subroutine end_cycle

  !> Integrals of the heat of the films at the spots so far; 0 where films do not heat up.
  pure function heat_of(scene, y) result(heat)
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: y(:)
    real(dp) :: heat(n_sums, n_spots)
    integer :: i
    heat = 0
    do i = 1, size(scene%joints)
      associate (joint => scene%joints(i))
        if (allocated(joint%heat)) heat(:, joint%spot) = y(joint%heat%sums%first:joint%heat%sums%last)
      end associate
    end do
  end function heat_of

  !> Sample the columns at (t, y), where the crank passes the strobe angle.
  subroutine strobe(self, scene, t, y)
    class(cycle_watch_t), intent(inout) :: self
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t, y(:)
    type(evaluation_t) :: now
    logical :: in_domain
    self%passed = self%passed + 1
    if (self%passed <= self%uncounted) return
    if (self%most_strobes > 0 .and. self%strobes >= self%most_strobes) return
    self%strobes = self%strobes + 1
    if (self%strobes > size(self%strobe_values, 2)) self%strobe_values = reshape(self%strobe_values, &
      [size(self%strobe_values, 1), 2*self%strobes], pad=[0.0_dp])   ! more room
    call scene%evaluate(t, y, now, in_domain)
    call row_values(self%strobe_list, scene, t, now, scene%work(y), self%initial_energy, self%strobe_values(:, self%strobes))
  end subroutine strobe
end module cycle_watch
