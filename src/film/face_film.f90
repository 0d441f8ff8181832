!> Film between one face of a piston's skirt and its bore, with the contact of their asperities.
!>
!> A face spans |phi| <= w around its thrust axis, on the side +1 (towards +y) or -1, and the heights z_b <= z <= z_t from the
!> centre of mass along the piston. With the position y of the centre of mass, the tilt b, and the speed of the face along the bore
!> U = x' - side r b', r = R sin(w)/w,
!>
!>     h = c + relief(z) + ovality sin(phi)^2 - side (y + z b) cos(phi)
!>     div( H^3/(12 mu) grad p ) = H'(h) dh/dt - (U/2) dH/dz,   p = 0 at the edges
!>
!> H(h) is the mean gap of rough surfaces. Where the film ruptures p = 0: by Reynolds' condition (no suction; a ruptured node
!> into which oil flows is full again), or by cutting negative pressures off (Gumbel).
!>
!> Half of the face (it is symmetric) has cells in phi, and in z nodes that are closer at its ends. The balances of the nodes are
!> symmetric; forces are plain sums, and their power is exactly what shear and pressure flow dissipate on the grid.
module face_film
  use kinds, only: dp
  use constants, only: pi
  use asperities, only: asperities_t
  use bearing_size, only: bearing_t
  use monotone_cubic, only: monotone_cubic_t
  implicit none
  private
  public :: face_film_t, face_motion_t, face_loads_t, no_loads

  real(dp), parameter :: closer = 0.6_dp          !! how much closer the nodes at the ends are
  real(dp), parameter :: least_inflow = 1e-13_dp  !! over the largest source, with which a ruptured node fills again
  integer, parameter :: sweeps = 3                !! of Gauss and Seidel over the guess of that part
  integer, parameter :: most_rounds = 60          !! of the search for the part that is full

  !> Motion of the piston across its bore.
  type :: face_motion_t
    real(dp) :: offset = 0        !! y of the centre of mass [m]
    real(dp) :: tilt = 0          !! b, positive from x to y [rad]
    real(dp) :: offset_rate = 0   !! [m/s]
    real(dp) :: tilt_rate = 0     !! [rad/s]
    real(dp) :: velocity = 0      !! of the centre of mass along x [m/s]
  end type face_motion_t

  !> Loads on the piston, of one face or of both.
  type :: face_loads_t
    real(dp) :: force         !! along y [N]
    real(dp) :: moment        !! about the centre of mass, positive from x to y [N m]
    real(dp) :: friction      !! along x [N]
    real(dp) :: asperities    !! force of the asperities, positive where it presses [N]
    real(dp) :: least_gap     !! [m]
    real(dp) :: pressure      !! largest pressure of the film [Pa]
  end type face_loads_t

  type(face_loads_t), parameter :: no_loads = face_loads_t(0.0_dp, 0.0_dp, 0.0_dp, 0.0_dp, huge(1.0_dp), 0.0_dp)

  type :: face_film_t
    real(dp) :: radius = 0             !! R, of the piston [m]
    real(dp) :: half_angle = 0         !! w [rad]
    real(dp) :: height(2) = 0          !! z_t and z_b [m]
    real(dp) :: clearance = 0          !! c, radial [m]
    real(dp) :: barrel = 0             !! relief at half the length of the skirt from its widest place [m]
    real(dp) :: widest = 0             !! height of that place [m]
    type(monotone_cubic_t), allocatable :: profile   !! relief over the height [m], instead of the barrel
    real(dp) :: ovality = 0            !! relief at 90 degrees from the thrust axis [m]
    real(dp) :: viscosity = 0          !! [Pa s]
    type(asperities_t) :: asperities
    logical :: cuts_suction = .false.   !! Gumbel's condition instead of Reynolds'
    integer :: around = 6, along = 24  !! cells of half of the face, intervals along it
    real(dp), private :: step = 0      !! R Dphi [m]
    real(dp), private :: arm = 0       !! r [m]
    real(dp), allocatable, private :: cosine(:, :), oval(:, :)   !! (cell; 1: its middle, 2: its outer edge) of phi; ovality there
    real(dp), allocatable, private :: z(:), relief(:)            !! (0:along) nodes, and their relief
    real(dp), allocatable, private :: z_half(:), relief_half(:)  !! middles of the intervals
    real(dp), allocatable, private :: width(:)                   !! (0:along) height that belongs to a node [m]
  contains
    procedure :: prepare
    procedure :: find_loads
    procedure :: least_relief_gap
    procedure :: ends
    procedure, private :: pressures
  end type face_film_t

contains

  !> Make the grid, after everything else has been set.
  subroutine prepare(self)
    class(face_film_t), intent(inout) :: self
    real(dp) :: t, half
    integer :: i, j
    associate (n => self%around, m => self%along)
      self%step = self%radius*self%half_angle/n
      self%arm = self%radius*sin(self%half_angle)/self%half_angle
      allocate (self%cosine(n, 2), self%oval(n, 2), self%z(0:m), self%relief(0:m), self%z_half(m), self%relief_half(m), &
        self%width(0:m))
      do i = 1, n
        self%cosine(i, :) = cos(self%half_angle/n*[i - 0.5_dp, real(i, dp)])
      end do
      self%oval = self%ovality*(1 - self%cosine**2)
      half = 0.5_dp*(self%height(1) - self%height(2))
      do j = 0, m
        t = 2*real(j, dp)/m - 1
        self%z(j) = 0.5_dp*sum(self%height) + half*((1 - closer)*t + closer*sin(0.5_dp*pi*t))
      end do
      self%z_half = 0.5_dp*(self%z(:m - 1) + self%z(1:))
      if (allocated(self%profile)) then
        do j = 0, m
          self%relief(j) = self%profile%value(self%z(j))
          if (j > 0) self%relief_half(j) = self%profile%value(self%z_half(j))
        end do
      else
        self%relief = self%barrel*((self%z - self%widest)/half)**2
        self%relief_half = self%barrel*((self%z_half - self%widest)/half)**2
      end if
      self%width(1:m - 1) = 0.5_dp*(self%z(2:) - self%z(:m - 2))
      self%width(0) = 0.5_dp*(self%z(1) - self%z(0))
      self%width(m) = 0.5_dp*(self%z(m) - self%z(m - 1))
    end associate
    call self%asperities%prepare(bearing_t(radius=1.0_dp, length=1.0_dp))
  end subroutine prepare

  !> Smallest gap at the thrust axes of both faces [m].
  pure real(dp) function least_relief_gap(self, offset, tilt) result(gap)
    class(face_film_t), intent(in) :: self
    real(dp), intent(in) :: offset, tilt   !! [m], [rad]
    gap = self%clearance + minval(self%relief - abs(offset + self%z*tilt))
  end function least_relief_gap

  !> Negative gaps at the thrust axis of both faces, top and bottom, first those of the side +1 [m], and their rates [m/s].
  pure subroutine ends(self, motion, depth, depth_rate)
    class(face_film_t), intent(in) :: self
    type(face_motion_t), intent(in) :: motion
    real(dp), intent(out) :: depth(4), depth_rate(4)
    real(dp) :: z(2), relief(2)
    z = self%height
    relief = [self%relief(self%along), self%relief(0)]
    depth(:2) = motion%offset + z*motion%tilt
    depth_rate(:2) = motion%offset_rate + z*motion%tilt_rate
    depth(3:) = -depth(:2) - self%clearance - relief
    depth_rate(3:) = -depth_rate(:2)
    depth(:2) = depth(:2) - self%clearance - relief
  end subroutine ends

  !> Add the loads of the face on one side, +1 or -1.
  pure subroutine find_loads(self, side, motion, loads)
    class(face_film_t), intent(in) :: self
    integer, intent(in) :: side
    type(face_motion_t), intent(in) :: motion
    type(face_loads_t), intent(inout) :: loads
    real(dp), dimension(self%around, 0:self%along) :: gap, mean, slope
    real(dp) :: mean_half(self%around, 0:self%along + 1), p(0:self%around + 1, 0:self%along)   ! mean_half: 0 beyond the ends
    real(dp) :: speed, area, pressing, boundary, carried, friction, unused
    integer :: i, j
    speed = motion%velocity - side*self%arm*motion%tilt_rate
    do j = 0, self%along
      do i = 1, self%around
        gap(i, j) = self%clearance + self%relief(j) + self%oval(i, 1) - &
          side*(motion%offset + self%z(j)*motion%tilt)*self%cosine(i, 1)
        call self%asperities%film_gap(gap(i, j), mean(i, j), slope(i, j))
      end do
    end do
    mean_half = 0
    do j = 1, self%along
      do i = 1, self%around
        call self%asperities%film_gap(self%clearance + self%relief_half(j) + self%oval(i, 1) - &
          side*(motion%offset + self%z_half(j)*motion%tilt)*self%cosine(i, 1), mean_half(i, j), unused)
      end do
    end do
    call self%pressures(side, motion, speed, mean_half, slope, p)
    friction = 0
    carried = 0
    do j = 0, self%along
      area = 2*self%step*self%width(j)   ! with its mirror image
      do i = 1, self%around
        boundary = 0
        if (gap(i, j) < 8*self%asperities%roughness) boundary = self%asperities%pressure(-gap(i, j), 0.0_dp)
        pressing = (p(i, j) + boundary)*self%cosine(i, 1)*area
        loads%force = loads%force - side*pressing
        loads%moment = loads%moment - side*pressing*self%z(j)
        loads%asperities = loads%asperities + boundary*self%cosine(i, 1)*area
        friction = friction - self%viscosity*speed/mean(i, j)*area - p(i, j)*(mean_half(i, j + 1) - mean_half(i, j))*self%step
        carried = carried + boundary*area
      end do
    end do
    friction = friction + self%asperities%friction_force(speed, carried)
    loads%friction = loads%friction + friction
    loads%moment = loads%moment - side*self%arm*friction
    loads%least_gap = min(loads%least_gap, minval(gap))
    loads%pressure = max(loads%pressure, maxval(p))
  end subroutine find_loads

  !> Pressures of the nodes, 0 at the edges and in a frame around the face [Pa].
  pure subroutine pressures(self, side, motion, speed, mean_half, slope, p)
    class(face_film_t), intent(in) :: self
    integer, intent(in) :: side
    type(face_motion_t), intent(in) :: motion
    real(dp), intent(in) :: speed
    real(dp), intent(in) :: mean_half(self%around, 0:self%along + 1), slope(self%around, 0:self%along)
    real(dp), intent(out) :: p(0:self%around + 1, 0:self%along)
    real(dp) :: source(self%around, self%along - 1)
    real(dp) :: along(self%around, self%along), round(0:self%around, self%along - 1)   ! conductances
    real(dp) :: mean, conducts, squeeze, unused
    logical :: full(self%around, self%along - 1)
    integer :: i, j
    associate (n => self%around, m => self%along)
      do j = 1, m
        along(:, j) = self%step/(12*self%viscosity*(self%z(j) - self%z(j - 1)))*mean_half(:, j)**3
      end do
      round(0, :) = 0   ! the mirror
      do j = 1, m - 1
        conducts = self%width(j)/(12*self%viscosity*self%step)
        squeeze = side*(motion%offset_rate + self%z(j)*motion%tilt_rate)*self%step*self%width(j)
        do i = 1, n
          call self%asperities%film_gap(self%clearance + self%relief(j) + self%oval(i, 2) - &
            side*(motion%offset + self%z(j)*motion%tilt)*self%cosine(i, 2), mean, unused)
          round(i, j) = conducts*mean**3
          source(i, j) = squeeze*slope(i, j)*self%cosine(i, 1) + 0.5_dp*speed*(mean_half(i, j + 1) - mean_half(i, j))*self%step
        end do
        round(n, j) = 2*round(n, j)   ! p = 0 half a cell away
      end do
      full = .true.
      if (.not. self%cuts_suction) call guess_full(n, m, along, round, source, full)
      call balance(n, m, along, round, source, self%cuts_suction, full, p)
    end associate
  end subroutine pressures

  !> Nodes that are probably full: from the pressures of a grid of half as many cells and intervals, with the same flows, after some
  !> sweeps over the nodes. All of them if that grid cannot be made.
  pure subroutine guess_full(n, m, along, round, source, full)
    integer, intent(in) :: n, m
    real(dp), intent(in) :: along(n, m), round(0:n, m - 1), source(n, m - 1)
    logical, intent(inout) :: full(n, m - 1)
    real(dp) :: along_pair(n/2, m/2), round_pair(0:n/2, m/2 - 1), source_pair(n/2, m/2 - 1), p(0:n/2 + 1, 0:m/2)
    real(dp) :: guess(0:n + 1, 0:m)
    logical :: full_pair(n/2, m/2 - 1)
    integer :: i, j, pass
    if (mod(n, 2) + mod(m, 2) > 0) return
    do j = 1, m/2
      do i = 1, n/2   ! two flows side by side, each through two conductances one after the other
        along_pair(i, j) = sum(along(2*i - 1:2*i, 2*j - 1)*along(2*i - 1:2*i, 2*j)/ &
          (along(2*i - 1:2*i, 2*j - 1) + along(2*i - 1:2*i, 2*j)))
      end do
    end do
    do j = 1, m/2 - 1
      round_pair(:, j) = 0.5_dp*(round(::2, 2*j) + 0.5_dp*(round(::2, 2*j - 1) + round(::2, 2*j + 1)))
      do i = 1, n/2
        source_pair(i, j) = sum(source(2*i - 1:2*i, 2*j) + &
          0.5_dp*(source(2*i - 1:2*i, 2*j - 1) + source(2*i - 1:2*i, 2*j + 1)))
      end do
    end do
    full_pair = .true.
    call balance(n/2, m/2, along_pair, round_pair, source_pair, .false., full_pair, p)
    guess = 0
    do j = 1, m/2
      do i = 1, n/2
        guess(2*i - 1:2*i, 2*j - 1) = 0.5_dp*(p(i, j - 1) + p(i, j))
        guess(2*i - 1:2*i, 2*j) = p(i, j)
      end do
    end do
    do pass = 1, sweeps
      do j = 1, m - 1
        do i = 1, n
          guess(i, j) = max(0.0_dp, (source(i, j) + along(i, j)*guess(i, j - 1) + along(i, j + 1)*guess(i, j + 1) + &
            round(i - 1, j)*guess(i - 1, j) + round(i, j)*guess(i + 1, j))/ &
            (along(i, j) + along(i, j + 1) + round(i - 1, j) + round(i, j)))
        end do
      end do
    end do
    full = guess(1:n, 1:m - 1) > 0
  end subroutine guess_full

  !> Pressures of the nodes for which the flows balance, by one of both conditions; for Reynolds' from a guess of the nodes that are
  !> full. Where suction is cut off all must be full.
  pure subroutine balance(n, m, along, round, source, cuts_suction, full, p)
    integer, intent(in) :: n, m
    real(dp), intent(in) :: along(n, m), round(0:n, m - 1), source(n, m - 1)
    logical, intent(in) :: cuts_suction
    logical, intent(inout) :: full(n, m - 1)
    real(dp), intent(out) :: p(0:n + 1, 0:m)
    real(dp) :: a(0:n + 1, n*m + 2), x(n*m + 2)
    integer :: number(n, m)   ! of a full node among them
    real(dp) :: inflow, least
    logical :: changes, is_full
    integer :: i, j, k, pass
    least = least_inflow*maxval(abs(source))
    p = 0
    number = 0
    do pass = 1, most_rounds
      k = 0
      do j = 1, m - 1
        do i = 1, n
          if (.not. full(i, j)) cycle
          k = k + 1
          number(i, j) = k
        end do
      end do
      a(:, :k + n + 2) = 0
      a(0, k + 1:k + n + 2) = 1
      x(:k + n + 2) = 0
      do j = 1, m - 1
        do i = 1, n
          if (.not. full(i, j)) cycle
          associate (l => number(i, j))
            x(l) = source(i, j)
            a(0, l) = along(i, j) + along(i, j + 1) + round(i - 1, j) + round(i, j)
            if (i < n) then
              if (full(i + 1, j)) a(1, l) = -round(i, j)
            end if
            if (j == m - 1) cycle
            if (full(i, j + 1)) a(number(i, j + 1) - l, l) = -along(i, j + 1)
          end associate
        end do
      end do
      call solve_symmetric(k, n, a, x)
      do j = 1, m - 1
        do i = 1, n
          p(i, j) = 0
          if (full(i, j)) p(i, j) = x(number(i, j))
        end do
      end do
      if (cuts_suction) exit
      changes = .false.
      do j = 1, m - 1
        do i = 1, n
          if (full(i, j)) then
            is_full = .not. p(i, j) < 0
          else
            inflow = source(i, j) + along(i, j)*p(i, j - 1) + along(i, j + 1)*p(i, j + 1) + round(i - 1, j)*p(i - 1, j) + &
              round(i, j)*p(i + 1, j)
            is_full = inflow > least
          end if
          if (is_full .neqv. full(i, j)) changes = .true.
          full(i, j) = is_full
        end do
      end do
      if (.not. changes) exit
    end do
    p = max(p, 0.0_dp)
  end subroutine balance

  !> Solve a symmetric positive definite system of n equations, whose diagonals are 0 or more above the main one: a(i, k) is the
  !> element of row k + i and column k. Two columns are eliminated in each pass. Beyond the last equation a must be 0, but for
  !> ones on the main diagonal; beyond the last diagonal too.
  pure subroutine solve_symmetric(n, band, a, x)
    integer, intent(in) :: n, band
    real(dp), intent(inout) :: a(0:band + 1, n + band + 2), x(n + band + 2)
    real(dp) :: pivot(2), first, second
    integer :: i, k, l
    do k = 1, n, 2
      pivot(1) = 1/a(0, k)
      first = a(1, k)*pivot(1)
      a(0:band, k + 1) = a(0:band, k + 1) - first*a(1:band + 1, k)
      a(1, k) = first
      x(k + 1) = x(k + 1) - first*x(k)
      pivot(2) = 1/a(0, k + 1)
      do i = 2, band + 1
        first = a(i, k)*pivot(1)
        second = a(i - 1, k + 1)*pivot(2)
        if (.not. (abs(first) > 0 .or. abs(second) > 0)) cycle
        do l = i, band + 1
          a(l - i, k + i) = a(l - i, k + i) - first*a(l, k) - second*a(l - 1, k + 1)
        end do
        x(k + i) = x(k + i) - first*x(k) - second*x(k + 1)
        a(i, k) = first
        a(i - 1, k + 1) = second
      end do
      x(k:k + 1) = x(k:k + 1)*pivot
    end do
    do k = n, 1, -1
      do i = 1, band
        x(k) = x(k) - a(i, k)*x(k + i)
      end do
    end do
  end subroutine solve_symmetric
end module face_film
