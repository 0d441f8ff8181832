!> The columns of a joint with clearance. Those of the piston pin have plain names, others the place in front.
module joint_columns
  use gudgeon_kinds, only: dp
  use trace_row, only: trace_row_t
  use chain_motion, only: piston_pin, name_prefix
  use joint_motion, only: joint_motion_t
  use clearance_joint, only: clearance_joint_t, joint_loads_t, phase_contact, phase_film
  implicit none
  private
  public :: put_joint_columns

contains

  !> Of what the case asks for: with a contact law its forces, with a film the film's.
  pure subroutine put_joint_columns(joint, motion, loads, row)
    type(clearance_joint_t), intent(in) :: joint
    type(joint_motion_t), intent(in) :: motion
    type(joint_loads_t), intent(in) :: loads
    type(trace_row_t), intent(inout) :: row
    if (joint%place /= piston_pin) row%place = name_prefix(joint%place)
    call row%put('eccentricity_x[m]', motion%eccentricity(1))
    call row%put('eccentricity_y[m]', motion%eccentricity(2))
    if (joint%place /= piston_pin) then   ! whose rates follow from crank, rod and piston only where the other pin is ideal
      call row%put('eccentricity_rate_x[m/s]', motion%eccentricity_rate(1))
      call row%put('eccentricity_rate_y[m/s]', motion%eccentricity_rate(2))
    end if
    call row%put('eccentricity_ratio[-]', motion%distance/joint%bearing%clearance)
    call row%put('film_thickness[m]', -motion%penetration)
    call row%put('phase[-]', real(joint%phase, dp))
    if (allocated(joint%contact)) then
      call row%put('normal_force[N]', loads%normal_force)
      call row%put('friction_force[N]', loads%friction_force)
      call row%put('sliding_speed[m/s]', motion%sliding_speed)
      call joint%contact%geometry%put_columns(merge(motion%penetration, 0.0_dp, joint%phase == phase_contact), &
        loads%normal_force, row)
      if (allocated(joint%friction)) call joint%friction%put_columns(motion%friction_states, row)
    end if
    if (allocated(joint%film)) then
      call row%put('film_force_x[N]', loads%film(1))
      call row%put('film_force_y[N]', loads%film(2))
      if (allocated(joint%transition)) call row%put('contact_weight[-]', joint%contact_weight(motion%penetration))
      if (allocated(joint%asperities)) then
        call row%put('asperity_force[N]', loads%normal_force)
        call row%put('friction_force[N]', loads%friction_force)
        call row%put('sliding_speed[m/s]', motion%sliding_speed)
      end if
      if (joint%film%film_moment) call row%put('film_moment[N.m]', film_moment(joint, loads))
    end if
    row%place = ''
  end subroutine put_joint_columns

  !> Moment of the film's shear on the journal [N m]: what friction has no part in.
  pure real(dp) function film_moment(joint, loads)
    type(clearance_joint_t), intent(in) :: joint
    type(joint_loads_t), intent(in) :: loads
    logical :: has_film
    has_film = joint%phase == phase_film
    if (allocated(joint%transition)) has_film = .not. joint%transition%film_is_gone
    film_moment = 0
    if (has_film) film_moment = loads%moment - loads%friction_force*joint%pin_radius
  end function film_moment
end module joint_columns
