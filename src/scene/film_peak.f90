!> Searches the largest pressure of a film between the points of a step at which it has been computed.
module film_peak
  use kinds, only: dp
  use ode_method, only: ode_method_t
  use scene_problem, only: scene_t, evaluation_t
  use inside_step, only: evaluate_inside
  use film_figures, only: film_figures_t
  use peak_search, only: sample_t, peak_search_t
  implicit none
  private
  public :: find_film_peak

contains

  !> Find the peak of the pressure from its values at increasing times inside the last step, if it may exceed `known` and the
  !> largest value. The value at the largest point is known; the search is between its neighbours. At an end of the interval the value a
  !> little inside decides whether the pressure rises from there.
  subroutine find_film_peak(method, scene, joint, t, pressure, known, evaluations, peak, angle)
    class(ode_method_t), intent(inout) :: method
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: joint               !! index in the scene
    real(dp), intent(in) :: t(:), pressure(:)  !! [s], [Pa]
    real(dp), intent(in) :: known              !! [Pa]
    integer, intent(inout) :: evaluations      !! of the scene so far
    real(dp), intent(out) :: peak, angle       !! [Pa] and the crank angle then [rad]; peak 0: not searched
    real(dp), parameter :: short = 1e-3_dp     !! fraction of the way to the neighbour
    type(peak_search_t) :: search
    real(dp) :: time, value
    logical :: is_done
    integer :: best, before, after
    peak = 0
    angle = 0
    best = maxloc(pressure, 1)
    before = max(best - 1, 1)
    after = min(best + 1, size(t))
    if (pressure(best) + max(pressure(best) - pressure(before), pressure(best) - pressure(after)) <= known) return
    call search%begin(sample_t(t(before), pressure(before), 0.0_dp), sample_t(t(after), pressure(after), 0.0_dp))
    if (best > before .and. best < after) then
      call search%add_value(t(best), pressure(best))
    else
      time = t(best) + short*(t(after + before - best) - t(best))
      value = pressure_at(time)
      if (.not. value > pressure(best)) return
      call search%add_value(time, value)
    end if
    do
      call search%next_time(time, is_done)
      if (is_done) exit
      call search%add_value(time, pressure_at(time))
    end do
    value = pressure_at(search%t(1), angle)
    peak = max(value, search%value(1))

  contains

    !> Largest pressure at a time inside the step [Pa]; 0 outside the model.
    real(dp) function pressure_at(time, crank_angle)
      real(dp), intent(in) :: time
      real(dp), intent(out), optional :: crank_angle
      type(evaluation_t) :: now
      type(film_figures_t) :: film
      real(dp) :: y(scene%n)
      logical :: in_domain
      pressure_at = 0
      call evaluate_inside(scene, method, time, y, now, in_domain, evaluations)
      if (present(crank_angle)) crank_angle = now%motion%crank_angle
      if (.not. in_domain) return
      film = scene%joints(joint)%film_figures(now%joint(joint))
      pressure_at = film%max_pressure
    end function pressure_at
  end subroutine find_film_peak
end module film_peak
