!> The arc on which pin and bore of a joint press on each other, and the pressure along it, for the wear of their surfaces.
module contact_arc
  use gudgeon_kinds, only: dp
  use gudgeon_constants, only: pi
  use worn_bore, only: touching_cells_t
  use joint_motion, only: joint_motion_t
  use clearance_joint, only: clearance_joint_t, joint_loads_t, phase_contact
  implicit none
  private
  public :: contact_arc_t, arc_of, sliding_load

  integer, parameter :: least_cells = 16

  !> The arc, divided into cells. Angles are measured from the line of centres.
  type :: contact_arc_t
    integer :: n = 0                         !! number of cells
    real(dp), allocatable :: ends(:, :)      !! angles at which each cell begins and ends, (2, n) [rad]
    real(dp), allocatable :: loads(:)        !! Int p R L dtheta over each cell, relative to that of the others
  end type contact_arc_t

contains

  !> The arc of a joint in contact, in cells that are not much wider than `width` [rad]. A geometry of contact along a line, or at a
  !> point, has no cells. With theta = a sin s the cells have equal ranges of s, and the pressure is that in their middle.
  pure subroutine arc_of(joint, motion, width, arc)
    type(clearance_joint_t), intent(in) :: joint
    type(joint_motion_t), intent(in) :: motion
    real(dp), intent(in) :: width
    type(contact_arc_t), intent(inout) :: arc
    real(dp) :: half_angle, step, edge, s
    integer :: i
    arc%n = 0
    if (allocated(joint%worn)) then
      call worn_arc(joint, motion, arc)
      return
    end if
    half_angle = half_angle_of(joint, motion)
    if (.not. half_angle > 0) return
    arc%n = max(least_cells, ceiling(2*half_angle/width))
    call make_room(arc)
    step = pi/arc%n
    edge = -half_angle
    do i = 1, arc%n
      s = (i - 0.5_dp)*step - pi/2
      arc%ends(1, i) = edge
      edge = half_angle*sin(s + step/2)
      arc%ends(2, i) = edge
      arc%loads(i) = cos(s)
      if (allocated(joint%asperities)) then
        arc%loads(i) = arc%loads(i)*joint%asperities%pressure(motion%distance, half_angle*sin(s))
      else
        arc%loads(i) = arc%loads(i)*joint%contact%geometry%pressure(half_angle, half_angle*sin(s))
      end if
    end do
  end subroutine arc_of

  !> Make room for the cells of an arc.
  pure subroutine make_room(arc)
    type(contact_arc_t), intent(inout) :: arc
    if (allocated(arc%loads)) then
      if (size(arc%loads) >= arc%n) return
      deallocate (arc%ends, arc%loads)
    end if
    allocate (arc%ends(2, arc%n), arc%loads(arc%n))
  end subroutine make_room

  !> The arcs on which a pin touches a worn bore.
  pure subroutine worn_arc(joint, motion, arc)
    type(clearance_joint_t), intent(in) :: joint
    type(joint_motion_t), intent(in) :: motion
    type(contact_arc_t), intent(inout) :: arc
    type(touching_cells_t) :: touching
    real(dp) :: elastic(2), unused
    call joint%worn%cells(motion%eccentricity, touching)
    arc%n = touching%n
    if (arc%n == 0) return
    call make_room(arc)
    call joint%worn%press(motion%eccentricity, elastic, unused)
    arc%ends(:, :arc%n) = touching%ends(:, :arc%n) - atan2(elastic(2), elastic(1))
    arc%loads(:arc%n) = touching%loads(:arc%n)
  end subroutine worn_arc

  !> Int p R L dtheta |v| of a joint: the force that presses on the surfaces, summed without regard to its direction, times the
  !> sliding speed [W]. Times the wear rate of a surface it is the volume that wears in a second. On a wide arc it is larger than
  !> the normal force times the speed.
  pure real(dp) function sliding_load(joint, motion, loads)
    type(clearance_joint_t), intent(in) :: joint
    type(joint_motion_t), intent(in) :: motion
    type(joint_loads_t), intent(in) :: loads
    sliding_load = abs(loads%normal_force*motion%sliding_speed)
    if (sliding_load > 0) sliding_load = sliding_load*pressing_ratio(joint, motion)
  end function sliding_load

  !> Int p R L dtheta over the normal force [-]; 1 for contact along a line.
  pure real(dp) function pressing_ratio(joint, motion) result(ratio)
    type(clearance_joint_t), intent(in) :: joint
    type(joint_motion_t), intent(in) :: motion
    real(dp) :: half_angle, elastic(2), total
    ratio = 1
    if (allocated(joint%asperities)) then
      ratio = joint%asperities%total_pressure(motion%distance)
    else if (allocated(joint%worn)) then
      call joint%worn%press(motion%eccentricity, elastic, total)
      if (total > 0) ratio = total/norm2(elastic)
    else
      half_angle = half_angle_of(joint, motion)
      if (half_angle > 0) ratio = joint%contact%geometry%total_pressure(half_angle)
    end if
  end function pressing_ratio

  !> Half-angle of the arc [rad]; 0 if the geometry of the contact does not say it.
  pure real(dp) function half_angle_of(joint, motion) result(half_angle)
    type(clearance_joint_t), intent(in) :: joint
    type(joint_motion_t), intent(in) :: motion
    half_angle = 0
    if (allocated(joint%asperities)) then
      half_angle = joint%asperities%half_angle(motion%distance)
    else if (joint%phase == phase_contact) then
      if (motion%penetration > 0) half_angle = joint%contact%geometry%half_angle(motion%penetration)
    end if
  end function half_angle_of
end module contact_arc
