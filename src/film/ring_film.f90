!> Film between the running face of a piston ring and the bore, for each length of the circumference, with the contact of their
!> asperities.
!>
!> The face is a parabola of height b with its crown at x_0 from the middle; h_r is its least gap, the ring's only coordinate. With
!> x up along the bore, the speed U of the ring, pressures of the gas at both edges and the load W that presses it to the wall,
!>
!>     h = h_r + a ((x - x_0)/(b/2))^2
!>     d/dx( H^3/(12 mu) dp/dx ) = H'(h) dh_r/dt - (U/2) dH/dx,   p >= 0 (Reynolds' condition)
!>     Int p dx + W_a = W
!>
!> H(h) is the mean gap of rough surfaces, W_a what their asperities carry. The ring has no inertia: its pressure is linear in
!> dh_r/dt, which the balance of the loads gives. The shear is that of a face full of oil.
module ring_film
  use kinds, only: dp
  use asperities, only: asperities_t
  use bearing_size, only: bearing_t
  use face_balance, only: least_inflow, most_rounds
  implicit none
  private
  public :: ring_face_t, ring_loads_t

  real(dp), parameter :: drag = 1e-5_dp           !! resistance to squeeze of a ruptured face, over that of a full one: a ring whose
                                                  !! asperities carry more than its load leaves the wall fast

  !> Of a ring, over the length of its circumference.
  type :: ring_loads_t
    real(dp) :: rate         !! of the least gap [m/s]
    real(dp) :: friction     !! on the ring along x [N/m]
    real(dp) :: asperities   !! W_a [N/m]
  end type ring_loads_t

  type :: ring_face_t
    real(dp) :: height = 0            !! b [m]
    real(dp) :: crown = 0             !! a, relief at the edges of a face whose crown is in the middle [m]
    real(dp) :: crown_offset = 0      !! x_0 [m]
    real(dp) :: viscosity = 0         !! mu [Pa s]
    type(asperities_t) :: asperities
    integer :: intervals = 20
    real(dp), private :: step = 0     !! between two nodes [m]
    real(dp), allocatable, private :: relief(:), relief_half(:)   !! of the nodes (0:intervals), of the middles between them [m]
  contains
    procedure :: prepare
    procedure :: find_loads
  end type ring_face_t

contains

  !> Make the grid, after everything else has been set.
  subroutine prepare(self)
    class(ring_face_t), intent(inout) :: self
    integer :: j
    self%step = self%height/self%intervals
    allocate (self%relief(0:self%intervals), self%relief_half(self%intervals))
    do j = 0, self%intervals
      self%relief(j) = relief_at(real(j, dp))
      if (j > 0) self%relief_half(j) = relief_at(j - 0.5_dp)
    end do
    call self%asperities%prepare(bearing_t(radius=1.0_dp, length=1.0_dp))

  contains

    pure real(dp) function relief_at(steps)
      real(dp), intent(in) :: steps   !! from the lower edge
      relief_at = self%crown*((2*steps*self%step - self%height - 2*self%crown_offset)/self%height)**2
    end function relief_at
  end subroutine prepare

  !> Loads of the face, and the rate of its least gap.
  pure subroutine find_loads(self, least_gap, speed, load, gas, loads)
    class(ring_face_t), intent(in) :: self
    real(dp), intent(in) :: least_gap   !! h_r [m]
    real(dp), intent(in) :: speed       !! U [m/s]
    real(dp), intent(in) :: load        !! W > 0 [N/m]
    real(dp), intent(in) :: gas(2)      !! pressures below and above the ring [Pa]
    type(ring_loads_t), intent(out) :: loads
    real(dp) :: p(0:self%intervals), mean(self%intervals), conducts(self%intervals)
    real(dp), dimension(self%intervals - 1) :: wedge, squeeze
    real(dp) :: gap, slope, unused
    integer :: j
    associate (n => self%intervals)
      do j = 1, n
        call self%asperities%film_gap(least_gap + self%relief_half(j), mean(j), unused)
      end do
      do j = 1, n - 1
        call self%asperities%film_gap(least_gap + self%relief(j), unused, slope)
        squeeze(j) = slope*self%step
      end do
      loads%asperities = 0
      do j = 0, n
        gap = least_gap + self%relief(j)
        if (gap < 8*self%asperities%roughness) loads%asperities = loads%asperities + &
          merge(0.5_dp, 1.0_dp, j == 0 .or. j == n)*self%asperities%pressure(-gap, 0.0_dp)*self%step
      end do
      conducts = mean**3/(12*self%viscosity*self%step)
      wedge = 0.5_dp*speed*(mean(2:) - mean(:n - 1))
      call balance(n, conducts, wedge, squeeze, gas, (load - loads%asperities)/self%step, loads%rate, p)
      loads%friction = self%asperities%friction_force(speed, loads%asperities) + &
        sum(0.5_dp*mean*(p(1:) - p(:n - 1)) - self%viscosity*speed*self%step/mean)
    end associate
  end subroutine find_loads

  !> Pressures of the nodes and rate of the gap for which the flows and the load balance.
  pure subroutine balance(n, conducts, wedge, squeeze, gas, carried, rate, p)
    integer, intent(in) :: n
    real(dp), intent(in) :: conducts(n)
    real(dp), intent(in) :: wedge(n - 1), squeeze(n - 1)   !! inflows of the nodes: by the speed, and over the rate, of which less
    real(dp), intent(in) :: gas(2)       !! at both ends [Pa]
    real(dp), intent(in) :: carried      !! sum of the pressures by trapezoids [Pa]
    real(dp), intent(out) :: rate        !! [m/s]
    real(dp), intent(out) :: p(0:n)      !! [Pa]
    real(dp) :: by_wedge(0:n), by_squeeze(0:n), upper(0:n), pivot, resistance, inflow, least
    logical :: full(n - 1), changes, is_full
    integer :: j, pass
    full = .true.
    resistance = 0
    upper = 0
    by_wedge = 0
    by_wedge([0, n]) = gas
    by_squeeze = 0
    do pass = 1, most_rounds
      do j = 1, n - 1
        if (full(j)) then
          pivot = 1/(conducts(j)*(1 - upper(j - 1)) + conducts(j + 1))
          upper(j) = conducts(j + 1)*pivot
          by_wedge(j) = (wedge(j) + conducts(j)*by_wedge(j - 1))*pivot
          by_squeeze(j) = (squeeze(j) + conducts(j)*by_squeeze(j - 1))*pivot
        else
          upper(j) = 0
          by_wedge(j) = 0
          by_squeeze(j) = 0
        end if
      end do
      do j = n - 1, 1, -1
        by_wedge(j) = by_wedge(j) + upper(j)*by_wedge(j + 1)
        by_squeeze(j) = by_squeeze(j) + upper(j)*by_squeeze(j + 1)
      end do
      if (pass == 1) resistance = drag*sum(by_squeeze)
      rate = (sum(by_wedge(1:n - 1)) + 0.5_dp*sum(gas) - carried)/(sum(by_squeeze) + resistance)
      p = by_wedge - rate*by_squeeze
      least = least_inflow*maxval(abs(wedge - rate*squeeze))
      changes = .false.
      do j = 1, n - 1
        if (full(j)) then
          is_full = .not. p(j) < 0
        else
          inflow = wedge(j) - rate*squeeze(j) + conducts(j)*p(j - 1) + conducts(j + 1)*p(j + 1)
          is_full = inflow > least
        end if
        if (is_full .neqv. full(j)) changes = .true.
        full(j) = is_full
      end do
      if (.not. changes) exit
    end do
    p(1:n - 1) = max(p(1:n - 1), 0.0_dp)
  end subroutine balance
end module ring_film
