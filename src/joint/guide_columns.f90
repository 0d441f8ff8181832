!> The columns of the piston's guide.
module guide_columns
  use kinds, only: dp
  use trace_row, only: trace_row_t, largest
  use chain_bodies, only: piston_t
  use chain_motion, only: motion_t, tilting_t, accelerations_t
  use piston_skirt, only: n_corners, corner_names
  use piston_guide, only: piston_guide_t, guide_loads_t
  implicit none
  private
  public :: add_guide_columns

contains

  !> Add the columns of the guide to a row: the friction force on the piston along x and, with clearance in the bore, position and
  !> tilt of the piston; then those of its elements.
  pure subroutine add_guide_columns(guide, piston, motion, accelerations, loads, row)
    type(piston_guide_t), intent(in) :: guide
    type(piston_t), intent(in) :: piston
    type(motion_t), intent(in) :: motion
    type(accelerations_t), intent(in) :: accelerations
    type(guide_loads_t), intent(in) :: loads
    type(trace_row_t), intent(inout) :: row
    real(dp) :: speed
    integer :: k
    call row%add('guide_friction_force[N]', loads%friction_force, &
      'friction of the guide on the piston along x; the frame takes the opposite')
    speed = motion%piston_velocity
    if (guide%is_loose) speed = motion%tilting%com_velocity
    call row%add_on_request('guide_friction_power[W]', loads%friction_force*speed, 'power of this friction; negative: a loss')
    if (guide%is_loose) call add_place(piston, motion%tilting, accelerations, guide%touching > 0, row)
    do k = 1, guide%n_elements
      call guide%slots(k)%element%add_columns(loads, row)
    end do
  end subroutine add_guide_columns

  !> Add the columns of a piston with clearance in its bore.
  pure subroutine add_place(piston, at, accelerations, has_corners, row)
    type(piston_t), intent(in) :: piston
    type(tilting_t), intent(in) :: at
    type(accelerations_t), intent(in) :: accelerations
    logical, intent(in) :: has_corners   !! dry ones may touch the bore
    type(trace_row_t), intent(inout) :: row
    integer :: i
    call row%add('piston_offset[m]', at%offset, 'centre of mass of the piston from the cylinder axis, along y')
    call row%add('piston_tilt[rad]', at%tilt, 'tilt of the piston in its bore, positive from x to y')
    call row%add('piston_offset_rate[m/s]', at%offset_rate, 'rate of piston_offset')
    call row%add('piston_tilt_rate[rad/s]', at%tilt_rate, 'rate of piston_tilt')
    call row%add('piston_offset_acceleration[m/s2]', accelerations%offset, 'rate of piston_offset_rate')
    call row%add('piston_tilt_acceleration[rad/s2]', accelerations%tilt, 'rate of piston_tilt_rate')
    call row%add_on_request('piston_side_energy[J]', 0.5_dp*(piston%mass*at%offset_rate**2 + piston%inertia*at%tilt_rate**2), &
      'kinetic energy of the piston across its bore and of its tilt')
    if (.not. has_corners) call row%keep('max_slap_energy', largest, &
      'largest kinetic energy of the piston across its bore and of its tilt')
    do i = 1, merge(n_corners, 0, has_corners)
      row%place = corner_names(i)//'_'
      call row%keep('max_impact_energy', largest, &
        'largest kinetic energy of the piston across its bore and of its tilt when a contact of this corner began', &
        at_impacts=.true.)
    end do
    row%place = ''
  end subroutine add_place
end module guide_columns
