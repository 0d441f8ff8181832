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
!> An elastic face is a rigid panel on two springs at its ends, whose deflections w_t, w_b >= 0 take it away from the wall, linear
!> in between: a panel has a motion like that of the piston, but for U. Springs and film have no mass,
!>
!>     Int (p + p_a) cos(phi) N_k dA = K w_k + K tau w_k',   N_t = (z - z_b)/l, N_b = 1 - N_t
!>
!> where the drag K tau keeps the rates defined without a film, and p is linear in them.
!>
!> Half of the face (it is symmetric) has cells in phi, and in z nodes that are closer at its ends. The balances of the nodes are
!> symmetric; forces are plain sums, and their power is exactly what shear and pressure flow dissipate on the grid.
module face_film
  use kinds, only: dp
  use constants, only: pi
  use asperities, only: asperities_t
  use bearing_size, only: bearing_t
  use monotone_cubic, only: monotone_cubic_t
  use face_balance, only: guess_full, balance
  implicit none
  private
  public :: face_film_t, face_motion_t, face_loads_t, face_springs_t, face_tangent_t, faces_t, no_loads, &
    no_tangent, tangent_found, tangent_acts

  real(dp), parameter :: closer = 0.6_dp          !! how much closer the nodes at the ends are
  !> What is seen at the nodes (cell, node, this): gap h; H and H' there, in the middle of the interval below, at the outer edge.
  integer, parameter :: gap = 1, mean = 2, slope = 3, mean_half = 4, slope_half = 5, mean_edge = 6, slope_edge = 7, n_seen = 7

  !> Motion of the piston across its bore.
  type :: face_motion_t
    real(dp) :: offset            !! y of the centre of mass [m]
    real(dp) :: tilt              !! b, positive from x to y [rad]
    real(dp) :: offset_rate       !! [m/s]
    real(dp) :: tilt_rate         !! [rad/s]
    real(dp) :: velocity          !! of the centre of mass along x [m/s]
  end type face_motion_t

  integer, parameter :: n_motion = 5   !! number of these components, by which slopes are counted

  real(dp), parameter :: relaxation = 1e-5_dp   !! tau, in which a face without a film springs back [s]

  !> The springs at the ends of a face, top and bottom.
  type :: face_springs_t
    real(dp) :: stiffness          !! K, of each [N/m]
    real(dp) :: deflection(2)      !! w [m]
    real(dp) :: rate(2)            !! w' [m/s]
    logical :: balance = .true.    !! they do at these rates
  end type face_springs_t

  !> Loads on the piston, of one face or of both.
  type :: face_loads_t
    real(dp) :: force         !! along y [N]
    real(dp) :: moment        !! about the centre of mass, positive from x to y [N m]
    real(dp) :: friction      !! along x [N]
    real(dp) :: asperities    !! force of the asperities, positive where it presses [N]
    real(dp) :: least_gap     !! [m]
    real(dp) :: pressure      !! largest pressure of the film [Pa]
  end type face_loads_t

  integer, parameter :: no_tangent = 0, tangent_found = 1, tangent_acts = 2

  !> Loads of both faces that are linear in the motion, near that at which they were found.
  type :: face_tangent_t
    integer :: role                  !! tangent_found: it is found beside the loads; tangent_acts: instead of the films; else none
    type(face_motion_t) :: motion
    type(face_loads_t) :: loads
    real(dp) :: slopes(3, n_motion)  !! of force, moment and friction
    ! of elastic faces, side +1 and then -1, top and bottom of each
    real(dp) :: deflection(4), rate(4)
    real(dp) :: by_deflection(3, 4)          !! slopes of the loads
    real(dp) :: rate_slopes(4, n_motion + 4) !! slopes of the rates, by motion and deflections
  contains
    procedure :: loads_at
    procedure :: yield
  end type face_tangent_t

  !> The films of both halves of a skirt, side +1 and then -1. Each face is symmetric to its thrust axis: half of it is given.
  type :: faces_t
    real(dp), allocatable :: angle(:)             !! of the cells from the thrust axis [rad]
    real(dp), allocatable :: height(:)            !! of the nodes above the centre of mass, along the piston [m]
    real(dp), allocatable :: gap(:, :, :)         !! (cell, node, side) [m]
    real(dp), allocatable :: pressure(:, :, :)    !! (cell, node, side) [Pa]
  end type faces_t

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
    procedure :: least_elastic_gap
    procedure :: ends
    procedure :: field
    procedure :: panel_motion
    procedure :: panel_slopes
    procedure, private, non_overridable :: find_flows, contact_pressure
  end type face_film_t

  interface
    !> Add the slopes of the loads of a face, from pressures that are not cut off at 0, while the part that is full stays.
    pure module subroutine add_slopes(self, side, motion, at, full, p, slopes)
      type(face_film_t), intent(in) :: self
      integer, intent(in) :: side
      type(face_motion_t), intent(in) :: motion
      real(dp), intent(in) :: at(self%around, 0:self%along + 1, n_seen)
      logical, intent(in) :: full(self%around, self%along - 1)
      real(dp), intent(in) :: p(0:self%around + 1, 0:self%along)
      real(dp), intent(inout) :: slopes(3, n_motion)
    end subroutine add_slopes

    !> Motion of the panel of an elastic face. The speed of its surface along the bore remains that of the piston's.
    pure type(face_motion_t) module function panel_motion(self, side, motion, springs) result(panel)
      class(face_film_t), intent(in) :: self
      integer, intent(in) :: side
      type(face_motion_t), intent(in) :: motion      !! of the piston
      type(face_springs_t), intent(in) :: springs
    end function panel_motion

    !> `find_pressures` of an elastic face, with the rates of its springs; on entry `motion` is that of a panel whose springs are at
    !> rest.
    pure module subroutine find_yielding(self, side, motion, at, springs, full, p)
      type(face_film_t), intent(in) :: self
      integer, intent(in) :: side
      type(face_motion_t), intent(in) :: motion
      real(dp), intent(in) :: at(self%around, 0:self%along + 1, n_seen)
      type(face_springs_t), intent(inout) :: springs
      logical, intent(out) :: full(self%around, self%along - 1)
      real(dp), intent(out) :: p(0:self%around + 1, 0:self%along)
    end subroutine find_yielding

    !> Slopes of the loads of an elastic face and of the rates of its springs, by the motion of the piston and both deflections,
    !> from those of the loads by the motion of its panel.
    pure module subroutine panel_slopes(self, side, stiffness, own, of_loads, of_rates)
      class(face_film_t), intent(in) :: self
      integer, intent(in) :: side
      real(dp), intent(in) :: stiffness   !! [N/m]
      real(dp), intent(in) :: own(3, n_motion)
      real(dp), intent(out) :: of_loads(3, n_motion + 2), of_rates(2, n_motion + 2)
    end subroutine panel_slopes
  end interface

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

  !> The same of elastic faces.
  pure real(dp) function least_elastic_gap(self, offset, tilt, springs) result(gap)
    class(face_film_t), intent(in) :: self
    real(dp), intent(in) :: offset, tilt            !! [m], [rad]
    type(face_springs_t), intent(in) :: springs(2)  !! of the sides +1 and -1
    type(face_motion_t) :: panel
    integer :: k
    gap = huge(gap)
    do k = 1, 2
      panel = self%panel_motion(3 - 2*k, face_motion_t(offset, tilt, 0.0_dp, 0.0_dp, 0.0_dp), springs(k))
      gap = min(gap, self%clearance + minval(self%relief - (3 - 2*k)*(panel%offset + self%z*panel%tilt)))
    end do
  end function least_elastic_gap

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

  !> Add the loads of the face on one side, +1 or -1, and their slopes. With springs it is elastic: their rates are found, and the
  !> slopes are those by the motion of its panel.
  pure subroutine find_loads(self, side, motion, loads, slopes, springs)
    class(face_film_t), intent(in) :: self
    integer, intent(in) :: side
    type(face_motion_t), intent(in) :: motion
    type(face_loads_t), intent(inout) :: loads
    real(dp), intent(inout), optional :: slopes(3, n_motion)   !! of force, moment and friction, by the components of the motion
    type(face_springs_t), intent(inout), optional :: springs   !! with their deflections
    real(dp) :: at(self%around, 0:self%along + 1, n_seen), p(0:self%around + 1, 0:self%along)
    real(dp) :: speed, area, pressing, contact, carried, friction
    logical :: full(self%around, self%along - 1)
    type(face_motion_t) :: panel
    integer :: i, j
    speed = motion%velocity - side*self%arm*motion%tilt_rate
    panel = motion
    call find_face(self, side, panel, at, full, p, springs)
    if (present(slopes)) call add_slopes(self, side, panel, at, full, p, slopes)
    p = max(p, 0.0_dp)
    friction = 0
    carried = 0
    do j = 0, self%along
      area = 2*self%step*self%width(j)   ! with its mirror image
      do i = 1, self%around
        contact = self%contact_pressure(at(i, j, gap))
        pressing = (p(i, j) + contact)*self%cosine(i, 1)*area
        loads%force = loads%force - side*pressing
        loads%moment = loads%moment - side*pressing*self%z(j)
        loads%asperities = loads%asperities + contact*self%cosine(i, 1)*area
        friction = friction - self%viscosity*speed/at(i, j, mean)*area - &
          p(i, j)*(at(i, j + 1, mean_half) - at(i, j, mean_half))*self%step
        carried = carried + contact*area
      end do
    end do
    friction = friction + self%asperities%friction_force(speed, carried)
    loads%friction = loads%friction + friction
    loads%moment = loads%moment - side*self%arm*friction
    loads%least_gap = min(loads%least_gap, minval(at(:, :self%along, gap)))
    loads%pressure = max(loads%pressure, maxval(p))
  end subroutine find_loads

  !> Gaps and pressures of a face, those of the film still to be cut off at 0. On exit the motion is that of the panel.
  pure subroutine find_face(self, side, motion, at, full, p, springs)
    type(face_film_t), intent(in) :: self
    integer, intent(in) :: side
    type(face_motion_t), intent(inout) :: motion
    real(dp), intent(out) :: at(self%around, 0:self%along + 1, n_seen)
    logical, intent(out) :: full(self%around, self%along - 1)
    real(dp), intent(out) :: p(0:self%around + 1, 0:self%along)
    type(face_springs_t), intent(inout), optional :: springs
    type(face_motion_t) :: of_piston
    if (present(springs)) then
      of_piston = motion
      springs%rate = 0
      motion = self%panel_motion(side, of_piston, springs)
      call see_gaps(self, side, motion, at)
      call find_yielding(self, side, motion, at, springs, full, p)
      motion = self%panel_motion(side, of_piston, springs)
    else
      call see_gaps(self, side, motion, at)
      call find_pressures(self, side, motion, at, full, p)
    end if
  end subroutine find_face

  !> Pressure of the asperities at a gap [Pa].
  pure real(dp) function contact_pressure(self, gap)
    class(face_film_t), intent(in) :: self
    real(dp), intent(in) :: gap   !! [m]
    contact_pressure = 0
    if (gap < 8*self%asperities%roughness) contact_pressure = self%asperities%pressure(-gap, 0.0_dp)
  end function contact_pressure

  !> Gaps and pressures of both films at a motion, of elastic faces with their deflections.
  subroutine field(self, motion, faces, springs)
    class(face_film_t), intent(in) :: self
    type(face_motion_t), intent(in) :: motion
    type(faces_t), intent(out) :: faces
    type(face_springs_t), intent(inout), optional :: springs(2)   !! of the sides +1 and -1
    real(dp) :: at(self%around, 0:self%along + 1, n_seen), p(0:self%around + 1, 0:self%along)
    logical :: full(self%around, self%along - 1)
    type(face_motion_t) :: panel
    integer :: k
    allocate (faces%angle(self%around), faces%height(self%along + 1))
    allocate (faces%gap(self%around, self%along + 1, 2), faces%pressure(self%around, self%along + 1, 2))
    faces%angle = acos(self%cosine(:, 1))
    faces%height = self%z
    do k = 1, 2
      panel = motion
      if (present(springs)) then
        call find_face(self, 3 - 2*k, panel, at, full, p, springs(k))
      else
        call find_face(self, 3 - 2*k, panel, at, full, p)
      end if
      faces%gap(:, :, k) = at(:, :self%along, gap)
      faces%pressure(:, :, k) = max(p(1:self%around, :), 0.0_dp)
    end do
  end subroutine field

  !> Gaps of nodes, of the middles of the intervals below them and of the outer edges of their cells; 0 beyond the ends.
  pure subroutine see_gaps(self, side, motion, at)
    type(face_film_t), intent(in) :: self
    integer, intent(in) :: side
    type(face_motion_t), intent(in) :: motion
    real(dp), intent(out) :: at(self%around, 0:self%along + 1, n_seen)
    real(dp) :: shift, shift_half
    integer :: i, j
    at(:, 0, mean_half:slope_half) = 0
    at(:, self%along + 1, mean_half:slope_half) = 0
    do j = 0, self%along
      shift = side*(motion%offset + self%z(j)*motion%tilt)
      do i = 1, self%around
        at(i, j, gap) = self%clearance + self%relief(j) + self%oval(i, 1) - shift*self%cosine(i, 1)
        call self%asperities%film_gap(at(i, j, gap), at(i, j, mean), at(i, j, slope))
        call self%asperities%film_gap(self%clearance + self%relief(j) + self%oval(i, 2) - shift*self%cosine(i, 2), &
          at(i, j, mean_edge), at(i, j, slope_edge))
      end do
      if (j == 0) cycle
      shift_half = side*(motion%offset + self%z_half(j)*motion%tilt)
      do i = 1, self%around
        call self%asperities%film_gap(self%clearance + self%relief_half(j) + self%oval(i, 1) - shift_half*self%cosine(i, 1), &
          at(i, j, mean_half), at(i, j, slope_half))
      end do
    end do
  end subroutine see_gaps

  !> Conductances and inflows of the nodes.
  pure subroutine find_flows(self, side, motion, at, along, round, source)
    class(face_film_t), intent(in) :: self
    integer, intent(in) :: side
    type(face_motion_t), intent(in) :: motion
    real(dp), intent(in) :: at(self%around, 0:self%along + 1, n_seen)
    real(dp), intent(out) :: along(self%around, self%along), round(0:self%around, self%along - 1)
    real(dp), intent(out) :: source(self%around, self%along - 1)
    real(dp) :: speed, conducts, squeeze
    integer :: i, j
    speed = motion%velocity - side*self%arm*motion%tilt_rate
    do j = 1, self%along
      along(:, j) = self%step/(12*self%viscosity*(self%z(j) - self%z(j - 1)))*at(:, j, mean_half)**3
    end do
    round(0, :) = 0   ! the mirror
    do j = 1, self%along - 1
      conducts = self%width(j)/(12*self%viscosity*self%step)
      squeeze = side*(motion%offset_rate + self%z(j)*motion%tilt_rate)*self%step*self%width(j)
      do i = 1, self%around
        round(i, j) = conducts*at(i, j, mean_edge)**3
        source(i, j) = squeeze*at(i, j, slope)*self%cosine(i, 1) + &
          0.5_dp*speed*(at(i, j + 1, mean_half) - at(i, j, mean_half))*self%step
      end do
      round(self%around, j) = 2*round(self%around, j)   ! p = 0 half a cell away
    end do
  end subroutine find_flows

  !> Pressures of the nodes, 0 at the edges and in a frame around the face, still to be cut off at 0 [Pa], and which nodes are full.
  pure subroutine find_pressures(self, side, motion, at, full, p)
    type(face_film_t), intent(in) :: self
    integer, intent(in) :: side
    type(face_motion_t), intent(in) :: motion
    real(dp), intent(in) :: at(self%around, 0:self%along + 1, n_seen)
    logical, intent(out) :: full(self%around, self%along - 1)
    real(dp), intent(out) :: p(0:self%around + 1, 0:self%along)
    real(dp) :: along(self%around, self%along), round(0:self%around, self%along - 1), source(self%around, self%along - 1)
    call self%find_flows(side, motion, at, along, round, source)
    full = .true.
    if (.not. self%cuts_suction) call guess_full(self%around, self%along, along, round, source, full)
    call balance(self%around, self%along, along, round, source, self%cuts_suction, full, p)
  end subroutine find_pressures

  !> The linear loads at a motion; least gap and pressure are those of the tangent.
  pure type(face_loads_t) function loads_at(self, motion) result(loads)
    class(face_tangent_t), intent(in) :: self
    type(face_motion_t), intent(in) :: motion
    real(dp) :: change(3), moved(n_motion)
    moved = change_of(self, motion)
    change = matmul(self%slopes, moved)
    loads = self%loads
    loads%force = loads%force + change(1)
    loads%moment = loads%moment + change(2)
    loads%friction = loads%friction + change(3)
  end function loads_at

  !> Add to the linear loads at a motion what other deflections change, and find the rates of the springs.
  pure subroutine yield(self, motion, deflection, loads, rate)
    class(face_tangent_t), intent(in) :: self
    type(face_motion_t), intent(in) :: motion
    real(dp), intent(in) :: deflection(4)        !! [m]
    type(face_loads_t), intent(inout) :: loads   !! of `loads_at`
    real(dp), intent(out) :: rate(4)             !! [m/s]
    real(dp) :: change(3), moved(n_motion), bent(4)
    moved = change_of(self, motion)
    bent = deflection - self%deflection
    change = matmul(self%by_deflection, bent)
    loads%force = loads%force + change(1)
    loads%moment = loads%moment + change(2)
    loads%friction = loads%friction + change(3)
    rate = self%rate + matmul(self%rate_slopes(:, :n_motion), moved) + matmul(self%rate_slopes(:, n_motion + 1:), bent)
  end subroutine yield

  !> By how much the components of a motion differ from those of a tangent.
  pure function change_of(tangent, motion) result(change)
    type(face_tangent_t), intent(in) :: tangent
    type(face_motion_t), intent(in) :: motion
    real(dp) :: change(n_motion)
    change = [motion%offset - tangent%motion%offset, motion%tilt - tangent%motion%tilt, &
      motion%offset_rate - tangent%motion%offset_rate, motion%tilt_rate - tangent%motion%tilt_rate, &
      motion%velocity - tangent%motion%velocity]
  end function change_of
end module face_film
