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
  use banded_lu, only: decompose_band, solve_band
  implicit none
  private
  public :: face_film_t, face_motion_t, face_loads_t, no_loads

  real(dp), parameter :: closer = 0.6_dp          !! how much closer the nodes at the ends are
  real(dp), parameter :: far_apart = 7            !! gap over roughness above which surfaces count as smooth
  real(dp), parameter :: least_inflow = 1e-13_dp  !! over the largest source, with which a ruptured node fills again
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
      self%relief = self%barrel*((self%z - self%widest)/half)**2
      self%relief_half = self%barrel*((self%z_half - self%widest)/half)**2
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
    real(dp) :: speed, area, pressing, boundary, friction, unused
    integer :: i, j
    speed = motion%velocity - side*self%arm*motion%tilt_rate
    do j = 0, self%along
      do i = 1, self%around
        gap(i, j) = self%clearance + self%relief(j) + self%oval(i, 1) - &
          side*(motion%offset + self%z(j)*motion%tilt)*self%cosine(i, 1)
        call see(self, gap(i, j), mean(i, j), slope(i, j))
      end do
    end do
    mean_half = 0
    do j = 1, self%along
      do i = 1, self%around
        call see(self, self%clearance + self%relief_half(j) + self%oval(i, 1) - &
          side*(motion%offset + self%z_half(j)*motion%tilt)*self%cosine(i, 1), mean_half(i, j), unused)
      end do
    end do
    call self%pressures(side, motion, speed, mean_half, slope, p)
    do j = 0, self%along
      do i = 1, self%around
        area = 2*self%step*self%width(j)   ! with its mirror image
        boundary = 0
        if (gap(i, j) < 8*self%asperities%roughness) boundary = self%asperities%pressure(-gap(i, j), 0.0_dp)
        pressing = (p(i, j) + boundary)*self%cosine(i, 1)*area
        loads%force = loads%force - side*pressing
        loads%moment = loads%moment - side*pressing*self%z(j)
        loads%asperities = loads%asperities + boundary*self%cosine(i, 1)*area
        friction = -self%viscosity*speed/mean(i, j)*area - p(i, j)*(mean_half(i, j + 1) - mean_half(i, j))*self%step + &
          self%asperities%friction_force(speed, boundary*area)
        loads%friction = loads%friction + friction
        loads%moment = loads%moment - side*self%arm*friction
      end do
    end do
    loads%least_gap = min(loads%least_gap, minval(gap))
    loads%pressure = max(loads%pressure, maxval(p))
  end subroutine find_loads

  !> Mean gap H and its derivative by the gap h [m].
  pure subroutine see(self, gap, mean, slope)
    type(face_film_t), intent(in) :: self
    real(dp), intent(in) :: gap
    real(dp), intent(out) :: mean, slope
    if (gap > far_apart*self%asperities%roughness) then
      mean = gap
      slope = 1
    else
      call self%asperities%mean_gap(gap, mean, slope)
    end if
  end subroutine see

  !> Pressures of the nodes, 0 at the edges and in a frame around the face [Pa].
  pure subroutine pressures(self, side, motion, speed, mean_half, slope, p)
    class(face_film_t), intent(in) :: self
    integer, intent(in) :: side
    type(face_motion_t), intent(in) :: motion
    real(dp), intent(in) :: speed
    real(dp), intent(in) :: mean_half(self%around, 0:self%along + 1), slope(self%around, 0:self%along)
    real(dp), intent(out) :: p(0:self%around + 1, 0:self%along)
    real(dp), dimension(self%around, self%along - 1) :: source, x, inflow
    real(dp) :: along(self%around, self%along), round(0:self%around, self%along - 1)   ! conductances
    real(dp) :: a(-self%around:self%around, self%around*(self%along - 1)), mean, unused
    logical, dimension(self%around, self%along - 1) :: full, before
    logical :: singular
    integer :: i, j, k, pass
    associate (n => self%around, m => self%along)
      do j = 1, m
        along(:, j) = mean_half(:, j)**3/(12*self%viscosity)*self%step/(self%z(j) - self%z(j - 1))
      end do
      round(0, :) = 0   ! the mirror
      do j = 1, m - 1
        do i = 1, n
          call see(self, self%clearance + self%relief(j) + self%oval(i, 2) - &
            side*(motion%offset + self%z(j)*motion%tilt)*self%cosine(i, 2), mean, unused)
          round(i, j) = mean**3/(12*self%viscosity)*self%width(j)/self%step
          source(i, j) = slope(i, j)*side*(motion%offset_rate + self%z(j)*motion%tilt_rate)*self%cosine(i, 1)*self%step* &
            self%width(j) + 0.5_dp*speed*(mean_half(i, j + 1) - mean_half(i, j))*self%step
        end do
        round(n, j) = 2*round(n, j)   ! p = 0 half a cell away
      end do
      full = .true.
      p = 0
      do pass = 1, most_rounds
        a = 0
        x = 0
        do j = 1, m - 1
          do i = 1, n
            k = i + (j - 1)*n
            a(0, k) = 1
            if (.not. full(i, j)) cycle
            a(0, k) = along(i, j) + along(i, j + 1) + round(i - 1, j) + round(i, j)
            x(i, j) = source(i, j)
            if (i < n) then
              if (full(i + 1, j)) a(1, k) = -round(i, j)
              if (full(i + 1, j)) a(-1, k + 1) = -round(i, j)
            end if
            if (j == m - 1) cycle
            if (full(i, j + 1)) a(n, k) = -along(i, j + 1)
            if (full(i, j + 1)) a(-n, k + n) = -along(i, j + 1)
          end do
        end do
        call decompose_band(n*(m - 1), n, a, singular)
        call solve_band(n*(m - 1), n, a, 1, x)
        p(1:n, 1:m - 1) = x
        if (self%cuts_suction) exit
        inflow = source + along(:, :m - 1)*p(1:n, :m - 2) + along(:, 2:)*p(1:n, 2:) + round(:n - 1, :)*p(:n - 1, 1:m - 1) + &
          round(1:, :)*p(2:, 1:m - 1)
        before = full
        where (full)
          full = .not. x < 0
        elsewhere
          full = inflow > least_inflow*maxval(abs(source))
        end where
        if (all(full .eqv. before)) exit
      end do
      p = max(p, 0.0_dp)
    end associate
  end subroutine pressures
end module face_film
