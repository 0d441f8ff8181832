!> The elastic members of a chain: their states, their contributions to the equations of motion, and their energy.
module elastic_members
  use kinds, only: dp
  use state_layout, only: layout_t, coordinates_t
  use run_state, only: run_state_t
  use chain_motion, only: motion_t, accelerations_t, most_shapes
  use chain_bodies, only: bodies_t
  use elastic_rod, only: elastic_rod_t
  use elastic_crankshaft, only: elastic_crankshaft_t
  use varying_drive, only: varying_drive_t
  implicit none
  private
  public :: elastic_members_t

  !> A member that is not in the case is not allocated; it is rigid.
  type :: elastic_members_t
    type(elastic_rod_t), allocatable :: rod
    type(elastic_crankshaft_t), allocatable :: crankshaft
    type(coordinates_t) :: shapes(most_shapes)  !! index of each shape of the rod in the state
    type(coordinates_t) :: flywheel             !! index of the flywheel's angle, unless its speed is prescribed
    logical :: holds_flywheel = .false.         !! the speed of the flywheel is prescribed
    type(varying_drive_t), allocatable :: run_up   !! this speed with a run-up; not allocated: it is constant
    real(dp) :: start_angle = 0                 !! initial angle of the flywheel [rad]
    real(dp) :: start_speed = 0                 !! [rad/s]
  contains
    procedure :: claim
    procedure :: set_start
    procedure :: declare
    procedure :: read_state
    procedure :: set_rates
    procedure :: driven_speed
    procedure :: n_shapes
    procedure :: damping_power
    procedure :: power
  end type elastic_members_t

contains

  !> Number of shapes of the rod.
  pure integer function n_shapes(self)
    class(elastic_members_t), intent(in) :: self
    n_shapes = 0
    if (allocated(self%rod)) n_shapes = self%rod%n
  end function n_shapes

  !> Claim the shapes and the flywheel in the state vector. The scale of a shape is its static deflection under the largest of the
  !> forces of inertia and gravity, or a small part of what the joints' own speeds would cause; the scale of its rate follows with
  !> its natural frequency.
  subroutine claim(self, layout, bodies, crank_speed, own_speed)
    class(elastic_members_t), intent(inout) :: self
    type(layout_t), intent(inout) :: layout
    type(bodies_t), intent(in) :: bodies
    real(dp), intent(in) :: crank_speed   !! natural size of the crank speed [rad/s]
    real(dp), intent(in) :: own_speed     !! natural speed of the pins in their bearings [m/s]
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

  !> Set the initial state in the state vector: the rod is straight and has its nominal length, the shaft is not twisted, and
  !> their rates are 0.
  pure subroutine set_start(self, y)
    class(elastic_members_t), intent(in) :: self
    real(dp), intent(inout) :: y(:)
    if (self%flywheel%n == 0) return
    y(self%flywheel%position) = self%start_angle
    y(self%flywheel%rate) = self%start_speed
  end subroutine set_start

  !> Declare the state of the members, at the angle and the speed of the crank.
  subroutine declare(self, list, t, y, crank_angle, crank_speed)
    class(elastic_members_t), intent(inout) :: self
    type(run_state_t), intent(inout) :: list
    real(dp), intent(in) :: t, crank_angle, crank_speed   !! [s], [rad], [rad/s]
    real(dp), intent(inout) :: y(:)
    type(motion_t) :: motion
    real(dp) :: twist, twist_rate
    integer :: n, i
    call self%read_state(t, y, motion)
    n = self%n_shapes()
    if (n > 0) then
      call list%add('rod_shapes', motion%shape(:n), 'm', 'amplitudes of the shapes of the elastic rod, bending first')
      call list%add('rod_shape_rates', motion%shape_rate(:n), 'm/s', 'their rates')
      do i = 1, n
        y(self%shapes(i)%position) = motion%shape(i)
        y(self%shapes(i)%rate) = motion%shape_rate(i)
      end do
    end if
    if (.not. allocated(self%crankshaft)) return
    twist = motion%flywheel_angle - crank_angle
    twist_rate = motion%flywheel_speed - crank_speed
    call list%add('crankshaft_twist', twist, 'rad', 'angle of the flywheel of the elastic crankshaft minus the crank angle')
    call list%add('crankshaft_twist_rate', twist_rate, 'rad/s', 'its rate')
    if (.not. list%sets) return
    if (self%flywheel%n > 0) then
      y(self%flywheel%position) = crank_angle + twist
      y(self%flywheel%rate) = crank_speed + twist_rate
    else
      self%start_angle = self%start_angle + (crank_angle + twist - motion%flywheel_angle)
    end if
  end subroutine declare

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
    if (allocated(self%run_up)) then
      motion%flywheel_angle = self%start_angle + self%run_up%turned(t)
      motion%flywheel_speed = self%run_up%speed(t)
      motion%held_acceleration = self%run_up%acceleration(t)
    else if (self%holds_flywheel) then
      motion%flywheel_angle = self%start_angle + self%start_speed*t
      motion%flywheel_speed = self%start_speed
    else
      motion%flywheel_angle = y(self%flywheel%position)
      motion%flywheel_speed = y(self%flywheel%rate)
    end if
  end subroutine read_state

  pure subroutine set_rates(self, motion, accelerations, dydt)
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
  end subroutine set_rates

  !> Angular speed of the part on which the drive acts: the flywheel of an elastic crankshaft, or the crank [rad/s].
  pure real(dp) function driven_speed(self, motion)
    class(elastic_members_t), intent(in) :: self
    type(motion_t), intent(in) :: motion
    driven_speed = motion%crank_speed
    if (allocated(self%crankshaft)) driven_speed = motion%flywheel_speed
  end function driven_speed

  !> Power of the damping on the bodies [W], <= 0.
  pure real(dp) function damping_power(self, motion)
    class(elastic_members_t), intent(in) :: self
    type(motion_t), intent(in) :: motion
    damping_power = 0
    if (allocated(self%rod)) damping_power = self%rod%damping_power(motion)
    if (allocated(self%crankshaft)) damping_power = damping_power + self%crankshaft%damping_power(motion)
  end function damping_power

  !> Power of the drive and of the damping on the bodies [W]. The drive acts on the flywheel or, without one, on the crank.
  pure real(dp) function power(self, motion, moment, damping)
    class(elastic_members_t), intent(in) :: self
    type(motion_t), intent(in) :: motion
    real(dp), intent(in) :: moment, damping   !! torque and damping of the drive [N m], [N m s/rad]
    real(dp) :: speed
    speed = self%driven_speed(motion)
    power = (moment - damping*speed)*speed + self%damping_power(motion)
  end function power
end module elastic_members
