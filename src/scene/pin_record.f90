!> Records what happens at one pin: its contacts, and the peaks of its force, penetration, film thickness and normal force.
module pin_record
  use kinds, only: dp
  use ode_method, only: ode_method_t
  use run_state, only: run_state_t
  use chain_motion, only: body_pin
  use joint_places, only: name_prefix
  use machine_record, only: turning_point
  use scene_problem, only: scene_t, evaluation_t, phase_film, phase_contact, event_contact_begins
  use joint_events, only: may_touch
  use inside_step, only: inner_points_t
  use step_peaks, only: peak_watch_t, of_pin_force, of_penetration, of_normal_force, n_peaks
  use cycle_watch, only: cycle_watch_t
  use load_element, only: of_asperities
  use wear_record, only: wear_record_t
  use trace_sink, only: trace_event_t
  use film_figures, only: film_figures_t
  use film_peak, only: find_film_peak
  use run_figures, only: run_figures_t
  implicit none
  private
  public :: pin_record_t

  type, extends(peak_watch_t) :: pin_record_t
    real(dp) :: validity_limit = huge(1.0_dp)  !! largest impact speed for which the contact law is valid [m/s]
    real(dp) :: deepest = huge(1.0_dp)         !! largest penetration for which the contact geometry is valid [m]
    type(trace_event_t), private :: contact    !! present or last contact
    logical :: reports_film = .false.          !! results of its film are wanted
    logical, private :: has_own_gap = .false.  !! its gap does not follow from the eccentricity
    logical, private :: floats = .false.       !! it is one end of a floating pin
    real(dp), private :: film_pressure = 0     !! largest pressure in its film at the end of the last interval [Pa]
    real(dp), private :: turn(3) = 0           !! time [s], angle [rad] and speed [rad/s] of the pin relative to its bearing there
    type(wear_record_t), allocatable :: wear   !! not allocated: wear is not counted
  contains
    procedure, non_overridable :: prepare
    procedure, non_overridable :: declare
    procedure, non_overridable :: count_from
    procedure, non_overridable :: follow_turn
    procedure, non_overridable :: search
    procedure, non_overridable :: record_values
    procedure, non_overridable :: record_contact
    procedure, non_overridable :: is_touching
  end type pin_record_t

contains

  !> Prepare the record of a pin of a scene.
  subroutine prepare(self, pin, scene)
    class(pin_record_t), intent(out) :: self
    integer, intent(in) :: pin   !! index in `places`
    type(scene_t), intent(in) :: scene
    self%pin = pin
    self%joint = scene%joint_at(pin)
    self%contact%pin = pin
    if (self%joint == 0) return
    self%reports_film = scene%joints(self%joint)%reports_film
    self%has_own_gap = scene%joints(self%joint)%has_own_gap
    self%floats = scene%joints(self%joint)%site%pin_body == body_pin
    if (allocated(scene%joints(self%joint)%wear)) then
      allocate (self%wear)
      call self%wear%prepare(self%joint, scene)
    end if
    if (.not. may_touch(scene%joints(self%joint))) return
    associate (joint => scene%joints(self%joint))
      self%validity_limit = joint%slots(joint%acting(phase_contact))%element%fastest_impact
      self%deepest = joint%slots(joint%acting(phase_contact))%element%deepest
    end associate
  end subroutine prepare

  !> Declare the totals of the pin, and with them the worn shape of its bore.
  subroutine declare(self, list, figures, scene)
    class(pin_record_t), intent(inout) :: self
    type(run_state_t), intent(inout) :: list
    type(run_figures_t), intent(inout) :: figures
    type(scene_t), intent(inout) :: scene
    logical :: touches
    touches = .false.
    if (self%joint > 0) touches = may_touch(scene%joints(self%joint))
    call figures%pin(self%pin)%declare(name_prefix(self%pin), list, self%joint > 0, touches, self%reports_film)
    if (touches) call self%contact%declare(list)
    if (self%floats) then
      associate (f => figures%pin(self%pin))
        call list%add(name_prefix(self%pin)//'turning', f%turning, 'rad', &
          'angle that the pin has turned through in this bearing')
        if (touches) call list%add(name_prefix(self%pin)//'max_impact_speed', f%max_impact_speed, 'm/s', &
          'largest speed at which a contact began')
      end associate
    end if
    if (allocated(self%wear)) call self%wear%declare(name_prefix(self%pin), list, scene%joints(self%joint))
  end subroutine declare

  !> Count what is integrated from a time [s].
  pure subroutine count_from(self, t)
    class(pin_record_t), intent(inout) :: self
    real(dp), intent(in) :: t
    if (allocated(self%wear)) self%wear%time = t
  end subroutine count_from

  !> Whether the joint at the pin is in contact.
  pure logical function is_touching(self, scene)
    class(pin_record_t), intent(in) :: self
    type(scene_t), intent(in) :: scene
    is_touching = .false.
    if (self%joint > 0) is_touching = scene%joints(self%joint)%phase == phase_contact
  end function is_touching

  !> Search the peaks between the last point recorded (or the beginning of a step after an event) and t, where the scene is
  !> evaluated.
  subroutine search(self, method, scene, t, now, inner, is_end, figures, cycles)
    class(pin_record_t), intent(inout) :: self
    class(ode_method_t), intent(inout) :: method
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t
    type(evaluation_t), intent(in) :: now
    type(inner_points_t), intent(in) :: inner   !! of the interval up to t, if the film is reported
    logical, intent(in) :: is_end   !! t is the end of the step, or of its final part; else that of a revolution inside it
    type(run_figures_t), intent(inout) :: figures
    type(cycle_watch_t), intent(inout), optional :: cycles
    real(dp) :: known(n_peaks), largest(n_peaks), angle
    integer :: before
    logical :: touches

    touches = self%is_touching(scene)
    known(of_pin_force) = figures%pin(self%pin)%max_force
    known(of_penetration:) = huge(known)
    if (self%joint > 0) known(of_penetration) = -figures%pin(self%pin)%min_film_thickness
    if (present(cycles)) call cycles%lower_to_peaks(self%pin, self%has_own_gap, known)
    if (touches) then
      associate (f => figures%pin(self%pin))
        f%longest_contact = max(f%longest_contact, t - self%contact%time)
      end associate
      known(of_penetration) = min(known(of_penetration), self%contact%max_penetration)
      known(of_normal_force) = self%contact%max_normal_force
    end if
    before = self%evaluations
    call self%search_interval(method, scene, t, now, known, largest)
    figures%evaluations = figures%evaluations + (self%evaluations - before)
    figures%peak_evaluations = figures%peak_evaluations + (self%evaluations - before)
    call add_values(self, touches, largest, figures)
    if (present(cycles)) then
      angle = now%motion%crank_angle
      if (self%thinnest_time < t) then
        if (cycles%is_thinner(self%pin, largest)) angle = angle_inside(method, scene, self%thinnest_time)
      end if
      call cycles%record_peaks(self%pin, touches, largest, angle)
    end if
    if (self%floats .or. present(cycles) .and. self%joint > 0) then
      call follow_turn(self, scene, t, now, angle, cycles)
      figures%pin(self%pin)%turning = figures%pin(self%pin)%turning + angle
    end if
    if (self%reports_film) call sum_film(self, method, scene, now, inner, figures, cycles)
    if (.not. allocated(self%wear)) return
    before = self%wear%evaluations
    if (is_end) then
      call self%wear%follow(method, scene, t)
    else
      call self%wear%look_ahead(method, scene, t)
    end if
    figures%evaluations = figures%evaluations + (self%wear%evaluations - before)
  end subroutine search

  !> Crank angle at a time inside the last step [rad].
  real(dp) function angle_inside(method, scene, time) result(angle)
    class(ode_method_t), intent(inout) :: method
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: time
    real(dp) :: y(size(method%y))
    call method%interpolate(time, y)
    angle = scene%crank_angle(time, y)
  end function angle_inside

  !> The angle that the pin turns through in its bearing since the last call, in either sense [rad]; it is added to the present
  !> revolution.
  subroutine follow_turn(self, scene, t, now, angle, cycles)
    class(pin_record_t), intent(inout) :: self
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t
    type(evaluation_t), intent(in) :: now
    real(dp), intent(out) :: angle
    type(cycle_watch_t), intent(inout), optional :: cycles
    real(dp) :: turn(3), span, rise, farthest
    associate (joint => scene%joints(self%joint), it => now%joint(self%joint))
      turn = [t, scene%chain%body_angle(now%motion, joint%site%pin_body), it%pin_angular_speed - it%bearing_speed]
      if (joint%bearing_turns) turn(2) = turn(2) - scene%chain%body_angle(now%motion, joint%site%bearing)
    end associate
    span = turn(1) - self%turn(1)
    rise = turn(2) - self%turn(2)
    farthest = turning_point(span, rise, self%turn(3), turn(3))
    angle = 0
    if (span > 0) angle = abs(farthest) + abs(rise - farthest)
    if (present(cycles)) call cycles%record_turn(self%pin, angle)
    self%turn = turn
  end subroutine follow_turn

  !> Integrate the power and the side flow of the film over an interval, and search the peak of its pressure.
  subroutine sum_film(self, method, scene, now, inner, figures, cycles)
    class(pin_record_t), intent(inout) :: self
    class(ode_method_t), intent(inout) :: method
    type(scene_t), intent(in) :: scene
    type(evaluation_t), intent(in) :: now       !! at the end of the interval
    type(inner_points_t), intent(in) :: inner
    type(run_figures_t), intent(inout) :: figures
    type(cycle_watch_t), intent(inout), optional :: cycles
    type(film_figures_t) :: film
    real(dp) :: pressures(0:size(inner%t) + 1), known, peak, angle
    integer :: i
    pressures = 0
    pressures(0) = self%film_pressure
    associate (f => figures%pin(self%pin), joint => scene%joints(self%joint), k => self%joint)
      do i = 1, inner%n
        if (.not. inner%in_domain(i)) cycle
        associate (inside => inner%now(i), weight => inner%weight(i))
          film = joint%film_figures(inside%joint(k))
          pressures(i) = film%max_pressure
          f%film_energy_lost = f%film_energy_lost + weight*film%power
          f%neglected_shear_loss = f%neglected_shear_loss + weight*film%neglected_power
          f%film_volume = f%film_volume + weight*film%side_flow
          f%max_film_pressure = max(f%max_film_pressure, film%max_pressure)
          if (.not. present(cycles)) cycle
          call cycles%record_film(self%pin, film%max_pressure, inside%motion%crank_angle, weight*film%side_flow)
          if (joint%has_kind(of_asperities)) call cycles%record_asperities(self%pin, weight*inside%joint(k)%normal_force, &
            weight*norm2(inside%joint(k)%force))
        end associate
      end do
      film = joint%film_figures(now%joint(k))
      f%max_film_pressure = max(f%max_film_pressure, film%max_pressure)
      if (present(cycles)) call cycles%record_film(self%pin, film%max_pressure, now%motion%crank_angle, 0.0_dp)
      pressures(size(inner%t) + 1) = film%max_pressure
      if (inner%n > 0 .and. joint%slots(joint%acting(phase_film))%element%film%gives_pressure()) then
        known = f%max_film_pressure
        if (present(cycles)) known = min(known, cycles%film_pressure(self%pin))
        call find_film_peak(method, scene, k, [inner%from, inner%t, inner%to], pressures, known, figures%evaluations, peak, angle)
        f%max_film_pressure = max(f%max_film_pressure, peak)
        if (present(cycles)) call cycles%record_film(self%pin, peak, angle, 0.0_dp)
      end if
    end associate
    self%film_pressure = film%max_pressure
  end subroutine sum_film

  !> Account for the values of one evaluation, for the run, for the present contact and, if it is given, for the present revolution.
  subroutine record_values(self, scene, now, figures, cycles)
    class(pin_record_t), intent(inout) :: self
    type(scene_t), intent(in) :: scene
    type(evaluation_t), intent(in) :: now
    type(run_figures_t), intent(inout) :: figures
    type(cycle_watch_t), intent(inout), optional :: cycles
    type(film_figures_t) :: film
    call add_values(self, self%is_touching(scene), self%values(scene, now), figures)
    if (present(cycles)) call cycles%record_peaks(self%pin, self%is_touching(scene), self%values(scene, now), &
      now%motion%crank_angle)
    if (.not. self%reports_film) return
    film = scene%joints(self%joint)%film_figures(now%joint(self%joint))
    figures%pin(self%pin)%max_film_pressure = max(figures%pin(self%pin)%max_film_pressure, film%max_pressure)
    if (present(cycles)) call cycles%record_film(self%pin, film%max_pressure, now%motion%crank_angle, 0.0_dp)
  end subroutine record_values

  subroutine add_values(self, touches, values, figures)
    class(pin_record_t), intent(inout) :: self
    logical, intent(in) :: touches
    real(dp), intent(in) :: values(n_peaks)
    type(run_figures_t), intent(inout) :: figures
    associate (f => figures%pin(self%pin), contact => self%contact)
      f%max_force = max(f%max_force, values(of_pin_force))
      f%min_film_thickness = min(f%min_film_thickness, -values(of_penetration))
      if (touches) then
        f%max_penetration = max(f%max_penetration, values(of_penetration))
        if (contact%max_penetration <= self%deepest .and. values(of_penetration) > self%deepest) &
          f%contacts_beyond_validity = f%contacts_beyond_validity + 1
        contact%max_penetration = max(contact%max_penetration, values(of_penetration))
        contact%max_normal_force = max(contact%max_normal_force, values(of_normal_force))
      end if
    end associate
  end subroutine add_values

  !> A contact begins or ends at time t; `now` is evaluated before that event. `event` is its entry in the trace.
  subroutine record_contact(self, kind, t, now, figures, event, cycles)
    class(pin_record_t), intent(inout) :: self
    integer, intent(in) :: kind
    real(dp), intent(in) :: t
    type(evaluation_t), intent(in) :: now
    type(run_figures_t), intent(inout) :: figures
    type(trace_event_t), intent(out) :: event
    type(cycle_watch_t), intent(inout), optional :: cycles

    associate (f => figures%pin(self%pin), relative => now%joint(self%joint))
      if (kind == event_contact_begins) then
        f%contacts = f%contacts + 1
        if (present(cycles)) call cycles%count_impact(self%pin)
        f%max_impact_speed = max(f%max_impact_speed, relative%penetration_rate)
        f%max_entry_penetration = max(f%max_entry_penetration, relative%penetration)
        if (relative%penetration_rate > self%validity_limit) f%impacts_beyond_validity = f%impacts_beyond_validity + 1
      end if
      call self%contact%change(kind, kind == event_contact_begins, t, now%motion%crank_angle, relative%penetration_rate)
      event = self%contact
    end associate
  end subroutine record_contact
end module pin_record
