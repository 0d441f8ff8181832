!> The columns of several cylinders on one crankshaft: twists, torques of segments and dampers, forces and moments of the whole
!> engine on its frame, main bearings, and the other cylinders.
module train_columns
  use kinds, only: dp
  use trace_row, only: trace_row_t
  use chain_motion, only: motion_t, accelerations_t
  use chain_reactions, only: reactions_t
  use ideal_cylinders, only: cylinder_forces_t
  use crank_train, only: crank_train_t
  use train_motion, only: most_cylinders
  implicit none
  private
  public :: add_train_columns

  !> Forces and moments of the frame on the whole engine, in the axes of the full cylinder, and forces of the frame on the throws of
  !> the shaft.
  type :: engine_forces_t
    real(dp) :: axis_offset = 0      !! of every cylinder axis from the crank axis [m]
    real(dp) :: force(2) = 0         !! [N]
    real(dp) :: moment(3) = 0        !! about the point of the shaft with axial position 0 [N m]
    real(dp) :: throw(2, most_cylinders) = 0   !! (:, throw) [N]
    type(cylinder_forces_t) :: cylinder(most_cylinders)   !! of the other cylinders
  contains
    procedure :: add
  end type engine_forces_t

contains

  !> Forces and moments of the whole engine, from the reactions of the mechanism.
  pure subroutine find_engine_forces(train, motion, accelerations, full, found)
    type(crank_train_t), intent(in) :: train
    type(motion_t), intent(in) :: motion
    type(accelerations_t), intent(in) :: accelerations
    type(reactions_t), intent(in) :: full
    type(engine_forces_t), intent(out) :: found
    integer :: i
    found%axis_offset = train%axis_offset
    call found%add(full, motion%piston_position, train%full_axial_position, train%full_throw, 0.0_dp)
    do i = 1, size(train%cylinders)
      associate (it => train%cylinders(i), at => motion%train)
        found%cylinder(i) = it%forces(at%angle(i), at%speed(it%station), accelerations%station(it%station), at%gas_force(i))
        call found%add(found%cylinder(i)%reactions, found%cylinder(i)%piston_position, it%axial_position, it%throw, it%bank)
      end associate
    end do
  end subroutine find_engine_forces

  !> Add the forces of a cylinder at the axial position z [m], whose axes are turned by its bank. About the shaft turn those of the
  !> guide and, with an offset of the axis, those along the axis: of the gas on the head, and of the friction of the bore.
  pure subroutine add(self, reactions, piston_position, z, throw, bank)
    class(engine_forces_t), intent(inout) :: self
    type(reactions_t), intent(in) :: reactions
    real(dp), intent(in) :: piston_position, z, bank
    integer, intent(in) :: throw
    real(dp) :: force(2)
    force = turned(reactions%frame, bank)
    self%force = self%force + force
    self%moment = self%moment + [-z*force(2), z*force(1), &
      self%axis_offset*(reactions%crank_bearing(1) - reactions%frame(1)) - piston_position*reactions%guide]
    self%throw(:, throw) = self%throw(:, throw) + turned(reactions%crank_bearing, bank)
  end subroutine add

  !> A vector turned from x towards y [rad].
  pure function turned(vector, angle)
    real(dp), intent(in) :: vector(2), angle
    real(dp) :: turned(2)
    turned = [vector(1)*cos(angle) - vector(2)*sin(angle), vector(1)*sin(angle) + vector(2)*cos(angle)]
  end function turned

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
    call find_engine_forces(train, motion, accelerations, reactions, engine)
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
    call add_bearings(engine%throw(:, :train%n_throws), row)
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

  !> Main bearing b is between the throws b - 1 and b; each throw loads its two bearings by halves.
  pure subroutine add_bearings(throw, row)
    real(dp), intent(in) :: throw(:, :)   !! forces on the throws [N]
    type(trace_row_t), intent(inout) :: row
    real(dp) :: force(2)
    integer :: b
    do b = 1, size(throw, 2) + 1
      force = 0
      if (b > 1) force = 0.5_dp*throw(:, b - 1)
      if (b <= size(throw, 2)) force = force + 0.5_dp*throw(:, b)
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
