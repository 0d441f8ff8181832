!> A worn bore on a foundation of independent springs: the elastic force on a round pin in a bore of any worn shape.
!>
!> At the angle theta the pin compresses the foundation by the gap e . u(theta) - c - w(theta), where it is positive: u is the unit
!> vector, w the depth of wear. The pressure is k times that, and the force k Rb L Int gap u dtheta. The pin may touch the bore on
!> several arcs. For a frozen shape the force is minus the gradient of the energy k Rb L Int gap^2/2 dtheta.
!>
!> The depth is given in the middles of equal bins and is linear between them. There the gap is a quadratic with the exact values at
!> both ends and the curvature of e . u; its error is that of the third derivative, (dtheta)^3 |e|/15 at most, and changes its sign
!> in the middle.
module worn_bore
  use kinds, only: dp
  use constants, only: two_pi, gauss_points, gauss_weights
  implicit none
  private
  public :: worn_bore_t, touching_cells_t

  type :: worn_bore_t
    real(dp) :: clearance = 1                 !! c, of the bore without wear [m]
    real(dp) :: bedding = 0                   !! k Rb L [N/m^2]
    real(dp), allocatable :: depth(:)         !! w in the middle of each bin, > 0 outwards [m]
    real(dp), allocatable :: middle(:, :)     !! u in the middle of each bin
    real(dp), allocatable :: edge(:, :)       !! u between each bin and the next
  contains
    procedure :: prepare
    procedure :: press
    procedure :: find_gap
    procedure :: energy
    procedure :: cells
  end type worn_bore_t

  !> The part of the foundation that a pin compresses, in pieces that are not longer than half a bin.
  type :: touching_cells_t
    integer :: n = 0
    real(dp), allocatable :: ends(:, :)       !! angles from x towards y at which each piece begins and ends (2, n) [rad]
    real(dp), allocatable :: loads(:)         !! Int p Rb L dtheta over each piece [N]
  end type touching_cells_t

  !> The gap between the middles of two bins as a function of s from 0 to 1: start + s rise + s (1 - s) bend.
  type :: piece_t
    real(dp) :: start = 0, rise = 0, bend = 0   !! [m]
    real(dp) :: ends(2) = 0                     !! values of s between which it is positive; equal if it is not
  end type piece_t

contains

  !> Begin with a round bore of `bins` bins.
  pure subroutine prepare(self, bins, clearance, bedding)
    class(worn_bore_t), intent(inout) :: self
    integer, intent(in) :: bins
    real(dp), intent(in) :: clearance   !! [m]
    real(dp), intent(in) :: bedding     !! k Rb L [N/m^2]
    integer :: i
    self%clearance = clearance
    self%bedding = bedding
    if (allocated(self%depth)) deallocate (self%depth, self%middle, self%edge)
    allocate (self%depth(bins), source=0.0_dp)
    allocate (self%middle(2, bins), self%edge(2, bins))
    do i = 1, bins
      self%middle(:, i) = [cos(two_pi*(i - 0.5_dp)/bins), sin(two_pi*(i - 0.5_dp)/bins)]
      self%edge(:, i) = [cos(two_pi*i/bins), sin(two_pi*i/bins)]
    end do
  end subroutine prepare

  !> Elastic force with which the pin presses on the bore, and the same summed without regard to its direction [N]; 0 if they do not
  !> touch.
  pure subroutine press(self, eccentricity, force, total)
    class(worn_bore_t), intent(in) :: self
    real(dp), intent(in) :: eccentricity(2)   !! of the pin in the bore [m]
    real(dp), intent(out) :: force(2), total
    type(piece_t) :: piece
    real(dp) :: s, gap, width, moments(3)
    integer :: i, j, k, m, first, last
    force = 0
    total = 0
    width = two_pi/size(self%depth)
    call find_range(self, eccentricity, first, last)
    do k = first, last
      i = bin_of(self, k)
      piece = piece_of(self, i, eccentricity)
      associate (length => piece%ends(2) - piece%ends(1))
        if (.not. length > 0) cycle
        if (length < 1) then
          moments = 0   ! Int gap, Int gap s, Int gap s (1 - s) over the part that is compressed
          do m = 1, 3
            s = piece%ends(1) + gauss_points(m)*length
            gap = gauss_weights(m)*length*gap_at(piece, s)
            moments = moments + gap*[1.0_dp, s, s*(1 - s)]
          end do
        else
          associate (start => piece%start, rise => piece%rise, bend => piece%bend)
            moments = [start + rise/2 + bend/6, start/2 + rise/3 + bend/12, start/6 + rise/12 + bend/30]
          end associate
        end if
      end associate
      j = bin_of(self, k + 1)
      total = total + moments(1)
      force = force + (moments(1) - moments(2))*self%middle(:, i) + moments(2)*self%middle(:, j) &
        + 0.5_dp*width**2*moments(3)*self%edge(:, i)
    end do
    force = self%bedding*width*force
    total = self%bedding*width*total
  end subroutine press

  !> Largest gap e . u - c - w [m], negative where the pin does not touch the bore, and its gradient.
  pure subroutine find_gap(self, eccentricity, gap, gradient)
    class(worn_bore_t), intent(in) :: self
    real(dp), intent(in) :: eccentricity(2)
    real(dp), intent(out) :: gap, gradient(2)
    type(piece_t) :: piece
    real(dp) :: s
    integer :: i, k, first, last, n
    n = size(self%depth)
    gap = -huge(gap)
    gradient = 0
    call find_range(self, eccentricity, first, last)
    if (last < first) last = first + n - 1
    do k = first, last
      i = bin_of(self, k)
      piece = piece_of(self, i, eccentricity)
      s = 0
      if (abs(piece%rise) < piece%bend) s = 0.5_dp + 0.5_dp*piece%rise/piece%bend
      if (.not. gap_at(piece, s) > gap) cycle
      gap = gap_at(piece, s)
      gradient = (1 - s)*self%middle(:, i) + s*self%middle(:, bin_of(self, k + 1)) &
        + 0.5_dp*s*(1 - s)*(two_pi/n)**2*self%edge(:, i)
    end do
  end subroutine find_gap

  !> Elastic energy [J].
  pure real(dp) function energy(self, eccentricity)
    class(worn_bore_t), intent(in) :: self
    real(dp), intent(in) :: eccentricity(2)
    type(piece_t) :: piece
    integer :: k, m, first, last
    energy = 0
    call find_range(self, eccentricity, first, last)
    do k = first, last
      piece = piece_of(self, bin_of(self, k), eccentricity)
      associate (length => piece%ends(2) - piece%ends(1))
        do m = 1, 3
          energy = energy + 0.5_dp*gauss_weights(m)*length*gap_at(piece, piece%ends(1) + gauss_points(m)*length)**2
        end do
      end associate
    end do
    energy = self%bedding*two_pi/size(self%depth)*energy
  end function energy

  !> The pieces of the foundation that the pin compresses, and their loads.
  pure subroutine cells(self, eccentricity, touching)
    class(worn_bore_t), intent(in) :: self
    real(dp), intent(in) :: eccentricity(2)
    type(touching_cells_t), intent(inout) :: touching
    type(piece_t) :: piece
    real(dp) :: width, ends(2)
    integer :: half, k, m, first, last
    width = two_pi/size(self%depth)
    touching%n = 0
    call find_range(self, eccentricity, first, last)
    if (allocated(touching%loads)) then
      if (size(touching%loads) < 2*(last - first + 1)) deallocate (touching%loads, touching%ends)
    end if
    if (.not. allocated(touching%loads)) allocate (touching%loads(2*(last - first + 1)), touching%ends(2, 2*(last - first + 1)))
    do k = first, last
      piece = piece_of(self, bin_of(self, k), eccentricity)
      do half = 1, 2
        ends = [max(piece%ends(1), 0.5_dp*(half - 1)), min(piece%ends(2), 0.5_dp*half)]
        if (.not. ends(2) > ends(1)) cycle
        touching%n = touching%n + 1
        touching%ends(:, touching%n) = (k - 0.5_dp + ends)*width
        touching%loads(touching%n) = 0
        do m = 1, 3
          touching%loads(touching%n) = touching%loads(touching%n) + self%bedding*width*(ends(2) - ends(1))*gauss_weights(m) &
            *gap_at(piece, ends(1) + gauss_points(m)*(ends(2) - ends(1)))
        end do
      end do
    end do
  end subroutine cells

  !> The pieces that may touch: piece k lies between the middles of the bins k and k + 1, counted around the bore. None (last <
  !> first) if the eccentricity is smaller than the clearance.
  pure subroutine find_range(bore, eccentricity, first, last)
    type(worn_bore_t), intent(in) :: bore
    real(dp), intent(in) :: eccentricity(2)
    integer, intent(out) :: first, last
    real(dp) :: distance, width, direction, reach
    first = 1
    last = 0
    distance = norm2(eccentricity)
    if (.not. distance > bore%clearance) return
    width = two_pi/size(bore%depth)
    direction = atan2(eccentricity(2), eccentricity(1))
    reach = acos(bore%clearance/distance) + width
    first = floor((direction - reach)/width + 0.5_dp)
    last = min(floor((direction + reach)/width + 0.5_dp), first + size(bore%depth) - 1)
  end subroutine find_range

  !> Index of a bin counted around the bore.
  pure integer function bin_of(bore, k)
    type(worn_bore_t), intent(in) :: bore
    integer, intent(in) :: k
    bin_of = modulo(k - 1, size(bore%depth)) + 1
  end function bin_of

  !> The gap between the middle of bin i and that of the next one. Its zeros are computed without cancellation.
  pure type(piece_t) function piece_of(bore, i, e) result(piece)
    type(worn_bore_t), intent(in) :: bore
    integer, intent(in) :: i
    real(dp), intent(in) :: e(2)
    real(dp) :: at_end, slope, root, q
    integer :: j
    j = bin_of(bore, i + 1)
    piece%start = e(1)*bore%middle(1, i) + e(2)*bore%middle(2, i) - bore%clearance - bore%depth(i)
    at_end = e(1)*bore%middle(1, j) + e(2)*bore%middle(2, j) - bore%clearance - bore%depth(j)
    piece%rise = at_end - piece%start
    piece%bend = 0.5_dp*(two_pi/size(bore%depth))**2*(e(1)*bore%edge(1, i) + e(2)*bore%edge(2, i))
    piece%ends = 0
    if (piece%start >= 0 .and. at_end >= 0) then
      piece%ends(2) = 1
      return
    end if
    slope = piece%rise + piece%bend   ! of -bend s^2 + slope s + start
    root = slope**2 + 4*piece%bend*piece%start
    if (piece%start < 0 .and. at_end < 0 .and. .not. (abs(piece%rise) < piece%bend .and. root > 0)) return
    q = 0.5_dp*(slope + sign(sqrt(max(root, 0.0_dp)), slope))
    piece%ends = [-piece%start/q, q/piece%bend]   ! for a positive bend and slope the first zero is the smaller one
    if (q < 0) piece%ends = [q/piece%bend, -piece%start/q]
    if (piece%start >= 0) piece%ends(1) = 0
    if (at_end >= 0) piece%ends(2) = 1
    piece%ends = min(1.0_dp, max(0.0_dp, piece%ends))
  end function piece_of

  pure real(dp) function gap_at(piece, s)
    type(piece_t), intent(in) :: piece
    real(dp), intent(in) :: s
    gap_at = piece%start + s*(piece%rise + (1 - s)*piece%bend)
  end function gap_at
end module worn_bore
