!> Events of a piston with clearance in its bore: contacts of the corners of its skirt begin and end, and lose and regain
!> their forces.
module guide_events
  use kinds, only: dp
  use chain_motion, only: motion_t, accelerations_t
  use piston_guide, only: piston_guide_t, corner_t, n_corners
  implicit none
  private
  public :: n_guide_events, find_guide_events, corners_may_lose_force, corner_force_events, pass_guide_event, &
    find_lost_corner_forces, begin_corner_contact, contact_has_kink, corner_kink_time, inward_acceleration

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

  !> Event functions of a guide that has them, and their rates: the penetration of a corner [m] while it is not in contact, and
  !> minus the penetration while it is. Those that need the forces are -1 and 0 here.
  pure subroutine find_guide_events(guide, y, g, g_rate)
    type(piston_guide_t), intent(in) :: guide
    real(dp), intent(in) :: y(:)
    real(dp), intent(out) :: g(:), g_rate(:)
    type(corner_t) :: corner(n_corners)
    g = -1
    g_rate = 0
    call guide%find_contact_state(y, corner)
    g(:n_corners) = merge(-corner%depth, corner%depth, guide%touches)
    g_rate(:n_corners) = merge(-corner%depth_rate, corner%depth_rate, guide%touches)
  end subroutine find_guide_events

  !> Whether the forces of corners in contact may be lost.
  pure logical function corners_may_lose_force(guide)
    type(piston_guide_t), intent(in) :: guide
    corners_may_lose_force = n_guide_events(guide) > n_corners .and. any(guide%touches)
  end function corners_may_lose_force

  !> Event functions of a law whose damper may cancel the elastic force: a contact loses its force, or the force acts again.
  pure subroutine corner_force_events(guide, corner, motion, accelerations, g, g_rate)
    type(piston_guide_t), intent(in) :: guide
    type(corner_t), intent(in) :: corner(n_corners)
    type(motion_t), intent(in) :: motion
    type(accelerations_t), intent(in) :: accelerations
    real(dp), intent(inout) :: g(:), g_rate(:)   !! those of all events of the guide
    integer :: i
    do i = 1, n_corners
      associate (at => n_corners + i)
        call corner_share(guide, i, corner(i), motion, accelerations, g(at), g_rate(at))
        if (guide%force_is_lost(i)) cycle
        g(at) = -g(at)
        g_rate(at) = -g_rate(at)
      end associate
    end do
  end subroutine corner_force_events

  !> Find the corners in contact whose forces are lost, since they move out too fast.
  pure subroutine find_lost_corner_forces(guide, corner, motion, accelerations)
    type(piston_guide_t), intent(inout) :: guide
    type(corner_t), intent(in) :: corner(n_corners)
    type(motion_t), intent(in) :: motion
    type(accelerations_t), intent(in) :: accelerations
    real(dp) :: share, share_rate
    integer :: i
    do i = 1, n_corners
      call corner_share(guide, i, corner(i), motion, accelerations, share, share_rate)
      guide%force_is_lost(i) = share < 0
    end do
  end subroutine find_lost_corner_forces

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

  !> Pass an event: the contact of a corner begins or ends, or its force is lost or acts again. `enters`: a contact begins whose
  !> force has a kink there.
  pure subroutine pass_guide_event(guide, event, y, enters)
    type(piston_guide_t), intent(inout) :: guide
    integer, intent(in) :: event
    real(dp), intent(in) :: y(:)
    logical, intent(out) :: enters
    type(corner_t) :: corner(n_corners)
    enters = .false.
    if (event > n_corners) then
      guide%force_is_lost(event - n_corners) = .not. guide%force_is_lost(event - n_corners)
    else if (guide%touches(event)) then
      guide%touches(event) = .false.
      guide%force_is_lost(event) = .false.
    else
      call guide%find_contact_state(y, corner)
      call begin_corner_contact(guide, event, corner(event)%depth_rate)
      enters = contact_has_kink(guide)
    end if
  end subroutine pass_guide_event

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
