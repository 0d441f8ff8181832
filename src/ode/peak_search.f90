!> The largest value of a smooth quantity between two instants, by as few values as it takes.
module peak_search
  use gudgeon_kinds, only: dp
  use gudgeon_archive, only: archive_t
  implicit none
  private
  public :: sample_t, peak_search_t, most_between

  integer, parameter :: most_values = 40
  real(dp), parameter :: resolution = 1e-8_dp   !! of the time, part of the piece searched
  real(dp), parameter :: worthwhile = 1e-12_dp  !! a gain of less than this part of the value ends a search

  !> A quantity at one instant.
  type :: sample_t
    real(dp) :: t = 0, value = 0, slope = 0   !! slope: by the time
  contains
    procedure :: exchange
  end type sample_t

  !> A search for a peak. The caller evaluates the quantity where `next_time` says and hands the value to `take`, until the search
  !> is done. The first instant is the peak of the cubic through values and slopes at both ends; then come peaks of parabolas
  !> through the three best points, with the golden section where they fail (Brent 1973, ch. 5).
  type :: peak_search_t
    type(sample_t) :: best                !! the largest value so far, without its slope
    type(sample_t), private :: left, right
    real(dp), private :: second_t = 0, second = 0, third_t = 0, third = 0   !! the next best points
    real(dp), private :: width = 0        !! of the piece at the beginning
    real(dp), private :: last = 0, last_but_one = 0   !! ways from one instant to the next
    integer, private :: values = 0
    logical, private :: has_top = .false. !! `best` is inside, and no end is above it
  contains
    procedure :: begin
    procedure :: next_time
    procedure :: take
  end type peak_search_t

contains

  !> To or from an archive.
  subroutine exchange(self, archive)
    class(sample_t), intent(inout) :: self
    type(archive_t), intent(inout) :: archive
    call archive%exchange(self%t)
    call archive%exchange(self%value)
    call archive%exchange(self%slope)
  end subroutine exchange

  !> No less than what the quantity reaches between two samples: of the cubic through them in Bernstein form, with its deviation
  !> from the straight line counted twice.
  pure real(dp) function most_between(left, right) result(most)
    type(sample_t), intent(in) :: left, right
    real(dp) :: third, inner_left, inner_right, bend
    third = (right%t - left%t)/3
    inner_left = left%value + third*left%slope
    inner_right = right%value - third*right%slope
    bend = max(abs(inner_left - (2*left%value + right%value)/3), abs(inner_right - (left%value + 2*right%value)/3))
    most = max(left%value, right%value, max(inner_left, inner_right) + bend)
  end function most_between

  !> Search between two samples with slopes.
  subroutine begin(self, left, right)
    class(peak_search_t), intent(out) :: self
    type(sample_t), intent(in) :: left, right
    self%left = left
    self%right = right
    self%width = right%t - left%t
    self%best = left
    if (right%value > left%value) self%best = right
    self%second_t = left%t
    self%second = left%value
    self%third_t = right%t
    self%third = right%value
    if (right%value > left%value) then
      self%second_t = right%t
      self%second = right%value
      self%third_t = left%t
      self%third = left%value
    end if
    self%last = self%width
    self%last_but_one = self%width
  end subroutine begin

  !> When to evaluate the quantity next.
  pure subroutine next_time(self, t, is_done)
    class(peak_search_t), intent(inout) :: self
    real(dp), intent(out) :: t
    logical, intent(out) :: is_done
    real(dp), parameter :: golden = 0.381966_dp
    real(dp) :: way, gain
    logical :: has_parabola

    associate (a => self%left, b => self%right, x => self%best)
      is_done = self%values >= most_values
      t = a%t + 0.5_dp*(b%t - a%t)
      if (self%values == 0) then
        if (a%slope > 0 .and. b%slope < 0) t = a%t + cubic_peak(a, b)*(b%t - a%t)
      else if (.not. self%has_top) then
        call step_from_end(self, t, is_done)
      else
        call find_parabola(self, has_parabola, way, gain)
        if (has_parabola .and. self%values > 1 .and. gain <= worthwhile*abs(x%value)) is_done = .true.
        if (max(x%t - a%t, b%t - x%t) <= 2*resolution*self%width) is_done = .true.
        if (.not. has_parabola .or. abs(way) >= 0.5_dp*abs(self%last_but_one) .or. &
            x%t + way <= a%t .or. x%t + way >= b%t) then
          self%last = merge(a%t - x%t, b%t - x%t, x%t - a%t > b%t - x%t)
          way = golden*self%last
        end if
        self%last_but_one = self%last
        self%last = way
        t = x%t + sign(max(abs(way), resolution*self%width), way)
      end if
      is_done = is_done .or. .not. (t > a%t .and. t < b%t)
    end associate
  end subroutine next_time

  !> No value inside has been above both ends: towards the higher one, if the quantity rises from there.
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

  !> The parabola through the three best points, if it has a peak: how far that is from the best one, and how much higher.
  pure subroutine find_parabola(self, has_peak, way, gain)
    class(peak_search_t), intent(in) :: self
    logical, intent(out) :: has_peak
    real(dp), intent(out) :: way, gain
    real(dp) :: to_second, to_third, chord, curvature, slope
    has_peak = .false.
    way = 0
    gain = 0
    to_second = self%second_t - self%best%t
    to_third = self%third_t - self%best%t
    if (.not. (abs(to_second) > 0 .and. abs(to_third) > 0 .and. abs(to_third - to_second) > 0)) return
    chord = (self%second - self%best%value)/to_second
    curvature = ((self%third - self%best%value)/to_third - chord)/(to_third - to_second)
    if (.not. curvature < 0) return
    has_peak = .true.
    slope = chord - curvature*to_second
    way = -slope/(2*curvature)
    gain = 0.5_dp*slope*way
  end subroutine find_parabola

  !> The value of the quantity at t, between the ends.
  pure subroutine take(self, t, value)
    class(peak_search_t), intent(inout) :: self
    real(dp), intent(in) :: t, value
    type(sample_t) :: here
    here = sample_t(t, value, 0.0_dp)
    self%values = self%values + 1
    if (.not. self%has_top) then
      self%has_top = value >= max(self%left%value, self%right%value)
      if (self%has_top) then
        self%best = here
      else if (self%left%value >= self%right%value) then
        self%right = here
        self%third_t = t
        self%third = value
      else
        self%left = here
        self%third_t = t
        self%third = value
      end if
      return
    end if
    if (value >= self%best%value) then
      if (t >= self%best%t) self%left = self%best
      if (t < self%best%t) self%right = self%best
      self%third_t = self%second_t
      self%third = self%second
      self%second_t = self%best%t
      self%second = self%best%value
      self%best = here
    else
      if (t < self%best%t) self%left = here
      if (t >= self%best%t) self%right = here
      if (value >= self%second) then
        self%third_t = self%second_t
        self%third = self%second
        self%second_t = t
        self%second = value
      else
        self%third_t = t
        self%third = value
      end if
    end if
  end subroutine take

  !> Where between 0 and 1 the cubic through two samples has its peak, which rises at the left one and falls at the right one.
  pure real(dp) function cubic_peak(left, right) result(share)
    type(sample_t), intent(in) :: left, right
    real(dp), parameter :: margin = 1e-3_dp
    real(dp) :: width, rise, fall, slopes, middle
    width = right%t - left%t
    rise = left%slope*width
    fall = right%slope*width
    slopes = 3*(right%value - left%value)
    middle = slopes - rise - fall   ! the rate along the cubic is rise (1 - s)^2 + 2 middle s (1 - s) + fall s^2
    share = rise/(rise - middle + sqrt(max(middle**2 - rise*fall, 0.0_dp)))
    share = min(max(share, margin), 1 - margin)
  end function cubic_peak
end module peak_search
