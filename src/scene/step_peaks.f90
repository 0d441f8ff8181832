!> The largest force on the pin, the deepest penetration and the largest normal force between the ends of accepted steps.
!>
!> A step is searched where a quantity may come above what is known already. Penetration and normal force follow from the place of
!> the pin alone, on the interpolant of the method. The force on the pin takes evaluations of the scene: where three points do not
!> show that it only rises or only falls, its slope at both ends is found, and where it rises and then falls its peak.
module step_peaks
  use gudgeon_kinds, only: dp
  use ode_method, only: ode_method_t
  use chain_loads, only: force_size
  use joint_motion, only: joint_motion_t
  use chain_motion, only: piston_pin
  use gudgeon_scene, only: scene_t, evaluation_t, phase_free, phase_contact
  use peak_search, only: sample_t, peak_search_t, most_between
  use gudgeon_archive, only: archive_t
  implicit none
  private
  public :: peak_watch_t, of_pin_force, of_penetration, of_normal_force, n_peaks, peaks_of

  !> The quantities, each with one value in an array.
  integer, parameter :: of_pin_force = 1     !! size of the joint's force on the pin [N]
  integer, parameter :: of_penetration = 2   !! |e| - c, negative while apart: the film thickness with its sign turned [m]
  integer, parameter :: of_normal_force = 3  !! of the contact [N]
  integer, parameter :: n_peaks = 3

  real(dp), parameter :: no_peak = -huge(1.0_dp)
  real(dp), parameter :: short = 1e-4_dp      !! part of a piece over which a slope is taken

  !> Follows a run from piece to piece, a piece being a step or the part of it up to an event or the end of a revolution.
  type :: peak_watch_t
    integer :: evaluations = 0                    !! of the scene, so far
    logical, private :: fresh = .true.            !! the scene has changed its phase: the next piece begins there
    logical, private :: has_before = .false.      !! there was a piece before the last one in this phase
    type(sample_t), private :: left(n_peaks), before(n_peaks)
    logical, private :: knows_slope(n_peaks) = .false.   !! of `left`
    real(dp), allocatable, private :: y(:)
  contains
    procedure :: begin
    procedure :: change_phase
    procedure :: search
    procedure :: exchange
  end type peak_watch_t

contains

  !> A run begins at t with what has been evaluated there.
  subroutine begin(self, n, t, now)
    class(peak_watch_t), intent(inout) :: self
    integer, intent(in) :: n                   !! components of the state
    real(dp), intent(in) :: t
    type(evaluation_t), intent(in) :: now
    if (.not. allocated(self%y)) allocate (self%y(n))
    self%left = samples_of(t, now)
    self%knows_slope = [.false., .true., .false.]
    self%fresh = .false.
    self%has_before = .false.
  end subroutine begin

  !> An event has changed the phase of the scene: nothing that was before it tells of what comes.
  pure subroutine change_phase(self)
    class(peak_watch_t), intent(inout) :: self
    self%fresh = .true.
    self%has_before = .false.
  end subroutine change_phase

  !> What has been found so far, to or from an archive.
  subroutine exchange(self, n, archive)
    class(peak_watch_t), intent(inout) :: self
    integer, intent(in) :: n                   !! components of the state
    type(archive_t), intent(inout) :: archive
    integer :: i
    if (.not. allocated(self%y)) allocate (self%y(n))
    call archive%exchange(self%evaluations)
    call archive%exchange(self%fresh)
    call archive%exchange(self%has_before)
    call archive%exchange(self%knows_slope)
    do i = 1, n_peaks
      call self%left(i)%exchange(archive)
      call self%before(i)%exchange(archive)
    end do
  end subroutine exchange

  !> Search the last step of the method from where the piece before ended, or from its beginning, to t_to, for values above
  !> `known`. `largest` is the largest value in the piece but for its end, as far as it has been looked for; else `no_peak`.
  subroutine search(self, method, scene, t_to, now, known, largest)
    class(peak_watch_t), intent(inout) :: self
    class(ode_method_t), intent(inout) :: method
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t_to               !! inside the last step
    type(evaluation_t), intent(in) :: now      !! there
    real(dp), intent(in) :: known(n_peaks)     !! huge: not of interest
    real(dp), intent(out) :: largest(n_peaks)
    type(sample_t) :: right(n_peaks)
    logical :: knows(n_peaks)
    integer :: i

    right = samples_of(t_to, now)
    knows = [.false., .true., .false.]
    largest = no_peak
    if (self%fresh) then
      call meet_beginning(self, method, scene, right(of_normal_force)%value)
      largest = self%left%value
    end if
    if (t_to > self%left(1)%t) then
      do i = 1, n_peaks
        if (known(i) < huge(known)) call search_one(self, method, scene, i, right(i), knows(i), known(i), largest(i))
      end do
      self%before = self%left
      self%has_before = .true.
    end if
    self%left = right
    self%knows_slope = knows
    self%fresh = .false.
  end subroutine search

  !> The quantities in one evaluation.
  pure function peaks_of(now) result(values)
    type(evaluation_t), intent(in) :: now
    real(dp) :: values(n_peaks)
    values(of_pin_force) = force_size(now%loads%force(:, piston_pin))
    values(of_penetration) = now%relative(1)%penetration
    values(of_normal_force) = now%joint(1)%normal_force
  end function peaks_of

  !> They at one instant, as samples; of the penetration the slope is known.
  pure function samples_of(t, now) result(samples)
    real(dp), intent(in) :: t
    type(evaluation_t), intent(in) :: now
    type(sample_t) :: samples(n_peaks)
    samples%t = t
    samples%value = peaks_of(now)
    samples%slope = 0
    samples(of_penetration)%slope = now%relative(1)%penetration_rate
  end function samples_of

  !> The quantities at the beginning of the step, after a change of phase. In free flight there is no force, and at the beginning
  !> of a contact next to none: then the scene need not be evaluated.
  subroutine meet_beginning(self, method, scene, later_force)
    class(peak_watch_t), intent(inout) :: self
    class(ode_method_t), intent(in) :: method
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: later_force   !! normal force at the end of the piece [N]
    real(dp), parameter :: next_to_none = 1e-9_dp
    type(evaluation_t) :: now
    type(joint_motion_t) :: joint
    real(dp) :: normal_force
    logical :: inside

    self%knows_slope = [.false., .true., .false.]
    if (scene%joint_at(piston_pin) > 0) then
      call scene%joints(1)%look(method%y_old, joint, normal_force)
      self%left(of_penetration) = sample_t(method%t_old, joint%penetration, joint%penetration_rate)
      self%left(of_normal_force) = sample_t(method%t_old, normal_force, 0.0_dp)
      self%left(of_pin_force) = self%left(of_normal_force)
      if (scene%phase_at(piston_pin) == phase_free) return
      if (scene%phase_at(piston_pin) == phase_contact .and. normal_force <= next_to_none*later_force) return
    end if
    self%evaluations = self%evaluations + 1
    call scene%evaluate(method%t_old, method%y_old, now, inside)
    if (inside) self%left = samples_of(method%t_old, now)
  end subroutine meet_beginning

  !> Search one quantity from `left` to `right`.
  subroutine search_one(self, method, scene, quantity, right, knows_right, known, largest)
    class(peak_watch_t), intent(inout) :: self
    class(ode_method_t), intent(inout) :: method
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: quantity
    type(sample_t), intent(inout) :: right
    logical, intent(inout) :: knows_right      !! its slope is known; it may be found
    real(dp), intent(in) :: known
    real(dp), intent(inout) :: largest
    type(peak_search_t) :: peak
    real(dp) :: t
    logical :: is_done

    associate (left => self%left(quantity))
      if (.not. (knows_right .and. self%knows_slope(quantity))) then
        if (.not. may_exceed(self, quantity, right, known)) return
        if (.not. knows_right) call find_slope(right, -1)
        knows_right = .true.
        if (right%slope >= 0 .and. right%value >= left%value .and. .not. self%knows_slope(quantity) .and. self%has_before) return
        if (.not. self%knows_slope(quantity)) call find_slope(left, 1)
      end if
      if (.not. (left%slope > 0 .and. right%slope < 0)) then
        if (most_between(left, right) <= max(known, left%value, right%value)) return
      else if (most_between(left, right) <= known) then
        return
      end if
      call peak%begin(left, right)
      do
        call peak%next_time(t, is_done)
        if (is_done) exit
        call peak%take(t, value_at(t))
      end do
      largest = max(largest, peak%best%value)
    end associate

  contains

    !> Slope of a sample at one end of the piece, by one more value `short` of it, later (1) or earlier (-1).
    subroutine find_slope(at, way)
      type(sample_t), intent(inout) :: at
      integer, intent(in) :: way
      real(dp) :: t
      t = at%t + way*short*(right%t - self%left(quantity)%t)
      at%slope = 0
      if (abs(t - at%t) > 0) at%slope = (value_at(t) - at%value)/(t - at%t)
    end subroutine find_slope

    !> The quantity inside the step, where the scene is defined.
    real(dp) function value_at(t)
      real(dp), intent(in) :: t
      type(evaluation_t) :: now
      type(joint_motion_t) :: joint
      real(dp) :: normal_force
      logical :: inside
      call method%interpolate(t, self%y)
      if (quantity == of_pin_force) then
        self%evaluations = self%evaluations + 1
        call scene%evaluate(t, self%y, now, inside)
        value_at = no_peak
        if (inside) value_at = force_size(now%loads%force(:, piston_pin))
      else
        call scene%joints(1)%look(self%y, joint, normal_force)
        value_at = merge(joint%penetration, normal_force, quantity == of_penetration)
      end if
    end function value_at
  end subroutine search_one

  !> Whether a quantity without slopes may come above what is known, inside the piece up to `right`. It may not where it is too far
  !> below at both ends for its changes in this piece and the one before, nor where the parabola through three points, with twice
  !> its bend, only rises or only falls.
  pure logical function may_exceed(self, quantity, right, known)
    class(peak_watch_t), intent(in) :: self
    integer, intent(in) :: quantity
    type(sample_t), intent(in) :: right
    real(dp), intent(in) :: known
    real(dp) :: change, earlier_change, rate, bend
    associate (left => self%left(quantity), before => self%before(quantity))
      change = right%value - left%value
      earlier_change = 0
      if (self%has_before) earlier_change = left%value - before%value
      may_exceed = max(left%value, right%value) + 2*abs(change) + abs(earlier_change) > known
      if (.not. (may_exceed .and. self%has_before)) return
      rate = change/(right%t - left%t)
      bend = abs(rate - earlier_change/(left%t - before%t))*(right%t - left%t)/(right%t - before%t)
      may_exceed = abs(rate) <= 2*bend
    end associate
  end function may_exceed
end module step_peaks
