!> Records what happens at the corners of the skirt in its bore: contacts, penetrations and forces.
!>
!> Penetrations and forces follow from the position and speed of the piston alone. Peaks inside a step are therefore searched on the
!> interpolant of the method, without evaluations of the scene.
module guide_record
  use kinds, only: dp
  use ode_method, only: ode_method_t
  use run_state, only: run_state_t
  use joint_places, only: n_places
  use piston_guide, only: corner_t, n_corners, corner_names
  use scene_problem, only: scene_t, evaluation_t, event_contact_begins
  use peak_search, only: sample_t, peak_search_t, may_peak
  use trace_sink, only: trace_event_t
  use run_figures, only: run_figures_t
  use cycle_watch, only: cycle_watch_t
  implicit none
  private
  public :: guide_record_t

  integer, parameter :: of_depth = 1, of_force = 2, n_peaks = 2
  real(dp), parameter :: short = 1e-4_dp      !! fraction of an interval over which the slope of a force is taken

  type :: guide_record_t
    logical :: is_present = .false.      !! the scene has a piston with clearance in its bore
    type(trace_event_t), private :: contact(n_corners)   !! present or last contact of each corner
    real(dp), private :: t = 0         !! end of the last interval that was searched [s]
    real(dp), private :: last(n_peaks, n_corners) = 0    !! penetrations and forces at that time
    real(dp), private :: rate(n_corners) = 0             !! rates of the penetrations at that time
    real(dp), private :: highest(n_peaks) = huge(1.0_dp)  !! largest penetration and force in the present revolution, if revolutions
                                                          !! are counted
  contains
    procedure, non_overridable :: prepare
    procedure, non_overridable :: declare
    procedure, non_overridable :: stand_at
    procedure, non_overridable :: begin_revolution
    procedure, non_overridable :: end_revolution
    procedure, non_overridable :: search
    procedure, non_overridable :: record_values
    procedure, non_overridable :: add_time
    procedure, non_overridable :: record_contact
  end type guide_record_t

contains

  !> Prepare the record for a scene.
  subroutine prepare(self, scene)
    class(guide_record_t), intent(out) :: self
    type(scene_t), intent(in) :: scene
    integer :: i
    if (allocated(scene%guide)) self%is_present = scene%guide%is_loose
    do i = 1, n_corners
      self%contact(i)%pin = n_places + i
    end do
  end subroutine prepare

  !> Declare the totals of the corners.
  subroutine declare(self, list, figures)
    class(guide_record_t), intent(inout) :: self
    type(run_state_t), intent(inout) :: list
    type(run_figures_t), intent(inout) :: figures
    integer :: i
    do i = 1, merge(n_corners, 0, self%is_present)
      call figures%corner(i)%declare(corner_names(i)//'_', list, has_gap=.false., has_contacts=.true., has_film=.false.)
      call self%contact(i)%declare(list)
    end do
  end subroutine declare

  !> Let the next interval to be searched begin at t, where the scene has been evaluated.
  pure subroutine stand_at(self, t, now)
    class(guide_record_t), intent(inout) :: self
    real(dp), intent(in) :: t
    type(evaluation_t), intent(in) :: now
    if (.not. self%is_present) return
    self%t = t
    self%last(of_depth, :) = now%guide%corner%depth
    self%last(of_force, :) = now%guide%corner%normal_force
    self%rate = now%guide%corner%depth_rate
  end subroutine stand_at

  !> Begin a revolution whose results are wanted: all its peaks are searched, not only those above the peaks of the present
  !> contacts.
  pure subroutine begin_revolution(self)
    class(guide_record_t), intent(inout) :: self
    self%highest = 0
  end subroutine begin_revolution

  !> End the revolution: its largest penetration [m] and force [N] at a corner are added to the results.
  pure subroutine end_revolution(self, cycles)
    class(guide_record_t), intent(inout) :: self
    type(cycle_watch_t), intent(inout) :: cycles
    if (self%is_present) call cycles%record_skirt(self%highest(of_depth), self%highest(of_force))
  end subroutine end_revolution

  !> Search the peaks of the corners that touch, between the end of the last interval and t, where the scene is evaluated. Both must
  !> lie inside the last step of the method.
  subroutine search(self, method, scene, t, now, figures)
    class(guide_record_t), intent(inout) :: self
    class(ode_method_t), intent(inout) :: method
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t
    type(evaluation_t), intent(in) :: now
    type(run_figures_t), intent(inout) :: figures
    real(dp) :: largest(n_peaks)
    integer :: i
    if (.not. self%is_present) return
    do i = 1, n_corners
      if (.not. (scene%guide%touches(i) .and. t > self%t)) cycle
      largest = 0
      associate (corner => now%guide%corner(i))
        call search_between(method, scene, i, of_depth, sample_t(self%t, self%last(of_depth, i), self%rate(i)), &
          sample_t(t, corner%depth, corner%depth_rate), min(self%contact(i)%max_penetration, self%highest(of_depth)), &
          largest(of_depth))
        call search_between(method, scene, i, of_force, sample_t(self%t, self%last(of_force, i), slope_at(self%t, 1)), &
          sample_t(t, corner%normal_force, slope_at(t, -1)), min(self%contact(i)%max_normal_force, &
          self%highest(of_force)), largest(of_force))
      end associate
      call add_values(self, i, largest, figures)
    end do
    call self%record_values(scene, now, figures)
    call self%stand_at(t, now)

  contains

    !> Slope of the force at one end of the interval, from two values a fraction `short` of it apart; `way` is the direction (1 or
    !> -1) into the interval.
    real(dp) function slope_at(at, way) result(slope)
      real(dp), intent(in) :: at
      integer, intent(in) :: way
      real(dp) :: step
      step = way*short*(t - self%t)
      slope = 0
      if (abs((at + step) - at) > 0) slope = (value_at(method, scene, i, of_force, at + step) - &
        value_at(method, scene, i, of_force, at))/((at + step) - at)
    end function slope_at
  end subroutine search

  !> Search the peak of one quantity between two samples, if it may exceed `known`.
  subroutine search_between(method, scene, corner, quantity, left, right, known, largest)
    class(ode_method_t), intent(inout) :: method
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: corner, quantity
    type(sample_t), intent(in) :: left, right
    real(dp), intent(in) :: known
    real(dp), intent(inout) :: largest
    type(peak_search_t) :: peak
    real(dp) :: t
    logical :: is_done
    if (.not. may_peak(left%t, left%value, left%slope, right%t, right%value, right%slope, known)) return
    call peak%begin(left, right)
    do
      call peak%next_time(t, is_done)
      if (is_done) exit
      call peak%add_value(t, value_at(method, scene, corner, quantity, t))
    end do
    largest = max(largest, peak%value(1))
  end subroutine search_between

  !> The value of a quantity of a corner at a time inside the last step.
  real(dp) function value_at(method, scene, corner, quantity, t) result(value)
    class(ode_method_t), intent(inout) :: method
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: corner, quantity
    real(dp), intent(in) :: t
    type(corner_t) :: corners(n_corners)
    real(dp) :: y(scene%n)
    call method%interpolate(t, y)
    call scene%guide%find_contact_state(y, corners)
    value = merge(corners(corner)%depth, corners(corner)%normal_force, quantity == of_depth)
  end function value_at

  !> Account for the penetrations and forces of one evaluation.
  subroutine record_values(self, scene, now, figures)
    class(guide_record_t), intent(inout) :: self
    type(scene_t), intent(in) :: scene
    type(evaluation_t), intent(in) :: now
    type(run_figures_t), intent(inout) :: figures
    integer :: i
    if (.not. self%is_present) return
    do i = 1, n_corners
      if (scene%guide%touches(i)) &
        call add_values(self, i, [now%guide%corner(i)%depth, now%guide%corner(i)%normal_force], figures)
    end do
  end subroutine record_values

  !> Account for values of one corner, for its contact and for the run.
  pure subroutine add_values(self, i, values, figures)
    type(guide_record_t), intent(inout) :: self
    integer, intent(in) :: i
    real(dp), intent(in) :: values(n_peaks)
    type(run_figures_t), intent(inout) :: figures
    associate (contact => self%contact(i), f => figures%corner(i))
      contact%max_penetration = max(contact%max_penetration, values(of_depth))
      contact%max_normal_force = max(contact%max_normal_force, values(of_force))
      f%max_penetration = max(f%max_penetration, values(of_depth))
      f%max_force = max(f%max_force, values(of_force))
    end associate
    self%highest = max(self%highest, values)
  end subroutine add_values

  !> Account for the time [s] that has passed since the last point.
  pure subroutine add_time(self, scene, passed, figures)
    class(guide_record_t), intent(in) :: self
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: passed
    type(run_figures_t), intent(inout) :: figures
    if (.not. self%is_present) return
    where (scene%guide%touches) figures%corner%contact_time = figures%corner%contact_time + passed
  end subroutine add_time

  !> A contact of corner i begins or ends at time t; `now` is evaluated before that event. `event` is its entry in the trace.
  subroutine record_contact(self, i, kind, t, now, figures, event)
    class(guide_record_t), intent(inout) :: self
    integer, intent(in) :: i, kind
    real(dp), intent(in) :: t
    type(evaluation_t), intent(in) :: now
    type(run_figures_t), intent(inout) :: figures
    type(trace_event_t), intent(out) :: event
    if (kind == event_contact_begins) figures%corner(i)%contacts = figures%corner(i)%contacts + 1
    call self%contact(i)%change(kind, kind == event_contact_begins, t, now%motion%crank_angle, now%guide%corner(i)%depth_rate)
    event = self%contact(i)
  end subroutine record_contact
end module guide_record
