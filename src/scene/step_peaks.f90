!> Searches the largest force on a pin, the largest penetration, the largest normal force and the largest eccentricity between
!> accepted points.
!>
!> A step is searched only if a quantity may exceed the largest value known so far. Penetration and normal force follow from the
!> eccentricity alone and are taken from the interpolant of the method. The force on the pin, and the eccentricity between walls
!> that give way, need evaluations of the scene. Slopes of the forces and of that eccentricity are not known: unless three points
!> show that such a quantity only rises or only falls, its slopes at both ends are computed, and its peak is searched if it rises
!> and then falls.
module step_peaks
  use kinds, only: dp
  use ode_method, only: ode_method_t
  use chain_loads, only: force_size
  use joint_evaluation, only: joint_evaluation_t
  use scene_problem, only: scene_t, evaluation_t, phase_free, phase_contact
  use inside_step, only: evaluate_inside
  use peak_search, only: sample_t, peak_search_t, may_peak, may_exceed
  implicit none
  private
  public :: peak_watch_t, of_pin_force, of_penetration, of_normal_force, of_eccentricity, n_peaks

  !> The quantities: indices into arrays of values.
  integer, parameter :: of_pin_force = 1     !! magnitude of the force of the joint on the pin [N]
  integer, parameter :: of_penetration = 2   !! |e| - c, negative without contact: the negative of the film thickness [m]
  integer, parameter :: of_normal_force = 3  !! normal force of the contact [N]
  integer, parameter :: of_eccentricity = 4  !! |e| [m]
  integer, parameter :: n_peaks = 4

  real(dp), parameter :: no_peak = -huge(1.0_dp)
  real(dp), parameter :: short = 3e-3_dp      !! fraction of an interval over which a slope is taken: over much less, the difference
                                              !! of the interpolant from the value at the end of a step would hide it

  !> Follows one pin through a run, interval by interval. An interval is a step, or a part of it that ends at an event or at the end
  !> of a revolution.
  type :: peak_watch_t
    integer :: pin = 0                            !! index in `places`
    integer :: joint = 0  !! index of the scene's joint at this pin; 0: the pin is ideal, and only its force is searched
    integer :: evaluations = 0                    !! number of evaluations of the scene so far
    real(dp) :: thinnest_time = 0                 !! time of the largest penetration in the last interval [s]
    logical, private :: fresh = .true.            !! an event has changed the phase of a joint: the next interval begins there
    logical, private :: has_before = .false.      !! there was an earlier interval in this phase
    real(dp), private :: t_before = 0, t = 0      !! beginning and end of the last interval [s]
    real(dp), private :: before(n_peaks) = 0, last(n_peaks) = 0   !! values of the quantities there
    real(dp), private :: slope(n_peaks) = 0       !! slopes at t, of the penetration and of the forces
    real(dp), private :: slope_time(n_peaks) = -huge(1.0_dp)   !! time at which the slope was computed [s]
  contains
    procedure, non_overridable :: begin
    procedure, non_overridable :: change_phase
    procedure, non_overridable :: search_interval
    procedure, non_overridable :: values
  end type peak_watch_t

contains

  !> Begin a run at t, where the scene has been evaluated.
  pure subroutine begin(self, scene, t, now)
    class(peak_watch_t), intent(inout) :: self
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t
    type(evaluation_t), intent(in) :: now
    self%fresh = .false.
    self%has_before = .false.
    call stand_at(self, t, self%values(scene, now), rate_of(self, now))
  end subroutine begin

  !> Let the next interval begin at t.
  pure subroutine stand_at(self, t, values, rate)
    class(peak_watch_t), intent(inout) :: self
    real(dp), intent(in) :: t, values(n_peaks), rate
    self%t = t
    self%last = values
    self%slope(of_penetration) = rate
  end subroutine stand_at

  !> An event has changed the phase of a joint: earlier values cannot be used to predict later ones.
  pure subroutine change_phase(self)
    class(peak_watch_t), intent(inout) :: self
    self%fresh = .true.
    self%has_before = .false.
    self%slope_time = -huge(1.0_dp)
  end subroutine change_phase

  !> The values of the quantities in one evaluation.
  pure function values(self, scene, now)
    class(peak_watch_t), intent(in) :: self
    type(scene_t), intent(in) :: scene
    type(evaluation_t), intent(in) :: now
    real(dp) :: values(n_peaks)
    values(of_pin_force) = force_size(scene%pin_force(now, self%pin))
    values(of_penetration) = 0
    values(of_normal_force) = 0
    values(of_eccentricity) = 0
    if (self%joint == 0) return
    values(of_penetration) = now%joint(self%joint)%penetration
    values(of_normal_force) = now%joint(self%joint)%normal_force
    values(of_eccentricity) = now%joint(self%joint)%distance
  end function values

  !> The rate of the penetration in one evaluation [m/s].
  pure real(dp) function rate_of(self, now) result(rate)
    class(peak_watch_t), intent(in) :: self
    type(evaluation_t), intent(in) :: now
    rate = 0
    if (self%joint > 0) rate = now%joint(self%joint)%penetration_rate
  end function rate_of

  !> Search the last step of the method, from the end of the last interval or from the beginning of the step to t_to, for values
  !> above `known`. `largest` is the largest value found in the interval, including its end. Most intervals are finished after a few
  !> comparisons, without copies or calls.
  subroutine search_interval(self, method, scene, t_to, now, known, largest)
    class(peak_watch_t), intent(inout) :: self
    class(ode_method_t), intent(inout) :: method
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t_to               !! inside the last step
    type(evaluation_t), intent(in) :: now      !! evaluation at t_to
    real(dp), intent(in) :: known(n_peaks)     !! huge: this quantity is not searched
    real(dp), intent(out) :: largest(n_peaks)
    real(dp) :: ends(n_peaks), rate

    ends = self%values(scene, now)
    rate = rate_of(self, now)
    largest = ends
    self%thinnest_time = t_to
    if (self%fresh) then
      call meet_beginning(self, method, scene, ends(of_normal_force))
      largest = max(ends, self%last)
      if (self%last(of_penetration) > ends(of_penetration)) self%thinnest_time = self%t
      self%fresh = .false.
    end if
    if (t_to > self%t) then
      if (known(of_pin_force) < huge(known)) call search_by_slopes(of_pin_force)
      if (known(of_normal_force) < huge(known)) call search_by_slopes(of_normal_force)
      if (known(of_eccentricity) < huge(known)) call search_by_slopes(of_eccentricity)
      if (known(of_penetration) < huge(known)) call search_between(self, method, scene, of_penetration, &
        sample_t(self%t, self%last(of_penetration), self%slope(of_penetration)), sample_t(t_to, ends(of_penetration), rate), &
        known(of_penetration), largest(of_penetration))
      self%t_before = self%t
      self%before = self%last
      self%has_before = .true.
    end if
    call stand_at(self, t_to, ends, rate)

  contains

    subroutine search_by_slopes(i)
      integer, intent(in) :: i
      if (may_exceed(self%t, self%last(i), t_to, ends(i), known(i), self%has_before, self%t_before, self%before(i))) &
        call find_peak_by_slopes(self, method, scene, i, t_to, ends(i), known(i), largest(i))
    end subroutine search_by_slopes
  end subroutine search_interval

  !> Find the quantities at the beginning of the step, after a change of phase. In free flight there is no force, and at the
  !> beginning of a contact nearly none: the scene is then not evaluated.
  subroutine meet_beginning(self, method, scene, later_force)
    class(peak_watch_t), intent(inout) :: self
    class(ode_method_t), intent(in) :: method
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: later_force   !! normal force at the end of the interval [N]
    real(dp), parameter :: next_to_none = 1e-9_dp
    type(evaluation_t) :: now
    type(joint_evaluation_t) :: motion
    real(dp) :: normal_force
    logical :: in_domain

    if (self%joint > 0) then
      associate (joint => scene%joints(self%joint))
        call joint%find_contact_state(method%y_old, motion, normal_force)
        call stand_at(self, method%t_old, [normal_force, motion%penetration, normal_force, motion%distance], &
          motion%penetration_rate)
        if (joint%phase == phase_free) return
        if (joint%phase == phase_contact .and. normal_force <= next_to_none*later_force) return
      end associate
    end if
    self%evaluations = self%evaluations + 1
    call scene%evaluate(method%t_old, method%y_old, now, in_domain)
    if (in_domain) call stand_at(self, method%t_old, self%values(scene, now), rate_of(self, now))
  end subroutine meet_beginning

  !> Search the peak of a quantity without known slopes that may exceed the known maximum, and is `value` at t_to. Its slopes are
  !> computed first.
  subroutine find_peak_by_slopes(self, method, scene, quantity, t_to, value, known, largest)
    class(peak_watch_t), intent(inout) :: self
    class(ode_method_t), intent(inout) :: method
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: quantity
    real(dp), intent(in) :: t_to, value, known
    real(dp), intent(inout) :: largest
    type(sample_t) :: left, right
    logical :: rises
    left = sample_t(self%t, self%last(quantity), self%slope(quantity))
    right = sample_t(t_to, value, 0.0_dp)
    right%slope = slope_at(right, -1)
    rises = .false.
    if (self%slope_time(quantity) < self%t) then
      rises = .not. (right%slope < 0 .or. right%value < left%value) .and. self%has_before
      if (.not. rises) left%slope = slope_at(left, 1)
    end if
    if (.not. rises) call search_between(self, method, scene, quantity, left, right, known, largest)
    self%slope(quantity) = right%slope
    self%slope_time(quantity) = t_to

  contains

    !> Slope at one end of the interval, from one more value at a fraction `short` of the interval later (1) or earlier (-1).
    real(dp) function slope_at(at, way)
      type(sample_t), intent(in) :: at
      integer, intent(in) :: way
      real(dp) :: t
      t = at%t + way*short*(right%t - left%t)
      slope_at = 0
      if (abs(t - at%t) > 0) slope_at = (value_inside(self, method, scene, quantity, t) - at%value)/(t - at%t)
    end function slope_at
  end subroutine find_peak_by_slopes

  !> Search the peak between two samples, if it may exceed `known`.
  subroutine search_between(self, method, scene, quantity, left, right, known, largest)
    class(peak_watch_t), intent(inout) :: self
    class(ode_method_t), intent(inout) :: method
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: quantity
    type(sample_t), intent(in) :: left, right
    real(dp), intent(in) :: known
    real(dp), intent(inout) :: largest
    if (may_peak(left%t, left%value, left%slope, right%t, right%value, right%slope, known)) &
      call search_peak(self, method, scene, quantity, left, right, largest)
  end subroutine search_between

  !> Search the peak between two samples.
  subroutine search_peak(self, method, scene, quantity, left, right, largest)
    class(peak_watch_t), intent(inout) :: self
    class(ode_method_t), intent(inout) :: method
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: quantity
    type(sample_t), intent(in) :: left, right
    real(dp), intent(inout) :: largest
    type(peak_search_t) :: peak
    real(dp) :: t
    logical :: is_done
    call peak%begin(left, right)
    do
      call peak%next_time(t, is_done)
      if (is_done) exit
      call peak%add_value(t, value_inside(self, method, scene, quantity, t))
    end do
    if (quantity == of_penetration .and. peak%value(1) > largest) self%thinnest_time = peak%t(1)
    largest = max(largest, peak%value(1))
  end subroutine search_peak

  !> The value of a quantity at a time inside the step; `no_peak` where the scene is not defined and the value needs its evaluation.
  real(dp) function value_inside(self, method, scene, quantity, t) result(value)
    class(peak_watch_t), intent(inout) :: self
    class(ode_method_t), intent(inout) :: method
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: quantity
    real(dp), intent(in) :: t
    type(evaluation_t) :: now
    type(joint_evaluation_t) :: motion
    real(dp) :: normal_force, y(size(method%y)), all_values(n_peaks)
    logical :: in_domain
    if (quantity == of_pin_force .or. quantity == of_eccentricity) then
      call evaluate_inside(scene, method, t, y, now, in_domain, self%evaluations)
      value = no_peak
      if (.not. in_domain) return
      all_values = self%values(scene, now)
      value = all_values(quantity)
    else
      call method%interpolate(t, y)
      call scene%joints(self%joint)%find_contact_state(y, motion, normal_force)
      value = merge(motion%penetration, normal_force, quantity == of_penetration)
    end if
  end function value_inside
end module step_peaks
