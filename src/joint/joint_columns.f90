!> The columns of a joint with clearance. Columns of the piston pin have plain names, those of other places have a prefix.
module joint_columns
  use kinds, only: dp
  use trace_row, only: trace_row_t, least, largest, mean, changes, reversed, reversed_angle, impacts, of_run, of_cycle
  use chain_loads, only: force_size
  use joint_places, only: places, piston_pin, n_places, spot_prefix, place_of
  use joint_evaluation, only: joint_evaluation_t
  use clearance_joint, only: clearance_joint_t
  use joint_events, only: may_touch
  use archard_wear, only: of_pin, of_bore
  implicit none
  private
  public :: add_joint_columns, add_pin_force, add_rod_load

contains

  !> Add the columns of a joint and of its elements to a row.
  pure subroutine add_joint_columns(joint, now, row)
    type(clearance_joint_t), intent(in) :: joint
    type(joint_evaluation_t), intent(in) :: now
    type(trace_row_t), intent(inout) :: row
    integer :: first, gap, k
    row%place = spot_prefix(joint%spot)
    first = row%n + 1
    call row%add('eccentricity_x[m]', now%eccentricity(1), 'centre of the pin from the centre of its bearing, along x')
    call row%add('eccentricity_y[m]', now%eccentricity(2), 'the same along y')
    if (joint%place == piston_pin) then   ! whose trace has them on request alone
      call row%add_on_request('eccentricity_rate_x[m/s]', now%eccentricity_rate(1), 'rate of eccentricity_x')
      call row%add_on_request('eccentricity_rate_y[m/s]', now%eccentricity_rate(2), 'rate of eccentricity_y')
    else
      call row%add('eccentricity_rate_x[m/s]', now%eccentricity_rate(1), 'rate of eccentricity_x')
      call row%add('eccentricity_rate_y[m/s]', now%eccentricity_rate(2), 'rate of eccentricity_y')
    end if
    call row%add('eccentricity_ratio[-]', now%distance/joint%bearing%clearance, &
      'eccentricity over radial clearance; above 1 the pin penetrates the bearing')
    if (joint%has_own_gap) call row%keep('max_eccentricity_ratio', largest, 'largest eccentricity over the clearance')
    call row%add('film_thickness[m]', -now%penetration, &
      'smallest gap between pin and bearing; negative where the pin penetrates')
    gap = row%n
    call row%keep('min_film_thickness', least, 'smallest film thickness; negative: deepest penetration', &
      rate=-now%penetration_rate, is_of_contact=.true., has_angle=.true.)
    call row%add_on_request('closing_speed[m/s]', now%penetration_rate, 'speed at which this gap closes')
    if (may_touch(joint)) then
      call row%keep('max_impact_speed', largest, 'largest speed at which a contact began; 0: none began', at_impacts=.true., &
        has_angle=.true.)
      call row%keep('impacts', impacts, 'contacts that began', told=of_cycle, unit='1', at_impacts=.true.)
    end if
    call row%add('phase[-]', real(joint%phase, dp), 'what acts in the joint: 0 nothing (free flight), 1 the oil film, 2 contact')
    do k = 1, joint%n_elements
      call joint%slots(k)%element%add_columns(now, row)
    end do
    call add_pin_force(now%force, row)
    call row%keep('max_force', largest, 'largest force of the joint on the pin', told=of_cycle)
    if (joint%reports_film) call row%keep('mean_pin_force', mean, 'mean over time of the size of this force, with `report`', &
      is_sampled=.true.)
    if (allocated(joint%heat)) call row%add('film_temperature[K]', now%temperature, 'temperature of the film')
    if (allocated(joint%heat) .or. joint%thins()) call row%add_on_request('film_viscosity[Pa.s]', joint%viscosity(now), &
      'dynamic viscosity of the film at its temperature and rate of shear')
    if (allocated(joint%wear)) call add_wear(joint, now, row)
    row%place = ''
    if (joint%spot > n_places .and. row%is_naming) row%on_request([(k, k=first + 2, gap - 1), (k, k=gap + 1, row%n)]) = .true.
  end subroutine add_joint_columns

  !> Add the column of the size of the force [N] on a pin, which an ideal one may have too.
  pure subroutine add_pin_force(force, row)
    real(dp), intent(in) :: force(2)
    type(trace_row_t), intent(inout) :: row
    call row%add_on_request('pin_force[N]', force_size(force), 'size of the force of the joint on the pin')
    call row%keep('max_pin_force', largest, 'largest force of the joint on the pin', told=of_run)
  end subroutine add_pin_force

  !> Add the column of the force that a pin carries along the rod; `force` [N] is that of its joint on it.
  pure subroutine add_rod_load(spot, rod, force, row)
    integer, intent(in) :: spot    !! of the pin, at an end of the rod
    real(dp), intent(in) :: rod(2) !! cosine and sine of its angle
    real(dp), intent(in) :: force(2)
    type(trace_row_t), intent(inout) :: row
    row%place = spot_prefix(spot)
    call row%add_on_request('load_along_rod[N]', -places(place_of(spot))%sense*(force(1)*rod(1) - force(2)*rod(2)), &
      'force of the pin along the rod, positive where it presses on it')
    call row%keep('load_reversals', changes, 'changes of the sense of the load along the rod', told=of_cycle, unit='1')
    call row%keep('reversed_load', reversed, &
      'largest load along the rod in the sense opposite to that of the largest load; 0: it never reverses', told=of_cycle)
    call row%keep('degrees_under_reversed_load', reversed_angle, 'crank angle under such loads', told=of_cycle, unit='deg')
    row%place = ''
  end subroutine add_rod_load

  !> Add the volumes that wear in a second.
  pure subroutine add_wear(joint, now, row)
    type(clearance_joint_t), intent(in) :: joint
    type(joint_evaluation_t), intent(in) :: now
    type(trace_row_t), intent(inout) :: row
    real(dp) :: load
    load = 0
    if (row%wants(2)) load = joint%sliding_load(now)
    call row%add('pin_wear_rate[m3/s]', joint%wear%rate(of_pin)*load, 'volume that wears from the pin in a second')
    call row%add('bore_wear_rate[m3/s]', joint%wear%rate(of_bore)*load, 'volume that wears from the bore in a second')
  end subroutine add_wear
end module joint_columns
