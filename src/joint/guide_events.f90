!> Events of a piston with clearance in its bore: contacts of the corners of its skirt begin and end.
module guide_events
  use gudgeon_kinds, only: dp
  use chain_motion, only: motion_t, accelerations_t
  use piston_guide, only: piston_guide_t, corner_t, n_corners
  implicit none
  private
  public :: corner_events, change_contact, begin_corner_contact, contact_is_rough, rough_corner_end, &
    inward_acceleration

contains

  !> Event functions and their rates: the penetration of a corner [m] while it is not in contact, and minus the penetration while it
  !> is.
  pure subroutine corner_events(guide, y, g, g_rate)
    type(piston_guide_t), intent(in) :: guide
    real(dp), intent(in) :: y(:)
    real(dp), intent(out) :: g(n_corners), g_rate(n_corners)
    type(corner_t) :: corner(n_corners)
    call guide%look(y, corner)
    g = merge(-corner%depth, corner%depth, guide%touches)
    g_rate = merge(-corner%depth_rate, corner%depth_rate, guide%touches)
  end subroutine corner_events

  !> Change the state of corner i: its contact ends, or a new contact begins.
  pure subroutine change_contact(guide, i, y)
    type(piston_guide_t), intent(inout) :: guide
    integer, intent(in) :: i
    real(dp), intent(in) :: y(:)
    type(corner_t) :: corner(n_corners)
    if (guide%touches(i)) then
      guide%touches(i) = .false.
    else
      call guide%look(y, corner)
      call begin_corner_contact(guide, i, corner(i)%depth_rate)
    end if
  end subroutine change_contact

  !> Begin a contact of corner i with a penetration rate [m/s].
  pure subroutine begin_corner_contact(guide, i, rate)
    type(piston_guide_t), intent(inout) :: guide
    integer, intent(in) :: i
    real(dp), intent(in) :: rate
    guide%touches(i) = .true.
    guide%impact_speed(i) = max(rate, 0.0_dp)
  end subroutine begin_corner_contact

  !> Whether the force begins and ends with a power of the penetration that is not an integer.
  pure logical function contact_is_rough(guide)
    type(piston_guide_t), intent(in) :: guide
    contact_is_rough = guide%contact%geometry%three_halves > 0
  end function contact_is_rough

  !> Predicted end of the first of such contacts, of corners that are moving out of the wall; else the largest number.
  pure real(dp) function rough_corner_end(guide, t, y) result(t_end)
    type(piston_guide_t), intent(in) :: guide
    real(dp), intent(in) :: t, y(:)
    type(corner_t) :: corner(n_corners)
    integer :: i
    t_end = huge(t_end)
    if (.not. any(guide%touches)) return
    if (.not. contact_is_rough(guide)) return
    call guide%look(y, corner)
    do i = 1, n_corners
      if (guide%touches(i) .and. corner(i)%depth > 0 .and. corner(i)%depth_rate < 0) &
        t_end = min(t_end, t - corner(i)%depth/corner(i)%depth_rate)
    end do
  end function rough_corner_end

  !> Second derivative of the penetration of corner i [m/s^2].
  pure real(dp) function inward_acceleration(i, corner, motion, accelerations) result(a)
    integer, intent(in) :: i
    type(corner_t), intent(in) :: corner
    type(motion_t), intent(in) :: motion
    type(accelerations_t), intent(in) :: accelerations
    a = accelerations%offset + corner%from_com(1)*accelerations%tilt - corner%from_com(2)*motion%tilting%tilt_rate**2
    if (i > 2) a = -a
  end function inward_acceleration
end module guide_events
