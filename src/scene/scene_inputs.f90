!> Inputs of a scene, which a program that embeds a run may change while it pauses: the torque on a free crank, the speed of a
!> crank whose speed is prescribed, and a pressure that is set from outside. A crank that is prescribed through an elastic shaft has
!> no input.
module scene_inputs
  use kinds, only: dp
  use scene_problem, only: scene_t
  implicit none
  private
  public :: input_t, inputs, inputs_of, input_value, change_input

  !> What an input is called.
  type :: input_t
    character(len=24) :: name = ''
    character(len=8) :: unit = ''
    character(len=80) :: meaning = ''
    logical :: is_ramp = .false.   !! it changes linearly to its new value, so that the motion has no jump; others are held
  end type input_t

  integer, parameter :: torque = 1, speed = 2, pressure = 3
  type(input_t), parameter :: inputs(3) = [ &
    input_t('drive.torque', 'N.m', 'driving torque on the crank'), &
    input_t('drive.crank_speed', 'rad/s', 'prescribed speed of the crank', .true.), &
    input_t('cylinder_pressure', 'Pa', 'absolute pressure of the gas in the cylinder')]

contains

  !> The inputs that a scene has, as indices into `inputs`.
  pure subroutine inputs_of(scene, list)
    type(scene_t), intent(in) :: scene
    integer, allocatable, intent(out) :: list(:)
    logical :: has(size(inputs))
    integer :: i
    has(torque) = scene%chain%drive%free_crank
    has(speed) = .not. scene%crank_moves
    has(pressure) = allocated(scene%gas)
    if (has(pressure)) has(pressure) = scene%gas%is_external()
    list = pack([(i, i=1, size(inputs))], has)
  end subroutine inputs_of

  !> The present value of an input at (t, y).
  pure real(dp) function input_value(scene, input, t, y) result(value)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: input   !! index into `inputs`
    real(dp), intent(in) :: t, y(:)
    select case (input)
    case (torque)
      value = scene%chain%drive%torque
    case (speed)
      value = scene%crank_speed(t, y)
    case default
      value = scene%gas%held_pressure
    end select
  end function input_value

  !> Give an input a new value at (t, y), where the integration has been cut and is to be restarted. One that changes linearly
  !> reaches the value at the time `until` and goes on in the same way unless it is changed again.
  pure subroutine change_input(scene, input, value, t, y, until)
    type(scene_t), intent(inout) :: scene
    integer, intent(in) :: input   !! index into `inputs`
    real(dp), intent(in) :: value, t, y(:), until
    real(dp) :: now, turned
    select case (input)
    case (torque)
      scene%torque_work = scene%torque_work + (scene%chain%drive%torque - value)*(scene%crank_angle(t, y) - scene%start_angle)
      scene%chain%drive%torque = value
    case (speed)
      now = scene%crank_speed(t, y)
      if (abs(value - now) <= 8*epsilon(now)*abs(now)) now = value   ! at the end of a linear change
      turned = scene%crank_angle(t, y) - scene%start_angle
      if (.not. allocated(scene%chain%varying)) allocate (scene%chain%varying)
      call scene%chain%varying%steer(t, turned, now, merge((value - now)/(until - t), 0.0_dp, until > t))
      scene%runs_up = .true.
      scene%is_plain = .false.
    case default
      scene%gas%held_pressure = value
    end select
  end subroutine change_input
end module scene_inputs
