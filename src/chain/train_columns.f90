!> The columns of several cylinders on one crankshaft: twists, torques of segments and dampers, forces and moments of the whole
!> engine on its frame, main bearings, and the other cylinders.
module train_columns
  use kinds, only: dp
  use trace_row, only: trace_row_t
  use chain_motion, only: motion_t, accelerations_t
  use chain_reactions, only: reactions_t
  use ideal_cylinders, only: cylinder_forces_t
  use engine_forces, only: engine_forces_t
  use crank_train, only: crank_train_t
  implicit none
  private
  public :: add_train_columns

contains

  !> Add the columns to a row. Speeds of stations, main bearings and the other cylinders are written only on request.
  pure subroutine add_train_columns(train, motion, accelerations, reactions, row)
    type(crank_train_t), intent(in) :: train
    type(motion_t), intent(in) :: motion
    type(accelerations_t), intent(in) :: accelerations
    type(reactions_t), intent(in) :: reactions   !! of the mechanism
    type(trace_row_t), intent(inout) :: row
    type(engine_forces_t) :: engine
    integer :: j
    if (train%is_chain) call add_shaft(train, motion, row)
    call engine%find(train, motion, accelerations, reactions)
    call engine%add_up(train, motion, reactions)
    call row%add('engine_force_x[N]', engine%force(1), &
      'force of the frame on the whole engine, along x of the full cylinder: the sum of its frame_force over all cylinders')
    call row%add('engine_force_y[N]', engine%force(2), 'the same along y')
    call row%add('engine_moment_x[N.m]', engine%moment(1), 'moment of these forces by their axial positions, about x')
    call row%add('engine_moment_y[N.m]', engine%moment(2), 'the same about y')
    call row%add('engine_moment_z[N.m]', engine%moment(3), &
      'roll moment of the frame on the engine, about the shaft: of the guides, and of the gas beside an offset shaft')
    if (train%is_chain) then
      do j = 1, train%n
        if (j /= train%full) call row%add_on_request(numbered('station', j, 'speed[rad/s]', row), motion%train%speed(j), &
          'angular velocity of this station')
      end do
    end if
    call add_bearings(engine, train%n_throws, row)
    do j = 1, size(train%cylinders)
      call add_cylinder(train%cylinders(j)%number, engine%cylinder(j), motion%train%gas_force(j), row)
    end do
  end subroutine add_train_columns

  pure subroutine add_shaft(train, motion, row)
    type(crank_train_t), intent(in) :: train
    type(motion_t), intent(in) :: motion
    type(trace_row_t), intent(inout) :: row
    integer :: j
    do j = 1, train%n
      if (j /= train%full) call row%add(numbered('station', j, 'twist[rad]', row), motion%train%twist(j), &
        'angle of this station of the crankshaft less the crank angle')
    end do
    do j = 1, train%n - 1
      call row%add(numbered('segment', j, 'torque[N.m]', row), train%segment_torque(motion, j), &
        'torque of the shaft between this station and the next one on this station; the next one takes the opposite')
    end do
    do j = 1, size(train%rings)
      call row%add(numbered('damper', j, 'speed[rad/s]', row), motion%train%ring_speed(j), 'angular velocity of the ring')
      call row%add(numbered('damper', j, 'torque[N.m]', row), train%ring_torque(motion, j), 'torque of the ring on its station')
      if (.not. train%rings(j)%is_viscous) call row%add(numbered('damper', j, 'twist[rad]', row), motion%train%ring_twist(j), &
        'angle of the ring less that of its station')
    end do
  end subroutine add_shaft

  pure subroutine add_bearings(engine, n_throws, row)
    type(engine_forces_t), intent(in) :: engine
    integer, intent(in) :: n_throws
    type(trace_row_t), intent(inout) :: row
    real(dp) :: force(2)
    integer :: b
    do b = 1, n_throws + 1
      force = engine%on_shaft(b, n_throws)
      call row%add_on_request(numbered('main_bearing', b, 'force_x[N]', row), force(1), &
        'force of the frame on the shaft at this main bearing, along x; each throw loads its two bearings by halves')
      call row%add_on_request(numbered('main_bearing', b, 'force_y[N]', row), force(2), 'the same along y')
    end do
  end subroutine add_bearings

  pure subroutine add_cylinder(number, found, gas_force, row)
    integer, intent(in) :: number
    type(cylinder_forces_t), intent(in) :: found
    real(dp), intent(in) :: gas_force
    type(trace_row_t), intent(inout) :: row
    call row%add_on_request(numbered('cylinder', number, 'piston_position[m]', row), found%piston_position, &
      'height of the piston of this cylinder above the shaft, along its axis')
    call row%add_on_request(numbered('cylinder', number, 'gas_force[N]', row), gas_force, &
      'force of the gas on this piston, towards the shaft')
    call row%add_on_request(numbered('cylinder', number, 'torque[N.m]', row), found%torque, &
      'torque of the rod of this cylinder on its crank')
    call row%add_on_request(numbered('cylinder', number, 'guide_force[N]', row), found%reactions%guide, &
      'force of this piston on its guide, along y of this cylinder')
    call row%add_on_request(numbered('cylinder', number, 'crankpin_force_x[N]', row), found%reactions%crankpin(1), &
      'force of the crank on this rod, along the axis of this cylinder')
    call row%add_on_request(numbered('cylinder', number, 'crankpin_force_y[N]', row), found%reactions%crankpin(2), &
      'the same across')
  end subroutine add_cylinder

  !> station_3_twist[rad]; only while names are collected. Of one length, so that threads may call it at once.
  pure function numbered(what, number, quantity, row) result(name)
    character(len=*), intent(in) :: what, quantity
    integer, intent(in) :: number
    type(trace_row_t), intent(in) :: row
    character(len=48) :: name
    character(len=11) :: digits
    name = ''
    if (.not. row%is_naming) return
    write (digits, '(i0)') number
    name = what//'_'//trim(digits)//'_'//quantity
  end function numbered
end module train_columns
