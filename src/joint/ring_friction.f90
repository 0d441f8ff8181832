!> Element of the guide: friction of the piston rings on the bore, of each in closed form or by its film, with a state: its smallest
!> film thickness (see `ring_film`).
!>
!> Tension and gas press a ring to the wall; per length of its circumference, with D the bore, b the height of the face and p - p_k
!> the pressure of the cylinder above that of the crankcase,
!>
!>     W = 2 F_t/D + b (g_behind - (g_above + g_below)/2)(p - p_k)
!>     F_x = -pi D (3.18 sqrt(mu W) U/(U^2 + v_t^2)^(1/4) + mu_b W tanh(U/v_t) exp(-h_0/s)),   h_0 = 2.446 mu |U| rho/W
!>
!> The first part is the shear of the film of a parabolic face a (2x/b)^2 full of oil, by Reynolds' equation without suction: its
!> coefficient is 3.1 to 3.4 while the crown a is 0.8 to 10 times the film, and 4.3 for a face of any height. h_0 is the film of
!> Martin (1916) with rho = b^2/(8 a), of a face of any height: a scale for the part of the load that asperities carry, not the film
!> of the ring, which squeeze keeps from vanishing and the edges of the face from growing.
!>
!> The load on a film is W = 2 F_t/D + b g_behind (p - p_k), and g_above and g_below times p - p_k are the pressures at its edges.
module ring_friction
  use kinds, only: dp
  use constants, only: pi
  use trace_row, only: trace_row_t, least, largest, mean, of_cycle
  use chain_motion, only: motion_t, tilting_t
  use piston_skirt, only: skirt_t
  use guide_case, only: guide_case_t
  use guide_element, only: guide_element_t, guide_loads_t, deepest
  use ring_case, only: most_piston_rings
  use ring_film, only: ring_face_t, ring_loads_t
  implicit none
  private
  public :: ring_friction_t

  character(len=6), parameter :: names(most_piston_rings) = ['ring_1', 'ring_2', 'ring_3', 'ring_4', 'ring_5', 'ring_6']
  real(dp), parameter :: shear = 3.18_dp, martin = 2.446_dp
  real(dp), parameter :: least_load = 0.1_dp   !! of that by tension: suction of the cylinder does not lift a ring off

  type :: ring_t
    real(dp) :: by_tension = 0   !! load by the tension [N/m]
    real(dp) :: by_gas = 0       !! load over the pressure difference [m]
    real(dp) :: radius = 0       !! rho, of the face at its crown [m]
    type(ring_face_t), allocatable :: face   !! of a film; not allocated: closed form
    real(dp) :: gas(2) = 0       !! pressures below and above it, over the pressure difference
    integer :: state = 0         !! its number among the states
  end type ring_t

  type, extends(guide_element_t) :: ring_friction_t
    type(ring_t), allocatable :: rings(:)     !! from the top
    real(dp) :: bore = 0                      !! D [m]
    real(dp) :: viscosity = 0                 !! mu [Pa s]
    real(dp) :: coefficient = 0               !! mu_b; 0: smooth surfaces
    real(dp) :: roughness = 1                 !! s [m]
    real(dp) :: transition_speed = 0.01_dp    !! v_t [m/s]
  contains
    procedure :: prepare
    procedure :: find_loads
    procedure :: admits
    procedure :: add_columns
  end type ring_friction_t

contains

  subroutine prepare(self, wanted)
    class(ring_friction_t), intent(inout) :: self
    type(guide_case_t), intent(in) :: wanted
    integer :: i
    self%bore = wanted%bore
    self%viscosity = wanted%rings%oil%viscosity()
    if (allocated(wanted%rings%asperities)) then
      self%coefficient = wanted%rings%asperities%coefficient
      self%roughness = wanted%rings%asperities%roughness
      self%transition_speed = wanted%rings%asperities%transition_speed
    end if
    self%state_name = 'ring_film_thickness'
    self%state_unit = 'm'
    self%state_scale = self%roughness
    allocate (self%rings(size(wanted%rings%rings)))
    do i = 1, size(self%rings)
      associate (it => wanted%rings%rings(i), ring => self%rings(i))
        ring%by_tension = 2*it%tension/self%bore
        ring%by_gas = it%height*(it%gas_behind - 0.5_dp*(it%gas_above + it%gas_below))
        ring%radius = it%height**2/(8*it%crown)
        if (.not. it%has_film()) cycle
        self%n_states = self%n_states + 1
        self%start(self%n_states) = it%start_film
        ring%state = self%n_states
        ring%by_gas = it%height*it%gas_behind
        ring%gas = [it%gas_below, it%gas_above]
        allocate (ring%face)
        ring%face%height = it%height
        ring%face%crown = it%crown
        ring%face%crown_offset = it%crown_offset
        ring%face%viscosity = self%viscosity
        ring%face%asperities = wanted%rings%asperities
        ring%face%intervals = wanted%rings%oil%along
        call ring%face%prepare()
      end associate
    end do
  end subroutine prepare

  pure subroutine find_loads(self, skirt, motion, y, now)
    class(ring_friction_t), intent(in) :: self
    type(skirt_t), intent(in) :: skirt
    type(motion_t), intent(in) :: motion
    real(dp), intent(in) :: y(*)
    type(guide_loads_t), intent(inout) :: now
    type(ring_loads_t) :: film
    real(dp) :: pressure, load
    integer :: i
    pressure = now%gas_force/(0.25_dp*pi*self%bore**2)
    do i = 1, size(self%rings)
      associate (ring => self%rings(i), it => now%ring(i))
        load = max(ring%by_tension + ring%by_gas*pressure, least_load*ring%by_tension)
        if (allocated(ring%face)) then
          it%least_gap = y(self%states%first + ring%state - 1)
          call ring%face%find_loads(it%least_gap, now%speed, load, ring%gas*pressure, film)
          now%rates(self%rates%first + ring%state - 1) = film%rate
          it%friction = pi*self%bore*film%friction
          it%asperities = pi*self%bore*film%asperities
        else
          it%friction = closed_form(self, ring, now%speed, load)
        end if
      end associate
    end do
    now%friction_force = now%friction_force + sum(now%ring(:size(self%rings))%friction)
  end subroutine find_loads

  !> Friction of a ring without a film on the piston along x, at a speed [m/s] and under a load [N/m] [N].
  pure real(dp) function closed_form(self, ring, u, load) result(friction)
    type(ring_friction_t), intent(in) :: self
    type(ring_t), intent(in) :: ring
    real(dp), intent(in) :: u, load
    real(dp) :: film
    associate (v_t => self%transition_speed)
      film = martin*self%viscosity*abs(u)*ring%radius/load
      friction = -pi*self%bore*(shear*sqrt(self%viscosity*load)*u/sqrt(sqrt(u**2 + v_t**2)) + &
        self%coefficient*load*tanh(u/v_t)*exp(-film/self%roughness))
    end associate
  end function closed_form

  !> Whether no film is so thin that the model of asperities does not hold.
  pure logical function admits(self, y, tilting)
    class(ring_friction_t), intent(in) :: self
    real(dp), intent(in) :: y(*)
    type(tilting_t), intent(in) :: tilting
    admits = .true.
    if (self%n_states > 0) admits = all(y(self%states%first:self%states%last) > deepest*self%roughness)
  end function admits

  pure subroutine add_columns(self, now, row)
    class(ring_friction_t), intent(in) :: self
    type(guide_loads_t), intent(in) :: now
    type(trace_row_t), intent(inout) :: row
    real(dp) :: friction(size(self%rings))
    integer :: i
    friction = now%ring(:size(self%rings))%friction
    do i = 1, size(friction)
      call row%add(names(i)//'_friction_force[N]', friction(i), 'friction of the bore on this piston ring, along x')
      call row%add_on_request(names(i)//'_power[W]', -friction(i)*now%speed, 'power that this friction takes')
      call row%keep('mean_'//names(i)//'_power', mean, 'mean power that the friction of this piston ring takes', told=of_cycle, &
        is_sampled=.true.)
      if (.not. allocated(self%rings(i)%face)) cycle
      call row%add(names(i)//'_film_thickness[m]', now%ring(i)%least_gap, 'smallest gap between this piston ring and the bore')
      call row%keep('min_'//names(i)//'_film_thickness', least, 'smallest gap between this piston ring and the bore', &
        has_angle=.true.)
      call row%add(names(i)//'_asperity_force[N]', now%ring(i)%asperities, &
        'force of the asperities between this piston ring and the bore, around the circumference')
      call row%keep('max_'//names(i)//'_asperity_force', largest, 'largest force of the asperities of this piston ring')
    end do
    call row%add('ring_friction_force[N]', sum(friction), 'friction of the bore on all piston rings, along x')
    call row%add_on_request('ring_power[W]', -sum(friction)*now%speed, 'power that the friction of all piston rings takes')
    call row%keep('mean_ring_power', mean, 'mean power that the friction of all piston rings takes', told=of_cycle, &
      is_sampled=.true.)
  end subroutine add_columns
end module ring_friction
