!> Records the contacts at the corners of the skirt in its bore.
module guide_record
  use kinds, only: dp
  use run_state, only: run_state_t
  use joint_places, only: n_places
  use piston_guide, only: n_corners, corner_names
  use result_ledger, only: ledger_t
  use scene_problem, only: scene_t, evaluation_t, event_contact_begins
  use trace_sink, only: trace_event_t
  use run_figures, only: run_figures_t
  use cycle_watch, only: cycle_watch_t
  implicit none
  private
  public :: guide_record_t

  type :: guide_record_t
    logical :: is_present = .false.      !! the corners of a skirt may touch the bore
    type(trace_event_t), private :: contact(n_corners)   !! present or last contact of each corner
  contains
    procedure, non_overridable :: prepare
    procedure, non_overridable :: declare
    procedure, non_overridable :: end_revolution
    procedure, non_overridable :: add_time
    procedure, non_overridable :: record_contact
  end type guide_record_t

contains

  !> Prepare the record for a scene.
  subroutine prepare(self, scene)
    class(guide_record_t), intent(out) :: self
    type(scene_t), intent(in) :: scene
    integer :: i
    if (allocated(scene%guide)) self%is_present = scene%guide%touching > 0
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
      call figures%corner(i)%declare(corner_names(i)//'_', list)
      call self%contact(i)%declare(list)
    end do
  end subroutine declare

  !> End the revolution: its largest penetration [m] and force [N] at a corner and its impacts are added to the results.
  pure subroutine end_revolution(self, ledger, cycles)
    class(guide_record_t), intent(inout) :: self
    type(ledger_t), intent(in) :: ledger
    type(cycle_watch_t), intent(inout) :: cycles
    integer :: i
    if (.not. self%is_present) return
    call cycles%record_skirt(max(0.0_dp, maxval([(-ledger%of_revolution(corner_names(i)//'_min_gap'), i=1, n_corners)])), &
      maxval([(ledger%of_revolution(corner_names(i)//'_max_force'), i=1, n_corners)]), &
      nint(sum([(ledger%of_revolution(corner_names(i)//'_impacts'), i=1, n_corners)])))
  end subroutine end_revolution

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
  subroutine record_contact(self, i, kind, scene, t, now, ledger, figures, event)
    class(guide_record_t), intent(inout) :: self
    integer, intent(in) :: i, kind
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t
    type(evaluation_t), intent(in) :: now
    type(ledger_t), intent(inout) :: ledger
    type(run_figures_t), intent(inout) :: figures
    type(trace_event_t), intent(out) :: event
    if (kind == event_contact_begins) figures%corner(i)%contacts = figures%corner(i)%contacts + 1
    call self%contact(i)%change(kind, kind == event_contact_begins, t, now%motion%crank_angle, now%guide%corner(i)%depth_rate)
    event = self%contact(i)
    if (kind == event_contact_begins) then
      call ledger%begin_contact(corner_names(i)//'_', scene, t, now)
    else
      call ledger%find_contact(corner_names(i)//'_', event%max_penetration, event%max_normal_force)
      call ledger%end_contact(corner_names(i)//'_')
    end if
  end subroutine record_contact
end module guide_record
