!> Events of a piston with clearance in its bore: contacts of the corners of its skirt begin and end, and lose and regain
!> their forces.
module guide_events
  use kinds, only: dp
  use chain_motion, only: motion_t, accelerations_t
  use piston_guide, only: piston_guide_t, corner_t, n_corners
  implicit none
  private
  public :: n_guide_events, corner_events, corner_force_events, corner_share, change_contact, begin_corner_contact, &
    contact_has_kink, corner_kink_time, inward_acceleration

contains

  !> Number of events: of the contacts of the corners and, if the damper of the contact law may cancel the elastic force, of their
  !> forces.
  pure integer function n_guide_events(guide)
    type(piston_guide_t), intent(in) :: guide
    n_guide_events = 0
    if (guide%touching == 0) return
    n_guide_events = n_corners
    if (guide%slots(guide%touching)%element%contact%may_lose_force) n_guide_events = 2*n_corners
  end function n_guide_events

  !> Event functions and their rates: the penetration of a corner [m] while it is not in contact, and minus the penetration while it
  !> is.
  pure subroutine corner_events(guide, y, g, g_rate)
    type(piston_guide_t), intent(in) :: guide
    real(dp), intent(in) :: y(:)
    real(dp), intent(out) :: g(n_corners), g_rate(n_corners)
    type(corner_t) :: corner(n_corners)
    call guide%find_contact_state(y, corner)
    g = merge(-corner%depth, corner%depth, guide%touches)
    g_rate = merge(-corner%depth_rate, corner%depth_rate, guide%touches)
  end subroutine corner_events

  !> Event functions of a law whose damper may cancel the elastic force: a contact loses its force, or the force acts again.
  pure subroutine corner_force_events(guide, corner, motion, accelerations, g, g_rate)
    type(piston_guide_t), intent(in) :: guide
    type(corner_t), intent(in) :: corner(n_corners)
    type(motion_t), intent(in) :: motion
    type(accelerations_t), intent(in) :: accelerations
    real(dp), intent(out) :: g(n_corners), g_rate(n_corners)
    integer :: i
    do i = 1, n_corners
      call corner_share(guide, i, corner(i), motion, accelerations, g(i), g_rate(i))
      if (guide%force_is_lost(i)) cycle
      g(i) = -g(i)
      g_rate(i) = -g_rate(i)
    end do
  end subroutine corner_force_events

  !> The damped over the elastic force of corner i, without the limit 0, and its rate [1/s]; 1 and 0 without contact.
  pure subroutine corner_share(guide, i, corner, motion, accelerations, share, share_rate)
    type(piston_guide_t), intent(in) :: guide
    integer, intent(in) :: i
    type(corner_t), intent(in) :: corner
    type(motion_t), intent(in) :: motion
    type(accelerations_t), intent(in) :: accelerations
    real(dp), intent(out) :: share, share_rate
    share = 1
    share_rate = 0
    if (guide%touches(i)) call guide%slots(guide%touching)%element%contact%find_share(corner%depth, corner%depth_rate, &
      inward_acceleration(i, corner, motion, accelerations), share, share_rate)
  end subroutine corner_share

  !> Change the state of corner i: its contact ends, or a new contact begins.
  pure subroutine change_contact(guide, i, y)
    type(piston_guide_t), intent(inout) :: guide
    integer, intent(in) :: i
    real(dp), intent(in) :: y(:)
    type(corner_t) :: corner(n_corners)
    if (guide%touches(i)) then
      guide%touches(i) = .false.
      guide%force_is_lost(i) = .false.
    else
      call guide%find_contact_state(y, corner)
      call begin_corner_contact(guide, i, corner(i)%depth_rate)
    end if
  end subroutine change_contact

  !> Begin a contact of corner i with a penetration rate [m/s].
  pure subroutine begin_corner_contact(guide, i, rate)
    type(piston_guide_t), intent(inout) :: guide
    integer, intent(in) :: i
    real(dp), intent(in) :: rate
    guide%touches(i) = .true.
    guide%force_is_lost(i) = .false.
    guide%impact_speed(i) = max(rate, 0.0_dp)
  end subroutine begin_corner_contact

  !> Whether the force begins and ends with a power of the penetration that is not an integer.
  pure logical function contact_has_kink(guide)
    type(piston_guide_t), intent(in) :: guide
    contact_has_kink = guide%slots(guide%touching)%element%contact%geometry%three_halves > 0
  end function contact_has_kink

  !> Predicted end of the first of such contacts, of corners that are moving out of the wall; else the largest number.
  pure real(dp) function corner_kink_time(guide, t, y) result(t_end)
    type(piston_guide_t), intent(in) :: guide
    real(dp), intent(in) :: t, y(:)
    type(corner_t) :: corner(n_corners)
    integer :: i
    t_end = huge(t_end)
    if (.not. any(guide%touches)) return
    if (.not. contact_has_kink(guide)) return
    call guide%find_contact_state(y, corner)
    do i = 1, n_corners
      if (guide%touches(i) .and. corner(i)%depth > 0 .and. corner(i)%depth_rate < 0) &
        t_end = min(t_end, t - corner(i)%depth/corner(i)%depth_rate)
    end do
  end function corner_kink_time

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
