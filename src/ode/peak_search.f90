!> Searches the largest value of a smooth quantity between two instants, with few evaluations.
module peak_search
  use kinds, only: dp
  implicit none
  private
  public :: sample_t, peak_search_t, may_peak, may_exceed, top_of_cubic

  integer, parameter :: most_values = 40
  real(dp), parameter :: resolution = 1e-8_dp   !! of the time, relative to the interval
  real(dp), parameter :: worthwhile = 1e-12_dp  !! a search ends if the expected gain is less than this fraction of the value

  !> A quantity at one instant.
  type :: sample_t
    real(dp) :: t = 0, value = 0, slope = 0   !! slope: derivative with respect to time
  end type sample_t

  !> A search for a maximum. The caller evaluates the quantity at the time given by `next_time` and passes the value to `add_value`,
  !> until the search is done. The first time is the maximum of the cubic through values and slopes at both ends; then follow maxima
  !> of parabolas through the three best points, or golden sections where these fail (Brent 1973, ch. 5).
  type :: peak_search_t
    real(dp) :: value(3) = 0              !! the three largest values so far, the largest first
    real(dp) :: t(3) = 0                  !! their times
    type(sample_t), private :: left, right   !! bracket of the maximum
    real(dp), private :: width = 0        !! initial width of the interval
    real(dp), private :: last = 0, last_but_one = 0   !! distances between successive times
    integer, private :: values = 0
    logical, private :: has_top = .false. !! the largest value is inside the interval and not below its ends
  contains
    procedure :: begin
    procedure :: next_time
    procedure :: add_value
  end type peak_search_t

contains

  !> Whether the quantity may exceed `known` between two instants with given values and slopes and, unless it rises at the first and
  !> falls at the second, also exceed the values there. The bound is the cubic through the data in Bernstein form, with twice its
  !> deviation from the straight line.
  pure logical function may_peak(t_left, left, left_slope, t_right, right, right_slope, known)
    real(dp), intent(in) :: t_left, left, left_slope, t_right, right, right_slope, known
    real(dp), parameter :: third = 1/3.0_dp
    real(dp) :: rise_left, rise_right, line, most   ! per third of the interval
    rise_left = third*(t_right - t_left)*left_slope
    rise_right = third*(t_right - t_left)*right_slope
    line = third*(right - left)
    most = max(left + rise_left, right - rise_right) + max(abs(rise_left - line), abs(rise_right - line))
    may_peak = most > known
    if (may_peak .and. .not. (left_slope > 0 .and. right_slope < 0)) may_peak = most > max(left, right)
  end function may_peak

  !> Whether a quantity whose slopes are not known may exceed `known` between two instants. It cannot if it is far below that at
  !> both, compared with its changes between them and since an instant before, or if the parabola through the three values, with
  !> its curvature doubled, is monotonic.
  pure logical function may_exceed(t_left, left, t_right, right, known, has_before, t_before, before)
    real(dp), intent(in) :: t_left, left, t_right, right, known
    logical, intent(in) :: has_before          !! there is an instant before
    real(dp), intent(in) :: t_before, before   !! it, if there is one
    real(dp) :: change, earlier_change, rate, bend
    change = right - left
    earlier_change = 0
    if (has_before) earlier_change = left - before
    may_exceed = max(left, right) + 2*abs(change) + abs(earlier_change) > known
    if (.not. (may_exceed .and. has_before)) return
    rate = change/(t_right - t_left)
    bend = abs(rate - earlier_change/(t_left - t_before))*(t_right - t_left)/(t_right - t_before)
    may_exceed = abs(rate) <= 2*bend
  end function may_exceed

  !> The top of the cubic through two samples, which is inside the interval if the quantity rises at the first one and falls at the
  !> second one.
  pure subroutine top_of_cubic(left, right, top, is_inside)
    type(sample_t), intent(in) :: left, right
    real(dp), intent(out) :: top
    logical, intent(out) :: is_inside
    real(dp) :: h, a, b, c, s
    top = max(left%value, right%value)
    is_inside = left%slope > 0 .and. right%slope < 0
    if (.not. is_inside) return
    h = right%t - left%t
    c = h*left%slope
    b = 3*(right%value - left%value) - h*(2*left%slope + right%slope)
    a = h*(left%slope + right%slope) - 2*(right%value - left%value)
    s = c/(sqrt(max(b**2 - 3*a*c, 0.0_dp)) - b)   ! the zero of the slope where it falls; it falls at the end, so the root is larger
    is_inside = s > 0 .and. s < 1
    if (is_inside) top = left%value + s*(c + s*(b + s*a))
  end subroutine top_of_cubic

  !> Begin a search between two samples with slopes.
  subroutine begin(self, left, right)
    class(peak_search_t), intent(out) :: self
    type(sample_t), intent(in) :: left, right
    self%left = left
    self%right = right
    self%width = right%t - left%t
    if (right%value > left%value) then
      self%t = [right%t, right%t, left%t]
      self%value = [right%value, right%value, left%value]
    else
      self%t = [left%t, left%t, right%t]
      self%value = [left%value, left%value, right%value]
    end if
    self%last = self%width
    self%last_but_one = self%width
  end subroutine begin

  !> The time at which the quantity is to be evaluated next.
  pure subroutine next_time(self, t, is_done)
    class(peak_search_t), intent(inout) :: self
    real(dp), intent(out) :: t
    logical, intent(out) :: is_done
    real(dp), parameter :: golden = 0.381966_dp
    real(dp) :: way, gain
    logical :: has_parabola

    associate (a => self%left, b => self%right, x => self%t(1))
      is_done = self%values >= most_values
      t = a%t + 0.5_dp*(b%t - a%t)
      if (self%values == 0) then
        if (a%slope > 0 .and. b%slope < 0) t = a%t + cubic_peak(a, b)*(b%t - a%t)
      else if (.not. self%has_top) then
        call step_from_end(self, t, is_done)
      else
        call find_parabola(self, has_parabola, way, gain)
        if (has_parabola .and. self%values > 1 .and. gain <= worthwhile*abs(self%value(1))) is_done = .true.
        if (max(x - a%t, b%t - x) <= 2*resolution*self%width) is_done = .true.
        if (.not. has_parabola .or. abs(way) >= 0.5_dp*abs(self%last_but_one) .or. x + way <= a%t .or. x + way >= b%t) then
          self%last = merge(a%t - x, b%t - x, x - a%t > b%t - x)
          way = golden*self%last
        end if
        self%last_but_one = self%last
        self%last = way
        t = x + sign(max(abs(way), resolution*self%width), way)
      end if
      is_done = is_done .or. .not. (t > a%t .and. t < b%t)
    end associate
  end subroutine next_time

  !> If no value inside exceeds both ends: move towards the higher end, if the quantity rises from there.
  pure subroutine step_from_end(self, t, is_done)
    class(peak_search_t), intent(in) :: self
    real(dp), intent(inout) :: t
    logical, intent(inout) :: is_done
    real(dp) :: width, rise
    associate (a => self%left, b => self%right)
      width = b%t - a%t
      if (a%value >= b%value) then
        rise = a%slope*width
        if (rise > 0) t = a%t + 0.5_dp*width*rise/(rise + (a%value - b%value))
      else
        rise = -b%slope*width
        if (rise > 0) t = b%t - 0.5_dp*width*rise/(rise + (b%value - a%value))
      end if
      is_done = is_done .or. .not. rise > 0 .or. width <= 2*resolution*self%width
    end associate
  end subroutine step_from_end

  !> Maximum of the parabola through the three best points, if it has one: its distance from the best point and its gain.
  pure subroutine find_parabola(self, has_peak, way, gain)
    class(peak_search_t), intent(in) :: self
    logical, intent(out) :: has_peak
    real(dp), intent(out) :: way, gain
    real(dp) :: to_second, to_third, chord, curvature, slope
    has_peak = .false.
    way = 0
    gain = 0
    to_second = self%t(2) - self%t(1)
    to_third = self%t(3) - self%t(1)
    if (.not. (abs(to_second) > 0 .and. abs(to_third) > 0 .and. abs(to_third - to_second) > 0)) return
    chord = (self%value(2) - self%value(1))/to_second
    curvature = ((self%value(3) - self%value(1))/to_third - chord)/(to_third - to_second)
    if (.not. curvature < 0) return
    has_peak = .true.
    slope = chord - curvature*to_second
    way = -slope/(2*curvature)
    gain = 0.5_dp*slope*way
  end subroutine find_parabola

  !> Pass the value of the quantity at t, between the ends.
  pure subroutine add_value(self, t, value)
    class(peak_search_t), intent(inout) :: self
    real(dp), intent(in) :: t, value
    type(sample_t) :: bound
    integer :: rank
    logical :: is_left
    self%values = self%values + 1
    rank = 3
    if (value >= self%value(1)) then
      rank = 1
    else if (self%has_top .and. value >= self%value(2)) then
      rank = 2
    end if
    ! the lower of this point and the best one bounds the maximum on its side; initially the best point is an end, and remains one
    bound = sample_t(t, value, 0.0_dp)
    is_left = t < self%t(1)
    if (rank == 1) then
      bound = sample_t(self%t(1), self%value(1), 0.0_dp)
      is_left = .not. is_left
    end if
    if (self%has_top .or. rank > 1) then
      if (is_left) self%left = bound
      if (.not. is_left) self%right = bound
    end if
    if (self%has_top) then
      self%t(rank + 1:) = self%t(rank:2)
      self%value(rank + 1:) = self%value(rank:2)
    end if
    self%t(rank) = t
    self%value(rank) = value
    self%has_top = self%has_top .or. rank == 1
  end subroutine add_value

  !> Position between 0 and 1 of the maximum of the cubic through two samples, which rises at the left one and falls at the right
  !> one.
  pure real(dp) function cubic_peak(left, right) result(share)
    type(sample_t), intent(in) :: left, right
    real(dp), parameter :: margin = 1e-3_dp
    real(dp) :: width, rise, fall, slopes, middle
    width = right%t - left%t
    rise = left%slope*width
    fall = right%slope*width
    slopes = 3*(right%value - left%value)
    middle = slopes - rise - fall   ! the slope of the cubic is rise (1 - s)^2 + 2 middle s (1 - s) + fall s^2
    share = rise/(rise - middle + sqrt(max(middle**2 - rise*fall, 0.0_dp)))
    share = min(max(share, margin), 1 - margin)
  end function cubic_peak
end module peak_search
