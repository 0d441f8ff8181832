!> The scene with an ideal pin joint.
module ideal_scene
  use kinds, only: dp
  use ode_problem, only: event_continue
  use mechanism, only: turn_crank
  use dynamics, only: pin_force_size
  use ideal_joint, only: follow_crank, ideal_accelerations
  use clearance_joint, only: joint_motion_t
  use scene, only: scene_t, evaluation_t, event_none
  implicit none
  private
  public :: ideal_scene_t

  !> The pin of an ideal joint, in the terms of one with clearance.
  type(joint_motion_t), parameter :: centred_pin = joint_motion_t([0.0_dp, 0.0_dp], [0.0_dp, 0.0_dp], &
    [1.0_dp, 0.0_dp], 0.0_dp, 0.0_dp, 0.0_dp, 0.0_dp, 0.0_dp)

  !> Nothing but the crank moves by itself.
  type, extends(scene_t) :: ideal_scene_t
  contains
    procedure :: derivatives
    procedure :: evaluate
    procedure :: initial_state
    procedure :: claim
    procedure :: reported_event
    procedure :: events => crank_events
    procedure :: handle_event
  end type ideal_scene_t

contains

  pure subroutine derivatives(self, t, y, dydt, inside)
    class(ideal_scene_t), intent(in) :: self
    real(dp), intent(in) :: t, y(self%n)
    real(dp), intent(out) :: dydt(self%n)
    logical, intent(out) :: inside
    type(evaluation_t) :: now
    inside = .true.
    call find_accelerations(self, t, y, now)
    if (self%drive%free_crank) then
      dydt(self%crank%position) = now%motion%crank_speed
      dydt(self%crank%rate) = now%accelerations%crank
    end if
    dydt(self%work_at) = now%power
    dydt(self%measures%first:self%measures%last) = pin_force_size(now%loads)
  end subroutine derivatives

  pure subroutine evaluate(self, t, y, evaluation, inside)
    class(ideal_scene_t), intent(in) :: self
    real(dp), intent(in) :: t, y(self%n)
    type(evaluation_t), intent(out) :: evaluation
    logical, intent(out) :: inside
    inside = .true.
    evaluation%cylinder_pressure = 0
    call find_accelerations(self, t, y, evaluation)
    evaluation%joint = centred_pin
    evaluation%normal_force = 0
    evaluation%friction_force = 0
  end subroutine evaluate

  !> Motion, loads, accelerations and power: the right-hand side, and all of an evaluation but the joint.
  pure subroutine find_accelerations(self, t, y, now)
    class(ideal_scene_t), intent(in) :: self
    real(dp), intent(in) :: t, y(self%n)
    type(evaluation_t), intent(inout) :: now
    real(dp) :: crank_angle, crank_speed
    if (self%drive%free_crank) then
      crank_angle = y(self%crank%position)
      crank_speed = y(self%crank%rate)
    else
      crank_angle = self%start_angle + self%start_speed*t
      crank_speed = self%start_speed
    end if
    call turn_crank(now%motion, crank_angle, crank_speed)
    now%loads%gas_force = 0
    if (allocated(self%gas)) call self%add_gas(crank_angle, now)
    call follow_crank(self%mechanism, now%motion)
    call ideal_accelerations(self%mechanism, self%drive, now%motion, now%loads, now%accelerations, now%crank_moment)
    now%power = (now%crank_moment - self%drive%damping*crank_speed)*crank_speed &
      - now%loads%gas_force*now%motion%piston_velocity
  end subroutine find_accelerations

  pure function initial_state(self) result(y)
    class(ideal_scene_t), intent(in) :: self
    real(dp) :: y(self%n)
    y = 0
    if (.not. self%drive%free_crank) return
    y(self%crank%position) = self%start_angle
    y(self%crank%rate) = self%start_speed
  end function initial_state

  subroutine claim(self)
    class(ideal_scene_t), intent(inout) :: self
    call self%claim_crank()
    call self%claim_work()
  end subroutine claim

  pure subroutine crank_events(self, t, y, g, g_rate)
    class(ideal_scene_t), intent(in) :: self
    real(dp), intent(in) :: t, y(:)
    real(dp), intent(out) :: g(:), g_rate(:)
    if (self%drive%free_crank) then
      call self%gas_events(y(self%crank%position), y(self%crank%rate), g, g_rate)
    else
      call self%gas_events(self%start_angle + self%start_speed*t, self%start_speed, g, g_rate)
    end if
  end subroutine crank_events

  subroutine handle_event(self, index, t, y, action)
    class(ideal_scene_t), intent(inout) :: self
    integer, intent(in) :: index
    real(dp), intent(in) :: t
    real(dp), intent(inout) :: y(:)
    integer, intent(out) :: action
    associate (unused_t => t, unused_y => y)
    end associate
    call self%pass_gas_bound(index)
    action = event_continue
  end subroutine handle_event

  pure integer function reported_event(self, index)
    class(ideal_scene_t), intent(in) :: self
    integer, intent(in) :: index
    associate (unused_self => self, unused_index => index)
    end associate
    reported_event = event_none
  end function reported_event
end module ideal_scene
