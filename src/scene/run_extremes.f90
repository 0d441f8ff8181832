!> Contacts and totals of a run: at each pin, at the corners of the skirt, and of several cylinders.
module run_extremes
  use kinds, only: dp
  use run_state, only: run_state_t
  use ode_method, only: ode_method_t
  use joint_places, only: spot_prefix, name_prefix
  use scene_problem, only: scene_t, evaluation_t, of_guide, phase_contact
  use joint_events, only: penetration_and_rate, may_lose_force, may_touch, find_lost_force
  use piston_guide, only: n_corners, corner_names
  use run_length, only: longest_period
  use cycle_watch, only: cycle_watch_t
  use result_ledger, only: ledger_t
  use pin_record, only: pin_record_t
  use guide_record, only: guide_record_t
  use train_record, only: train_record_t
  use run_figures, only: run_figures_t, elastic_figures_t
  use wear_record, only: wear_profile_t
  use trace_sink, only: trace_event_t
  implicit none
  private
  public :: run_extremes_t

  type :: run_extremes_t
    type(run_figures_t) :: figures
    integer, private :: n_pins = 0                 !! number of pins that have a record
    type(pin_record_t), allocatable, private :: pins(:)
    type(guide_record_t), private :: guide         !! of a piston with clearance in its bore
    type(train_record_t) :: train                  !! of several cylinders on one crankshaft
  contains
    procedure :: prepare
    procedure :: declare
    procedure :: begin
    procedure :: end_revolution
    procedure :: wear_growth
    procedure :: search
    procedure :: add_point
    procedure :: add_train
    procedure :: change_phases
    procedure :: record_event
    procedure :: resume_contacts
    procedure :: figures_of_run
    procedure :: find_film_changes
    procedure :: find_pin_turns
    procedure :: begin_wear
    procedure :: end_wear_cycle
    procedure :: change_bore
    procedure :: find_wear
  end type run_extremes_t

contains

  !> Prepare for a scene that is ready to run.
  subroutine prepare(self, scene)
    class(run_extremes_t), intent(inout) :: self
    type(scene_t), intent(in) :: scene
    integer :: i
    self%n_pins = size(scene%reported)
    allocate (self%pins(self%n_pins))
    do i = 1, self%n_pins
      call self%pins(i)%prepare(scene%reported(i), scene)
    end do
    call self%guide%prepare(scene)
    if (allocated(scene%chain%elastic)) call find_frequencies(scene, self%figures%elastic)
    call self%train%prepare(scene)
    self%figures%floating%is_present = allocated(scene%chain%floating)
  end subroutine prepare

  !> Declare the totals so far.
  subroutine declare(self, list, scene)
    class(run_extremes_t), intent(inout) :: self
    type(run_state_t), intent(inout) :: list
    type(scene_t), intent(inout) :: scene
    integer :: i
    call self%figures%declare(list)
    do i = 1, self%n_pins
      call self%pins(i)%declare(list, self%figures, scene)
    end do
    call self%guide%declare(list, self%figures)
    call self%train%declare(list)
  end subroutine declare

  !> Begin at time t, where the scene has been evaluated if that is `in_domain` the model.
  subroutine begin(self, scene, t, now, in_domain, cycles)
    class(run_extremes_t), intent(inout) :: self
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t
    type(evaluation_t), intent(in) :: now
    logical, intent(in) :: in_domain
    type(cycle_watch_t), intent(inout), optional :: cycles
    real(dp) :: turned   ! before the run
    integer :: i
    if (in_domain) call self%train%begin(scene, t, now)
    do i = 1, self%n_pins
      call self%pins(i)%count_from(t)
      if (present(cycles) .and. allocated(self%pins(i)%wear)) call self%pins(i)%wear%mark_revolution(cycles%ended)
      if (in_domain .and. self%pins(i)%joint > 0) call self%pins(i)%follow_turn(scene, t, now, turned)
    end do
  end subroutine begin

  !> Add the extremes of pins and skirt in a revolution that ends to its results, and mark the wear so far.
  subroutine end_revolution(self, scene, ledger, cycles)
    class(run_extremes_t), intent(inout) :: self
    type(scene_t), intent(in) :: scene
    type(ledger_t), intent(in) :: ledger
    type(cycle_watch_t), intent(inout) :: cycles
    integer :: i
    call self%guide%end_revolution(ledger, cycles)
    do i = 1, self%n_pins
      associate (pin => self%pins(i)%pin, joint => self%pins(i)%joint)
        if (joint > 0) then
          call cycles%record_pin(pin, ledger%of_revolution(trim(spot_prefix(pin))//'max_force'), &
            ledger%of_revolution(trim(spot_prefix(pin))//'min_film_thickness'), may_touch(scene%joints(joint)), &
            nint(ledger%of_revolution(trim(spot_prefix(pin))//'impacts')))
        else
          call cycles%record_pin(pin, ledger%of_revolution(trim(spot_prefix(pin))//'max_pin_force'))
        end if
      end associate
    end do
    call self%train%end_revolution(cycles%ended + 1)
    do i = 1, self%n_pins
      if (allocated(self%pins(i)%wear)) call self%pins(i)%wear%mark_revolution(cycles%ended + 1)
    end do
  end subroutine end_revolution

  !> Largest depths by which a bin of the pin and one of the bore at a spot have worn in the last revolutions [m]; negative where
  !> wear is not counted.
  pure function wear_growth(self, scene, spot, revolutions) result(depth)
    class(run_extremes_t), intent(in) :: self
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: spot, revolutions
    real(dp) :: depth(2)
    integer :: i
    depth = -1
    do i = 1, self%n_pins
      if (self%pins(i)%pin == spot .and. allocated(self%pins(i)%wear)) depth = self%pins(i)%wear%growth(scene, revolutions)
    end do
  end function wear_growth

  !> Follow pins and train from the last point recorded (or the beginning of a step after an event) to t, where the scene is
  !> evaluated.
  subroutine search(self, method, scene, t, now, is_end, cycles)
    class(run_extremes_t), intent(inout) :: self
    class(ode_method_t), intent(inout) :: method
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t
    type(evaluation_t), intent(in) :: now
    logical, intent(in) :: is_end   !! t is the end of the step, or of its final part
    type(cycle_watch_t), intent(inout), optional :: cycles
    integer :: i
    do i = 1, self%n_pins
      call self%pins(i)%follow(method, scene, t, now, is_end, self%figures, cycles)
    end do
    call self%train%search(scene, t, now, present(cycles))
    if (present(cycles)) call cycles%search_machine(scene, t, now)
  end subroutine search

  !> Natural frequencies of the elastic members.
  subroutine find_frequencies(scene, figures)
    type(scene_t), intent(in) :: scene
    type(elastic_figures_t), intent(inout) :: figures
    if (scene%chain%has_elastic_rod()) then
      figures%bending_frequency = scene%chain%elastic%rod%bending_frequency()
      figures%axial_frequency = scene%chain%elastic%rod%axial_frequency(scene%chain%bodies%piston%mass)
    end if
    if (scene%chain%has_crankshaft()) figures%twist_frequency = scene%twist_frequency()
  end subroutine find_frequencies

  !> Account for the crankshaft of several cylinders in an evaluation.
  subroutine add_train(self, scene, now)
    class(run_extremes_t), intent(inout) :: self
    type(scene_t), intent(in) :: scene
    type(evaluation_t), intent(in) :: now
    call self%train%record_values(scene, now)
  end subroutine add_train

  !> Account for the time since the last accepted point, and for the work of friction up to (t, y).
  subroutine add_point(self, scene, t, y)
    class(run_extremes_t), intent(inout) :: self
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t, y(scene%n)
    integer :: i
    associate (f => self%figures)
      do i = 1, self%n_pins
        if (self%pins(i)%joint == 0) cycle
        associate (figures => f%pin(self%pins(i)%pin), joint => scene%joints(self%pins(i)%joint))
          if (self%pins(i)%is_touching(scene)) figures%contact_time = figures%contact_time + (t - f%time)
          if (joint%integrates_friction) figures%friction_work = joint%work_of_friction(y)
          if (allocated(joint%heat)) figures%heat = joint%heat%totals(y)
        end associate
      end do
      if (f%floating%is_present) f%floating%turn = y(scene%chain%floating%turn%position)
      f%gas_residual = scene%charge_residual(t, y)
      call self%guide%add_time(scene, t - f%time, f)
      f%time = t
    end associate
  end subroutine add_point

  !> An event may change the phase of a joint: the next interval begins there.
  subroutine change_phases(self)
    class(run_extremes_t), intent(inout) :: self
    call self%train%change_rates()
  end subroutine change_phases

  !> Record that a contact begins or ends at time t, at a joint or at a corner of the skirt; `now` is evaluated before that event. A
  !> joint without a record has no entry in the trace.
  subroutine record_event(self, joint, corner, kind, scene, t, now, ledger, event, is_found)
    class(run_extremes_t), intent(inout) :: self
    integer, intent(in) :: joint    !! index in the scene, or `of_guide`
    integer, intent(in) :: corner   !! of the skirt
    integer, intent(in) :: kind     !! event_contact_begins or event_contact_ends
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t
    type(evaluation_t), intent(in) :: now
    type(ledger_t), intent(inout) :: ledger
    type(trace_event_t), intent(out) :: event
    logical, intent(out) :: is_found
    integer :: i
    is_found = joint == of_guide
    if (is_found) then
      call self%guide%record_contact(corner, kind, scene, t, now, ledger, self%figures, event)
      return
    end if
    do i = 1, self%n_pins
      if (self%pins(i)%joint /= joint) cycle
      call self%pins(i)%record_contact(kind, scene, t, now, ledger, self%figures, event)
      is_found = .true.
    end do
  end subroutine record_event

  !> Tell the ledger which contacts of a run that goes on last at its beginning.
  subroutine resume_contacts(self, scene, ledger)
    class(run_extremes_t), intent(in) :: self
    type(scene_t), intent(in) :: scene
    type(ledger_t), intent(inout) :: ledger
    integer :: i
    do i = 1, self%n_pins
      if (self%pins(i)%is_touching(scene)) call ledger%begin_contact(spot_prefix(self%pins(i)%pin))
    end do
    if (.not. self%guide%is_present) return
    do i = 1, n_corners
      if (scene%guide%touches(i)) call ledger%begin_contact(corner_names(i)//'_')
    end do
  end subroutine resume_contacts

  !> The results of the run so far, with the contacts that last.
  function figures_of_run(self, scene, ledger) result(figures)
    class(run_extremes_t), intent(in) :: self
    type(scene_t), intent(in) :: scene
    type(ledger_t), intent(in) :: ledger
    type(run_figures_t) :: figures
    character(len=:), allocatable :: prefix
    integer :: i
    figures = self%figures
    do i = 1, self%n_pins
      prefix = name_prefix(self%pins(i)%pin)
      associate (it => figures%pin(self%pins(i)%pin))
        it%max_force = max(0.0_dp, ledger%of_whole_run(prefix//'max_pin_force'))
        if (self%pins(i)%joint == 0) cycle
        it%min_film_thickness = ledger%of_whole_run(prefix//'min_film_thickness')
        it%max_film_pressure = max(0.0_dp, ledger%of_whole_run(prefix//'max_film_pressure'))
        if (.not. may_touch(scene%joints(self%pins(i)%joint))) cycle
        it%max_penetration = max(0.0_dp, -it%min_film_thickness)
        if (self%pins(i)%is_touching(scene) .and. self%pins(i)%is_too_deep(ledger)) &
          it%contacts_beyond_validity = it%contacts_beyond_validity + 1
      end associate
    end do
    if (.not. self%guide%is_present) return
    do i = 1, n_corners
      figures%corner(i)%max_penetration = max(0.0_dp, -ledger%of_whole_run(corner_names(i)//'_min_gap'))
      figures%corner(i)%max_force = max(0.0_dp, ledger%of_whole_run(corner_names(i)//'_max_force'))
    end do
  end function figures_of_run

  !> How much the films of a run have changed from cycle to cycle at its end.
  subroutine find_film_changes(self, scene, cycles)
    class(run_extremes_t), intent(inout) :: self
    type(scene_t), intent(in) :: scene
    type(cycle_watch_t), intent(in) :: cycles
    integer :: i, revolutions
    revolutions = scene%forced_revolutions()
    do i = 1, size(scene%joints)
      associate (spot => scene%joints(i)%spot)
        self%figures%pin(spot)%film_change = cycles%film_change(spot, revolutions)
      end associate
    end do
  end subroutine find_film_changes

  !> Mean turn of a floating pin in a revolution of the crank, and its swing in the last cycle.
  subroutine find_pin_turns(self, cycles, ledger, revolutions)
    class(run_extremes_t), intent(inout) :: self
    type(cycle_watch_t), intent(in) :: cycles
    type(ledger_t), intent(in) :: ledger
    integer, intent(in) :: revolutions   !! in a cycle
    integer :: last
    associate (pin => self%figures%floating)
      pin%revolutions = cycles%followed
      if (.not. pin%is_present .or. pin%revolutions == 0) return
      pin%drift = cycles%pin_turn/pin%revolutions
      last = min(revolutions, pin%revolutions, longest_period)
      pin%swing = ledger%over_cycle('max_pin_angle', cycles%ended, last) - ledger%over_cycle('min_pin_angle', cycles%ended, last)
    end associate
  end subroutine find_pin_turns

  !> Count wear from time t.
  subroutine begin_wear(self, t)
    class(run_extremes_t), intent(inout) :: self
    real(dp), intent(in) :: t
    integer :: i
    do i = 1, self%n_pins
      if (allocated(self%pins(i)%wear)) call self%pins(i)%wear%begin_at(t)
    end do
  end subroutine begin_wear

  !> End a cycle of wear that is complete at the end of a run.
  subroutine end_wear_cycle(self, scene)
    class(run_extremes_t), intent(inout) :: self
    type(scene_t), intent(in) :: scene
    integer :: i
    do i = 1, self%n_pins
      if (.not. allocated(self%pins(i)%wear)) cycle
      associate (joint => scene%joints(self%pins(i)%joint))
        if (joint%has_worn_bore()) call self%pins(i)%wear%end_cycle(joint)
      end associate
    end do
  end subroutine end_wear_cycle

  !> Change the shape of a worn bore at the end of its cycle, at (t, y). A contact law whose force may be lost may lose it, or act
  !> again.
  subroutine change_bore(self, scene, joint, t, y, parts)
    class(run_extremes_t), intent(inout) :: self
    type(scene_t), intent(inout) :: scene
    integer, intent(in) :: joint      !! index in the scene
    real(dp), intent(in) :: t, y(scene%n)
    logical, intent(out) :: parts     !! the pin was in contact, and does not touch the deeper bore
    type(evaluation_t) :: now
    real(dp) :: contact(2)
    logical :: in_domain
    integer :: i
    parts = .false.
    do i = 1, self%n_pins
      if (self%pins(i)%joint /= joint .or. .not. allocated(self%pins(i)%wear)) cycle
      associate (worn => scene%joints(joint))
        if (.not. worn%has_worn_bore()) cycle
        call self%pins(i)%wear%change_bore(worn)
        if (worn%phase /= phase_contact) cycle
        contact = penetration_and_rate(worn, y)
        parts = .not. contact(1) > 0
        if (parts .or. .not. may_lose_force(worn)) cycle
        self%figures%evaluations = self%figures%evaluations + 1
        call scene%evaluate(t, y, now, in_domain)
        if (.not. in_domain) cycle
        call find_lost_force(worn, now%joint(joint), worn%relative_rates(now%accelerations))
      end associate
    end do
  end subroutine change_bore

  !> The worn surfaces of the joints whose wear is counted.
  subroutine find_wear(self, scene, worn)
    class(run_extremes_t), intent(in) :: self
    type(scene_t), intent(in) :: scene
    type(wear_profile_t), allocatable, intent(out) :: worn(:)
    integer :: i, k
    allocate (worn(count([(allocated(self%pins(i)%wear), i=1, self%n_pins)])))
    k = 0
    do i = 1, self%n_pins
      if (.not. allocated(self%pins(i)%wear)) cycle
      k = k + 1
      call self%pins(i)%wear%find_profile(scene, worn(k))
    end do
  end subroutine find_wear
end module run_extremes
