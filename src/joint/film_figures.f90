!> Results of the film of a load element besides its force: moment, power, largest pressure, side flow. The right-hand side does not
!> need them, and they take additional evaluations; they are computed only on request.
module film_figures
  use kinds, only: dp
  use trace_row, only: trace_row_t, largest, mean, integral, of_run
  use film_law, only: film_motion_t
  use joint_evaluation, only: joint_evaluation_t
  use load_element, only: load_element_t, power_of
  implicit none
  private
  public :: film_losses_t, film_losses_of, film_figures_t, film_figures_of, add_film_force, add_film_figures

  type :: film_losses_t
    real(dp) :: power = 0         !! taken from the bodies by the film's force and by the moment of its shear, if that acts [W]
    real(dp) :: neglected_moment = 0   !! of shear on the pin about its centre that does not act since the case neglects it [N m]
    real(dp) :: neglected_power = 0    !! that this moment would take from the bodies [W]
    real(dp) :: side_flow = 0     !! out of both ends of the bearing [m^3/s]
  end type film_losses_t

  type, extends(film_losses_t) :: film_figures_t
    real(dp) :: max_pressure = 0  !! [Pa]
  end type film_figures_t

contains

  !> Losses of a film; all are 0 while it does not act. If film and contact share the load, the film's results are multiplied by its
  !> share.
  pure type(film_losses_t) function film_losses_of(element, joint) result(losses)
    class(load_element_t), intent(in) :: element   !! with a film
    type(joint_evaluation_t), intent(in) :: joint
    type(film_motion_t) :: seen
    real(dp) :: rate(2), share, thickening
    call element%see_film(joint, seen, rate, share, thickening)
    if (.not. share > 0) return
    call add_losses(element, joint, seen, rate, share*thickening, losses)
    losses%side_flow = share*element%film%side_flow(seen)
  end function film_losses_of

  !> Results of a film, as `film_losses_of`.
  pure type(film_figures_t) function film_figures_of(element, joint) result(figures)
    class(load_element_t), intent(in) :: element   !! with a film
    type(joint_evaluation_t), intent(in) :: joint
    type(film_motion_t) :: seen
    real(dp) :: rate(2), share, thickening
    call element%see_film(joint, seen, rate, share, thickening)
    if (.not. share > 0) return
    call add_losses(element, joint, seen, rate, share*thickening, figures%film_losses_t)
    if (.not. element%film%gives_pressure()) return
    call element%film%peak_and_flow(seen, figures%max_pressure, figures%side_flow)
    figures%max_pressure = share*thickening*figures%max_pressure
    figures%side_flow = share*figures%side_flow
  end function film_figures_of

  !> Set power and neglected shear of a film that acts; `factor` is that of its pressures.
  pure subroutine add_losses(element, joint, seen, rate, factor, losses)
    class(load_element_t), intent(in) :: element
    type(joint_evaluation_t), intent(in) :: joint
    type(film_motion_t), intent(in) :: seen
    real(dp), intent(in) :: rate(2), factor
    type(film_losses_t), intent(inout) :: losses
    losses%power = -power_of(joint, joint%film, rate, element%film_moment(joint))
    if (.not. element%film%neglects_shear()) return
    losses%neglected_moment = factor*element%film%drag_moment(seen, joint%film/factor)
    losses%neglected_power = -losses%neglected_moment*(joint%pin_angular_speed - joint%bearing_speed)
  end subroutine add_losses

  !> Add the columns of the force of a film.
  pure subroutine add_film_force(joint, row)
    type(joint_evaluation_t), intent(in) :: joint
    type(trace_row_t), intent(inout) :: row
    call row%add('film_force_x[N]', joint%film(1), 'force of the oil film on the pin along x')
    call row%add('film_force_y[N]', joint%film(2), 'the same along y')
  end subroutine add_film_force

  !> Add the column of the film's moment, and those that need more computation than its force, which are computed only if the case
  !> names one.
  pure subroutine add_film_figures(element, joint, row)
    class(load_element_t), intent(in) :: element   !! with a film
    type(joint_evaluation_t), intent(in) :: joint
    type(trace_row_t), intent(inout) :: row
    type(film_figures_t) :: figures
    integer :: columns
    associate (film => element%film)
      if (film%film_moment) call row%add('film_moment[N.m]', element%film_moment(joint), &
        'moment of the oil shear on the pin about its centre, positive from x to y')
      columns = 1
      if (film%neglects_shear()) columns = columns + 2
      if (film%gives_pressure()) columns = columns + 1
      if (film%gives_side_flow()) columns = columns + 1
      if (row%wants(columns)) then
        figures = film_figures_of(element, joint)
      else if (.not. row%is_naming) then
        call row%skip(columns)
        return
      end if
      call row%add_on_request('film_power[W]', figures%power, &
        'power that the film takes from the bodies, by pressure and by shear that acts; < 0: it gives')
      if (element%is_reported) call row%keep('film_energy_lost', integral, &
        'energy that the film took from the bodies; negative: it gave energy, as an oscillating film may', told=of_run, unit='J', &
        is_sampled=.true.)
      if (film%neglects_shear()) then
        call row%add_on_request('neglected_shear_moment[N.m]', figures%neglected_moment, &
          'moment of the oil shear on the pin that does not act (film_moment = .false.)')
        call row%add_on_request('neglected_shear_power[W]', figures%neglected_power, &
          'power that this shear would take from the bodies')
        if (element%is_reported) call row%keep('neglected_shear_loss', integral, 'energy that the shear of the film would have '// &
          'taken; it does not act with `film_moment = .false.`', told=of_run, unit='J', is_sampled=.true.)
      end if
      if (film%gives_pressure()) then
        call row%add_on_request('max_film_pressure[Pa]', figures%max_pressure, 'largest pressure in the film')
        if (element%is_reported) call row%keep('max_film_pressure', largest, 'largest pressure in the film, with `report`', &
          is_sampled=.true., has_angle=.true.)
      end if
      if (film%gives_side_flow()) then
        call row%add_on_request('film_side_flow[m3/s]', figures%side_flow, 'oil flow out of both ends of the bearing')
        if (element%is_reported) call row%keep('mean_film_side_flow', mean, &
          'mean oil flow out of both ends of the bearing, with `report`', is_sampled=.true.)
      end if
    end associate
  end subroutine add_film_figures
end module film_figures
