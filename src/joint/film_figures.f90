!> Results of a film besides its force: moment, power, largest pressure, side flow. The right-hand side does not need them, and they
!> take additional evaluations; they are computed only on request.
module film_figures
  use gudgeon_kinds, only: dp
  use film_law, only: film_motion_t
  use joint_motion, only: joint_motion_t
  use clearance_joint, only: clearance_joint_t, joint_loads_t, phase_contact, phase_film
  use chain_loads, only: bearing_moment
  use mixed_film, only: motion_in_gap
  implicit none
  private
  public :: film_figures_t, film_figures_of, film_moment, acting_film

  type :: film_figures_t
    real(dp) :: power = 0         !! taken from the bodies by the film's force and by the moment of its shear, if that acts [W]
    real(dp) :: neglected_moment = 0   !! of the shear on the pin about its centre that does not act since the case neglects it [N m]
    real(dp) :: neglected_power = 0    !! that this moment would take from the bodies [W]
    real(dp) :: max_pressure = 0  !! [Pa]
    real(dp) :: side_flow = 0     !! out of both ends of the bearing [m^3/s]
  end type film_figures_t

contains

  !> Results of the film of a joint; all are 0 while the film does not act. If film and contact share the load, the film's results
  !> are multiplied by its share.
  pure type(film_figures_t) function film_figures_of(joint, motion, loads) result(figures)
    type(clearance_joint_t), intent(in) :: joint
    type(joint_motion_t), intent(in) :: motion
    type(joint_loads_t), intent(in) :: loads
    type(film_motion_t) :: seen
    real(dp) :: share, rate(2), moment
    call acting_film(joint, motion, seen, share)
    if (.not. share > 0) return
    rate = motion%eccentricity_rate
    if (allocated(joint%elastic)) rate = motion%film_rate   ! the elastic energy of the walls does not belong to the film
    moment = film_moment(joint, loads)
    figures%power = -(dot_product(loads%film, rate) + moment*motion%journal_speed &
      + bearing_moment(motion%eccentricity, loads%film, moment)*motion%bearing_speed)
    if (joint%film%neglects_shear()) then
      figures%neglected_moment = share*joint%film%drag_moment(seen, loads%film/share)
      figures%neglected_power = -figures%neglected_moment*(motion%journal_speed - motion%bearing_speed)
    end if
    if (.not. joint%film%gives_pressure()) return
    call joint%film%peak_and_flow(seen, figures%max_pressure, figures%side_flow)
    figures%max_pressure = share*figures%max_pressure
    figures%side_flow = film_share(joint, motion)*figures%side_flow
  end function film_figures_of

  !> The motion on which the film of a joint depends, and the share of the full film that acts.
  pure subroutine acting_film(joint, motion, seen, share)
    type(clearance_joint_t), intent(in) :: joint
    type(joint_motion_t), intent(in) :: motion
    type(film_motion_t), intent(out) :: seen
    real(dp), intent(out) :: share
    share = film_share(joint, motion)
    seen%eccentricity = motion%eccentricity
    seen%eccentricity_rate = motion%eccentricity_rate
    seen%pin_speed = motion%journal_speed + motion%bearing_speed
    seen%turning_speed = motion%journal_speed - motion%bearing_speed
    if (allocated(joint%asperities)) seen = motion_in_gap(joint%film, joint%asperities, seen)
    if (allocated(joint%transition)) seen = joint%transition%held_motion(seen)
    if (.not. allocated(joint%elastic)) return
    share = share*joint%elastic%thickening(joint%elastic%load(motion%eccentricity - motion%film_eccentricity))
    seen%eccentricity = motion%film_eccentricity
    seen%eccentricity_rate = motion%film_rate
  end subroutine acting_film

  !> Share of the full film that acts.
  pure real(dp) function film_share(joint, motion)
    type(clearance_joint_t), intent(in) :: joint
    type(joint_motion_t), intent(in) :: motion
    film_share = merge(1.0_dp, 0.0_dp, joint%phase == phase_film)
    if (.not. allocated(joint%transition) .or. joint%phase /= phase_contact) return
    if (.not. joint%transition%film_is_gone) film_share = 1 - joint%contact_weight(motion%penetration)
  end function film_share

  !> Moment on the journal [N m] from the shear of the film, if the case includes it; without the moment of friction.
  pure real(dp) function film_moment(joint, loads)
    type(clearance_joint_t), intent(in) :: joint
    type(joint_loads_t), intent(in) :: loads
    logical :: has_film
    has_film = joint%phase == phase_film
    if (allocated(joint%transition)) has_film = .not. joint%transition%film_is_gone
    film_moment = 0
    if (has_film) film_moment = loads%moment - loads%friction_force*joint%pin_radius
  end function film_moment
end module film_figures
