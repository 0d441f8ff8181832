!> The columns of a joint with clearance. Columns of the piston pin have plain names, those of the crank pin have a prefix.
module joint_columns
  use gudgeon_kinds, only: dp
  use trace_row, only: trace_row_t
  use chain_motion, only: piston_pin, name_prefix
  use joint_motion, only: joint_motion_t
  use clearance_joint, only: clearance_joint_t, joint_loads_t, phase_contact
  use contact_arc, only: sliding_load
  use archard_wear, only: of_pin, of_bore
  use film_figures, only: film_figures_t, film_figures_of, film_moment
  implicit none
  private
  public :: put_joint_columns

contains

  !> Put the columns of a joint into a row: those of the forces only for the laws that the case names.
  pure subroutine put_joint_columns(joint, motion, loads, row)
    type(clearance_joint_t), intent(in) :: joint
    type(joint_motion_t), intent(in) :: motion
    type(joint_loads_t), intent(in) :: loads
    type(trace_row_t), intent(inout) :: row
    if (joint%place /= piston_pin) row%place = name_prefix(joint%place)
    call row%put('eccentricity_x[m]', motion%eccentricity(1), 'centre of the pin from the centre of its bearing, along x')
    call row%put('eccentricity_y[m]', motion%eccentricity(2), 'the same along y')
    if (joint%place /= piston_pin) then  ! not among the other columns
      call row%put('eccentricity_rate_x[m/s]', motion%eccentricity_rate(1), 'rate of eccentricity_x')
      call row%put('eccentricity_rate_y[m/s]', motion%eccentricity_rate(2), 'rate of eccentricity_y')
    end if
    call row%put('eccentricity_ratio[-]', motion%distance/joint%bearing%clearance, &
      'eccentricity over radial clearance; above 1 the pin penetrates the bearing')
    call row%put('film_thickness[m]', -motion%penetration, &
      'smallest gap between pin and bearing; negative where the pin penetrates')
    call row%put('phase[-]', real(joint%phase, dp), 'what acts in the joint: 0 nothing (free flight), 1 the oil film, 2 contact')
    if (allocated(joint%contact)) then
      call row%put('normal_force[N]', loads%normal_force, &
        'contact force along the line of centres, positive where it presses; 0 without contact')
      call put_friction(motion, loads, row)
      call joint%contact%geometry%put_columns(merge(motion%penetration, 0.0_dp, joint%phase == phase_contact), &
        loads%normal_force, row)
      if (allocated(joint%friction)) call joint%friction%put_columns(motion%friction_states, row)
    end if
    if (allocated(joint%film)) then
      call row%put('film_force_x[N]', loads%film(1), 'force of the oil film on the pin along x')
      call row%put('film_force_y[N]', loads%film(2), 'the same along y')
      if (allocated(joint%transition)) call row%put('contact_weight[-]', joint%contact_weight(motion%penetration), &
        'share of the contact in the load of a weighted transition: 0 film alone, 1 contact alone')
      if (allocated(joint%elastic)) call put_elastic_film(joint, motion, row)
      if (allocated(joint%asperities)) then
        call row%put('asperity_force[N]', loads%normal_force, &
          'contact force of the asperities along the line of centres, positive where it presses')
        call put_friction(motion, loads, row)
      end if
      if (joint%film%film_moment) call row%put('film_moment[N.m]', film_moment(joint, loads), &
        'moment of the oil shear on the pin about its centre, positive from x to y')
      call put_film_figures(joint, motion, loads, row)
    end if
    if (allocated(joint%wear)) call put_wear(joint, motion, loads, row)
    row%place = ''
  end subroutine put_joint_columns

  !> Friction, of a contact or of asperities.
  pure subroutine put_friction(motion, loads, row)
    type(joint_motion_t), intent(in) :: motion
    type(joint_loads_t), intent(in) :: loads
    type(trace_row_t), intent(inout) :: row
    call row%put('friction_force[N]', loads%friction_force, &
      'friction on the pin along the tangent t = (-n_y, n_x), n from the bearing centre to the pin centre')
    call row%put('sliding_speed[m/s]', motion%sliding_speed, &
      'velocity of the pin surface relative to the bearing along the same tangent')
  end subroutine put_friction

  !> Put the volumes that wear in a second.
  pure subroutine put_wear(joint, motion, loads, row)
    type(clearance_joint_t), intent(in) :: joint
    type(joint_motion_t), intent(in) :: motion
    type(joint_loads_t), intent(in) :: loads
    type(trace_row_t), intent(inout) :: row
    real(dp) :: load
    load = 0
    if (row%wants(2)) load = sliding_load(joint, motion, loads)
    call row%put('pin_wear_rate[m3/s]', joint%wear%rate(of_pin)*load, 'volume that wears from the pin in a second')
    call row%put('bore_wear_rate[m3/s]', joint%wear%rate(of_bore)*load, 'volume that wears from the bore in a second')
  end subroutine put_wear

  !> Put the columns of an elastic film: its own eccentricity, the deflection of its walls and their elastic energy.
  pure subroutine put_elastic_film(joint, motion, row)
    type(clearance_joint_t), intent(in) :: joint
    type(joint_motion_t), intent(in) :: motion
    type(trace_row_t), intent(inout) :: row
    real(dp) :: deflection(2), stored
    deflection = motion%eccentricity - motion%film_eccentricity
    call row%put('film_eccentricity_x[m]', motion%film_eccentricity(1), &
      'eccentricity of the film between elastic walls, along x: eccentricity less wall deflection')
    call row%put('film_eccentricity_y[m]', motion%film_eccentricity(2), 'the same along y')
    call row%put('wall_deflection[m]', norm2(deflection), 'elastic deflection of the bearing walls under the film')
    stored = 0
    if (row%wants(1)) stored = joint%elastic%energy(deflection)
    call row%put('wall_energy[J]', stored, 'elastic energy stored in the bearing walls')
  end subroutine put_elastic_film

  !> Put the columns of a film that need more computation than its force. Each is computed only if the case names it.
  pure subroutine put_film_figures(joint, motion, loads, row)
    type(clearance_joint_t), intent(in) :: joint
    type(joint_motion_t), intent(in) :: motion
    type(joint_loads_t), intent(in) :: loads
    type(trace_row_t), intent(inout) :: row
    type(film_figures_t) :: figures
    integer :: columns
    columns = 1
    if (joint%film%neglects_shear()) columns = columns + 2
    if (joint%film%gives_pressure()) columns = columns + 1
    if (joint%film%gives_side_flow()) columns = columns + 1
    if (row%wants(columns)) then
      figures = film_figures_of(joint, motion, loads)
    else if (.not. row%is_naming) then
      call row%skip(columns)
      return
    end if
    call row%put_on_request('film_power[W]', figures%power, &
      'power that the film takes from the bodies, by pressure and by shear that acts; < 0: it gives')
    if (joint%film%neglects_shear()) then
      call row%put_on_request('neglected_shear_moment[N.m]', figures%neglected_moment, &
        'moment of the oil shear on the pin that does not act (film_moment = .false.)')
      call row%put_on_request('neglected_shear_power[W]', figures%neglected_power, &
        'power that this shear would take from the bodies')
    end if
    if (joint%film%gives_pressure()) call row%put_on_request('max_film_pressure[Pa]', figures%max_pressure, &
      'largest pressure in the film')
    if (joint%film%gives_side_flow()) call row%put_on_request('film_side_flow[m3/s]', figures%side_flow, &
      'oil flow out of both ends of the bearing')
  end subroutine put_film_figures
end module joint_columns
