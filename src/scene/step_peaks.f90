!> The largest force on a pin, the deepest penetration and the largest normal force between the ends of accepted steps.
!>
!> A step is searched where a quantity may come above what is known already. Penetration and normal force follow from the place of
!> the pin alone, on the interpolant of the method. The force on the pin takes evaluations of the scene: where three points do not
!> show that it only rises or only falls, its slope at both ends is found, and where it rises and then falls its peak.
module step_peaks
  use gudgeon_kinds, only: dp
  use gudgeon_archive, only: archive_t
  use ode_method, only: ode_method_t
  use chain_motion, only: piston_pin
  use chain_loads, only: force_size
  use joint_motion, only: joint_motion_t
  use gudgeon_scene, only: scene_t, evaluation_t, phase_free, phase_contact
  use peak_search, only: sample_t, peak_search_t, may_peak
  implicit none
  private
  public :: peak_watch_t, of_pin_force, of_penetration, of_normal_force, n_peaks

  !> The quantities, each with one value in an array.
  integer, parameter :: of_pin_force = 1     !! size of the joint's force on the pin [N]
  integer, parameter :: of_penetration = 2   !! |e| - c, negative while apart: the film thickness with its sign turned [m]
  integer, parameter :: of_normal_force = 3  !! of the contact [N]
  integer, parameter :: n_peaks = 3

  real(dp), parameter :: no_peak = -huge(1.0_dp)
  real(dp), parameter :: short = 1e-4_dp      !! part of a piece over which a slope is taken

  !> Follows one pin from piece to piece of a run, a piece being a step or the part of it up to an event or the end of a revolution.
  type :: peak_watch_t
    integer :: pin = piston_pin                   !! of the chain
    integer :: joint = 0                          !! which of the scene's is there; 0: the pin is ideal, and has its force alone
    integer :: evaluations = 0                    !! of the scene, so far
    logical, private :: fresh = .true.            !! the scene has changed its phase: the next piece begins there
    logical, private :: has_before = .false.      !! there was a piece before the last one in this phase
    real(dp), private :: t_before = 0, t = 0      !! where the last piece began and ended [s]
    real(dp), private :: before(n_peaks) = 0, last(n_peaks) = 0   !! what the quantities were there
    real(dp), private :: slope(n_peaks) = 0                       !! at t, where it is known
    logical, private :: knows_slope(n_peaks) = .false.
  contains
    procedure :: begin
    procedure :: change_phase
    procedure :: search
    procedure :: values
    procedure :: exchange
  end type peak_watch_t

contains

  !> A run begins at t with what has been evaluated there.
  subroutine begin(self, t, now)
    class(peak_watch_t), intent(inout) :: self
    real(dp), intent(in) :: t
    type(evaluation_t), intent(in) :: now
    self%fresh = .false.
    self%has_before = .false.
    call take_end(self, t, now)
  end subroutine begin

  !> The end of a piece, which is the beginning of the next.
  pure subroutine take_end(self, t, now)
    class(peak_watch_t), intent(inout) :: self
    real(dp), intent(in) :: t
    type(evaluation_t), intent(in) :: now
    self%t = t
    self%last = self%values(now)
    self%knows_slope = .false.
    if (self%joint == 0) return
    self%knows_slope(of_penetration) = .true.
    self%slope(of_penetration) = now%relative(self%joint)%penetration_rate
  end subroutine take_end

  !> An event has changed the phase of the scene: nothing that was before it tells of what comes.
  pure subroutine change_phase(self)
    class(peak_watch_t), intent(inout) :: self
    self%fresh = .true.
    self%has_before = .false.
  end subroutine change_phase

  !> What has been found so far, to or from an archive; not which pin it is.
  subroutine exchange(self, archive)
    class(peak_watch_t), intent(inout) :: self
    type(archive_t), intent(inout) :: archive
    call archive%exchange(self%evaluations)
    call archive%exchange(self%fresh)
    call archive%exchange(self%has_before)
    call archive%exchange(self%t_before)
    call archive%exchange(self%t)
    call archive%exchange(self%before)
    call archive%exchange(self%last)
    call archive%exchange(self%slope)
    call archive%exchange(self%knows_slope)
  end subroutine exchange

  !> The quantities in one evaluation.
  pure function values(self, now)
    class(peak_watch_t), intent(in) :: self
    type(evaluation_t), intent(in) :: now
    real(dp) :: values(n_peaks)
    values(of_pin_force) = force_size(now%loads%force(:, self%pin))
    values(of_penetration) = 0
    values(of_normal_force) = 0
    if (self%joint == 0) return
    values(of_penetration) = now%relative(self%joint)%penetration
    values(of_normal_force) = now%joint(self%joint)%normal_force
  end function values

  !> Search the last step of the method from where the piece before ended, or from its beginning, to t_to, for values above
  !> `known`. `largest` is the largest value in the piece, its end among them, as far as it has been looked for.
  subroutine search(self, method, scene, t_to, now, known, largest)
    class(peak_watch_t), intent(inout) :: self
    class(ode_method_t), intent(inout) :: method
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t_to               !! inside the last step
    type(evaluation_t), intent(in) :: now      !! there
    real(dp), intent(in) :: known(n_peaks)     !! huge: not of interest
    real(dp), intent(out) :: largest(n_peaks)
    type(peak_watch_t) :: next
    integer :: i

    next%pin = self%pin
    next%joint = self%joint
    call take_end(next, t_to, now)
    largest = next%last
    if (self%fresh) then
      call meet_beginning(self, method, scene, largest(of_normal_force))
      largest = max(largest, self%last)
    end if
    if (t_to > self%t) then
      do i = 1, n_peaks
        if (known(i) < huge(known)) then
          if (may_exceed(self, next, i, known(i))) call search_one(self, next, method, scene, i, known(i), largest(i))
        end if
      end do
      self%t_before = self%t
      self%before = self%last
      self%has_before = .true.
    end if
    self%t = next%t
    self%last = next%last
    self%slope = next%slope
    self%knows_slope = next%knows_slope
    self%fresh = .false.
  end subroutine search

  !> The quantities at the beginning of the step, after a change of phase. In free flight there is no force, and at the beginning
  !> of a contact next to none: then the scene need not be evaluated.
  subroutine meet_beginning(self, method, scene, later_force)
    class(peak_watch_t), intent(inout) :: self
    class(ode_method_t), intent(in) :: method
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: later_force   !! normal force at the end of the piece [N]
    real(dp), parameter :: next_to_none = 1e-9_dp
    type(evaluation_t) :: now
    type(joint_motion_t) :: motion
    real(dp) :: normal_force
    logical :: inside

    if (self%joint > 0) then
      associate (joint => scene%joints(self%joint))
        call joint%look(method%y_old, motion, normal_force)
        self%t = method%t_old
        self%last = [normal_force, motion%penetration, normal_force]
        self%knows_slope = [.false., .true., .false.]
        self%slope(of_penetration) = motion%penetration_rate
        if (joint%phase == phase_free) return
        if (joint%phase == phase_contact .and. normal_force <= next_to_none*later_force) return
      end associate
    end if
    self%evaluations = self%evaluations + 1
    call scene%evaluate(method%t_old, method%y_old, now, inside)
    if (inside) call take_end(self, method%t_old, now)
  end subroutine meet_beginning

  !> Whether a quantity may come above what is known, inside the piece up to `next`. Without slopes it may not where it is too far
  !> below at both ends for its changes in this piece and the one before, nor where the parabola through three points, with twice
  !> its bend, only rises or only falls.
  pure logical function may_exceed(self, next, i, known)
    class(peak_watch_t), intent(in) :: self
    type(peak_watch_t), intent(in) :: next
    integer, intent(in) :: i
    real(dp), intent(in) :: known
    real(dp) :: change, earlier_change, rate, bend
    if (next%knows_slope(i) .and. self%knows_slope(i)) then
      may_exceed = may_peak(sample(self, i), sample(next, i), known)
      return
    end if
    change = next%last(i) - self%last(i)
    earlier_change = 0
    if (self%has_before) earlier_change = self%last(i) - self%before(i)
    may_exceed = max(self%last(i), next%last(i)) + 2*abs(change) + abs(earlier_change) > known
    if (.not. (may_exceed .and. self%has_before)) return
    rate = change/(next%t - self%t)
    bend = abs(rate - earlier_change/(self%t - self%t_before))*(next%t - self%t)/(next%t - self%t_before)
    may_exceed = abs(rate) <= 2*bend
  end function may_exceed

  !> One quantity where the last piece ended.
  pure type(sample_t) function sample(self, i)
    class(peak_watch_t), intent(in) :: self
    integer, intent(in) :: i
    sample = sample_t(self%t, self%last(i), self%slope(i))
  end function sample

  !> Search one quantity that may come above what is known, from the end of the last piece to `next`.
  subroutine search_one(self, next, method, scene, quantity, known, largest)
    class(peak_watch_t), intent(inout) :: self
    type(peak_watch_t), intent(inout) :: next
    class(ode_method_t), intent(inout) :: method
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: quantity
    real(dp), intent(in) :: known
    real(dp), intent(inout) :: largest
    type(peak_search_t) :: peak
    real(dp) :: t, y(size(method%y))
    logical :: is_done

    if (.not. next%knows_slope(quantity)) call find_slope(next, -1)
    if (.not. self%knows_slope(quantity)) then
      if (next%slope(quantity) >= 0 .and. next%last(quantity) >= self%last(quantity) .and. self%has_before) return
      call find_slope(self, 1)
    end if
    if (.not. may_peak(sample(self, quantity), sample(next, quantity), known)) return
    call peak%begin(sample(self, quantity), sample(next, quantity))
    do
      call peak%next_time(t, is_done)
      if (is_done) exit
      call peak%take(t, value_at(t))
    end do
    largest = max(largest, peak%value(1))

  contains

    !> Slope at one end of the piece, by one more value `short` of it, later (1) or earlier (-1).
    subroutine find_slope(at, way)
      class(peak_watch_t), intent(inout) :: at
      integer, intent(in) :: way
      real(dp) :: t
      t = at%t + way*short*(next%t - self%t)
      at%slope(quantity) = 0
      if (abs(t - at%t) > 0) at%slope(quantity) = (value_at(t) - at%last(quantity))/(t - at%t)
      at%knows_slope(quantity) = .true.
    end subroutine find_slope

    !> The quantity inside the step, where the scene is defined.
    real(dp) function value_at(t)
      real(dp), intent(in) :: t
      type(evaluation_t) :: now
      type(joint_motion_t) :: motion
      real(dp) :: normal_force
      logical :: inside
      call method%interpolate(t, y)
      if (quantity == of_pin_force) then
        self%evaluations = self%evaluations + 1
        call scene%evaluate(t, y, now, inside)
        value_at = no_peak
        if (inside) value_at = force_size(now%loads%force(:, self%pin))
      else
        call scene%joints(self%joint)%look(y, motion, normal_force)
        value_at = merge(motion%penetration, normal_force, quantity == of_penetration)
      end if
    end function value_at
  end subroutine search_one
end module step_peaks
