!> The elastic members of a chain: their part of the state, of its equations and of its energy.
module elastic_members
  use gudgeon_kinds, only: dp
  use state_layout, only: layout_t, coordinates_t
  use chain_motion, only: motion_t, accelerations_t, most_shapes
  use chain_bodies, only: bodies_t
  use elastic_rod, only: elastic_rod_t
  use elastic_crankshaft, only: elastic_crankshaft_t
  implicit none
  private
  public :: elastic_members_t

  !> A member that a case does not ask for is not allocated, and rigid.
  type :: elastic_members_t
    type(elastic_rod_t), allocatable :: rod
    type(elastic_crankshaft_t), allocatable :: crankshaft
    type(coordinates_t) :: shapes(most_shapes)  !! where each shape of the rod stands in the state
    type(coordinates_t) :: flywheel             !! where its angle stands, unless its speed is held
    logical :: holds_flywheel = .false.         !! at constant speed
    real(dp) :: start_angle = 0                 !! of the flywheel [rad]
    real(dp) :: start_speed = 0                 !! [rad/s]
  contains
    procedure :: claim
    procedure :: settle
    procedure :: put_start
    procedure :: read_state
    procedure :: put_rates
    procedure :: driven_speed
    procedure :: n_shapes
    procedure :: damping_power
    procedure :: power
  end type elastic_members_t

contains

  !> Shapes of the rod.
  pure integer function n_shapes(self)
    class(elastic_members_t), intent(in) :: self
    n_shapes = 0
    if (allocated(self%rod)) n_shapes = self%rod%n
  end function n_shapes

  !> Claim the shapes and the flywheel. Each shape is measured by what the largest of the forces of inertia and gravity would bend
  !> or stretch it at rest, or a small part of the joints' own speeds would, its rate by what this is at its natural frequency.
  subroutine claim(self, layout, bodies, crank_speed, own_speed)
    class(elastic_members_t), intent(inout) :: self
    type(layout_t), intent(inout) :: layout
    type(bodies_t), intent(in) :: bodies
    real(dp), intent(in) :: crank_speed   !! natural size of it [rad/s]
    real(dp), intent(in) :: own_speed     !! of the pins in their bearings [m/s]
    real(dp) :: force, scale, frequency
    integer :: i
    if (allocated(self%rod)) then
      force = (bodies%rod%mass + bodies%piston%mass)*(bodies%crank%length*crank_speed**2 + norm2(bodies%gravity))
      do i = 1, self%rod%n
        frequency = self%rod%natural_frequency(i)
        scale = max(force/self%rod%stiffness(i), 0.01_dp*own_speed/frequency)
        call layout%claim_positions(1, scale, scale*frequency, self%shapes(i), grows=.false.)
      end do
    end if
    if (allocated(self%crankshaft) .and. .not. self%holds_flywheel) &
      call layout%claim_positions(1, 1.0_dp, crank_speed, self%flywheel, grows=.true.)
  end subroutine claim

  subroutine settle(self, layout)
    class(elastic_members_t), intent(inout) :: self
    type(layout_t), intent(in) :: layout
    integer :: i
    do i = 1, self%n_shapes()
      call layout%settle(self%shapes(i))
    end do
    if (self%flywheel%n > 0) call layout%settle(self%flywheel)
  end subroutine settle

  !> At t = 0 the rod is straight and as long as it is made, the shaft is not twisted, and nothing of it moves.
  pure subroutine put_start(self, y)
    class(elastic_members_t), intent(in) :: self
    real(dp), intent(inout) :: y(:)
    if (self%flywheel%n == 0) return
    y(self%flywheel%position) = self%start_angle
    y(self%flywheel%rate) = self%start_speed
  end subroutine put_start

  pure subroutine read_state(self, t, y, motion)
    class(elastic_members_t), intent(in) :: self
    real(dp), intent(in) :: t, y(*)
    type(motion_t), intent(inout) :: motion
    integer :: i
    do i = 1, self%n_shapes()
      motion%shape(i) = y(self%shapes(i)%position)
      motion%shape_rate(i) = y(self%shapes(i)%rate)
    end do
    if (.not. allocated(self%crankshaft)) return
    if (self%holds_flywheel) then
      motion%flywheel_angle = self%start_angle + self%start_speed*t
      motion%flywheel_speed = self%start_speed
    else
      motion%flywheel_angle = y(self%flywheel%position)
      motion%flywheel_speed = y(self%flywheel%rate)
    end if
  end subroutine read_state

  pure subroutine put_rates(self, motion, accelerations, dydt)
    class(elastic_members_t), intent(in) :: self
    type(motion_t), intent(in) :: motion
    type(accelerations_t), intent(in) :: accelerations
    real(dp), intent(inout) :: dydt(*)
    integer :: i
    do i = 1, self%n_shapes()
      dydt(self%shapes(i)%position) = motion%shape_rate(i)
      dydt(self%shapes(i)%rate) = accelerations%shape(i)
    end do
    if (self%flywheel%n == 0) return
    dydt(self%flywheel%position) = motion%flywheel_speed
    dydt(self%flywheel%rate) = accelerations%flywheel
  end subroutine put_rates

  !> Speed of what the drive turns: the flywheel of an elastic crankshaft or the crank [rad/s].
  pure real(dp) function driven_speed(self, motion)
    class(elastic_members_t), intent(in) :: self
    type(motion_t), intent(in) :: motion
    driven_speed = motion%crank_speed
    if (allocated(self%crankshaft)) driven_speed = motion%flywheel_speed
  end function driven_speed

  !> Power of the dampings on the bodies [W], <= 0.
  pure real(dp) function damping_power(self, motion)
    class(elastic_members_t), intent(in) :: self
    type(motion_t), intent(in) :: motion
    damping_power = 0
    if (allocated(self%rod)) damping_power = self%rod%damping_power(motion)
    if (allocated(self%crankshaft)) damping_power = damping_power + self%crankshaft%damping_power(motion)
  end function damping_power

  !> Power of the drive and of the dampings on the bodies [W]. The drive turns the flywheel or, without one, the crank.
  pure real(dp) function power(self, motion, moment, damping)
    class(elastic_members_t), intent(in) :: self
    type(motion_t), intent(in) :: motion
    real(dp), intent(in) :: moment, damping   !! of the drive [N m], [N m s/rad]
    real(dp) :: speed
    speed = self%driven_speed(motion)
    power = (moment - damping*speed)*speed + self%damping_power(motion)
  end function power
end module elastic_members
