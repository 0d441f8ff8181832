!> The columns of the piston's guide.
module guide_columns
  use trace_row, only: trace_row_t
  use chain_motion, only: motion_t, accelerations_t
  use piston_guide, only: piston_guide_t, guide_loads_t, n_corners, corner_names
  implicit none
  private
  public :: add_guide_columns

contains

  !> Add the columns of the guide to a row: the friction force on the piston along x and, with clearance in the bore, position and
  !> tilt of the piston and the quantities of each corner of its skirt.
  pure subroutine add_guide_columns(guide, motion, accelerations, loads, row)
    type(piston_guide_t), intent(in) :: guide
    type(motion_t), intent(in) :: motion
    type(accelerations_t), intent(in) :: accelerations
    type(guide_loads_t), intent(in) :: loads
    type(trace_row_t), intent(inout) :: row
    integer :: i
    call row%add('guide_friction_force[N]', loads%friction_force, &
      'friction of the guide on the piston along x; the frame takes the opposite')
    if (.not. guide%is_loose) return
    associate (at => motion%tilting)
      call row%add('piston_offset[m]', at%offset, 'centre of mass of the piston from the cylinder axis, along y')
      call row%add('piston_tilt[rad]', at%tilt, 'tilt of the piston in its bore, positive from x to y')
      call row%add('piston_offset_rate[m/s]', at%offset_rate, 'rate of piston_offset')
      call row%add('piston_tilt_rate[rad/s]', at%tilt_rate, 'rate of piston_tilt')
      call row%add('piston_offset_acceleration[m/s2]', accelerations%offset, 'rate of piston_offset_rate')
      call row%add('piston_tilt_acceleration[rad/s2]', accelerations%tilt, 'rate of piston_tilt_rate')
    end associate
    do i = 1, n_corners
      row%place = corner_names(i)//'_'
      call row%add('gap[m]', -loads%corner(i)%depth, &
        'gap between this corner of the skirt and the bore; negative where it penetrates')
      call row%add('force[N]', loads%corner(i)%normal_force, &
        'contact force of this corner, positive where it presses; 0 without contact')
      call row%add('friction[N]', loads%corner(i)%friction_force, 'friction of the bore on this corner, along x')
    end do
    row%place = ''
  end subroutine add_guide_columns
end module guide_columns
