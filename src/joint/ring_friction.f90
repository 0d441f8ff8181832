!> Element of the guide: friction of the piston rings on the bore, in closed form.
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
module ring_friction
  use kinds, only: dp
  use constants, only: pi
  use trace_row, only: trace_row_t, mean, of_cycle
  use chain_motion, only: motion_t
  use piston_skirt, only: skirt_t
  use guide_case, only: guide_case_t
  use guide_element, only: guide_element_t, guide_loads_t
  use ring_case, only: most_piston_rings
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
    procedure :: add_columns
    procedure, private, non_overridable :: forces
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
    allocate (self%rings(size(wanted%rings%rings)))
    do i = 1, size(self%rings)
      associate (ring => wanted%rings%rings(i))
        self%rings(i) = ring_t(2*ring%tension/self%bore, ring%height*(ring%gas_behind - 0.5_dp*(ring%gas_above + ring%gas_below)), &
          ring%height**2/(8*ring%crown))
      end associate
    end do
  end subroutine prepare

  !> Friction of each ring on the piston along x [N].
  pure function forces(self, now) result(friction)
    class(ring_friction_t), intent(in) :: self
    type(guide_loads_t), intent(in) :: now
    real(dp) :: friction(size(self%rings))
    real(dp) :: pressure, load, film
    integer :: i
    pressure = now%gas_force/(0.25_dp*pi*self%bore**2)
    associate (u => now%speed, v_t => self%transition_speed)
      do i = 1, size(self%rings)
        associate (ring => self%rings(i))
          load = max(ring%by_tension + ring%by_gas*pressure, least_load*ring%by_tension)
          film = martin*self%viscosity*abs(u)*ring%radius/load
          friction(i) = -pi*self%bore*(shear*sqrt(self%viscosity*load)*u/sqrt(sqrt(u**2 + v_t**2)) + &
            self%coefficient*load*tanh(u/v_t)*exp(-film/self%roughness))
        end associate
      end do
    end associate
  end function forces

  pure subroutine find_loads(self, skirt, motion, y, now)
    class(ring_friction_t), intent(in) :: self
    type(skirt_t), intent(in) :: skirt
    type(motion_t), intent(in) :: motion
    real(dp), intent(in) :: y(*)
    type(guide_loads_t), intent(inout) :: now
    now%friction_force = now%friction_force + sum(self%forces(now))
  end subroutine find_loads

  pure subroutine add_columns(self, now, row)
    class(ring_friction_t), intent(in) :: self
    type(guide_loads_t), intent(in) :: now
    type(trace_row_t), intent(inout) :: row
    real(dp) :: friction(size(self%rings))
    integer :: i
    friction = self%forces(now)
    do i = 1, size(friction)
      call row%add(names(i)//'_friction_force[N]', friction(i), 'friction of the bore on this piston ring, along x')
      call row%add_on_request(names(i)//'_power[W]', -friction(i)*now%speed, 'power that this friction takes')
      call row%keep('mean_'//names(i)//'_power', mean, 'mean power that the friction of this piston ring takes', told=of_cycle, &
        is_sampled=.true.)
    end do
    call row%add('ring_friction_force[N]', sum(friction), 'friction of the bore on all piston rings, along x')
    call row%add_on_request('ring_power[W]', -sum(friction)*now%speed, 'power that the friction of all piston rings takes')
    call row%keep('mean_ring_power', mean, 'mean power that the friction of all piston rings takes', told=of_cycle, &
      is_sampled=.true.)
  end subroutine add_columns
end module ring_friction
