!> Load element: an oil film between smooth, rigid surfaces that do not touch.
module oil_film
  use kinds, only: dp
  use trace_row, only: trace_row_t
  use film_law, only: film_law_t, film_motion_t
  use film_mobility, only: driven_velocity
  use joint_case, only: joint_case_t
  use joint_evaluation, only: joint_evaluation_t, most_element_states
  use load_element, only: load_element_t, n_slopes, n_motions, by_pin_speed, by_bearing_speed
  use film_figures, only: add_film_force, add_film_figures
  implicit none
  private
  public :: oil_film_t, film_motion_of, add_bearing_speed, unit_drag

  type, extends(load_element_t) :: oil_film_t
  contains
    procedure :: prepare => prepare_film_alone
    procedure :: find_loads
    procedure :: find_slopes
    procedure :: add_columns
    procedure :: see_film
    procedure :: carry
  end type oil_film_t

contains

  subroutine prepare_film_alone(self, wanted, tolerance, makes_tables)
    class(oil_film_t), intent(inout) :: self
    type(joint_case_t), intent(in) :: wanted
    real(dp), intent(in) :: tolerance
    logical, intent(in) :: makes_tables
    call self%prepare_film(wanted, tolerance, makes_tables)
  end subroutine prepare_film_alone

  pure subroutine find_loads(self, y, joint)
    class(oil_film_t), intent(in) :: self
    real(dp), intent(in) :: y(*)
    type(joint_evaluation_t), intent(inout) :: joint
    call self%film%loads(film_motion_of(self%film, joint), joint%viscosity_ratio, joint%film, joint%moment)
    joint%force = joint%film
  end subroutine find_loads

  !> The motion on which a film depends: it is entrained with the sum of the angular speeds of both surfaces.
  pure type(film_motion_t) function film_motion_of(film, joint) result(seen)
    class(film_law_t), intent(in) :: film
    type(joint_evaluation_t), intent(in) :: joint
    seen%eccentricity = joint%eccentricity
    seen%eccentricity_rate = joint%eccentricity_rate
    seen%pin_speed = joint%pin_angular_speed + joint%bearing_speed
    seen%turning_speed = joint%pin_angular_speed - joint%bearing_speed
    if (.not. film%needs_ideal_motion) return
    seen%ideal_pin_speed = joint%ideal_speed
    seen%ideal_pin_acceleration = joint%ideal_acceleration
    seen%frequency = joint%frequency
  end function film_motion_of

  pure subroutine find_slopes(self, joint, of_loads, of_rates)
    class(oil_film_t), intent(in) :: self
    type(joint_evaluation_t), intent(in) :: joint
    real(dp), intent(out) :: of_loads(3, n_slopes), of_rates(most_element_states, n_slopes)
    of_loads = 0
    of_rates = 0
    associate (seen => film_motion_of(self%film, joint))
      call self%film%force_derivatives(seen, of_loads(:, :by_pin_speed))
      call add_bearing_speed(self%film, seen, of_loads)
      call self%film%load_slopes(seen, joint%viscosity_ratio, of_loads(:, :n_motions))
    end associate
  end subroutine find_slopes

  !> Add the derivatives with respect to the angular speed of the bearing to those of a film law: it entrains the film as that of
  !> the pin does, and shears it the other way.
  pure subroutine add_bearing_speed(film, seen, of_loads)
    class(film_law_t), intent(in) :: film
    type(film_motion_t), intent(in) :: seen
    real(dp), intent(inout) :: of_loads(3, n_slopes)
    of_loads(:, by_bearing_speed) = of_loads(:, by_pin_speed)
    if (film%film_moment) of_loads(3, by_bearing_speed) = of_loads(3, by_bearing_speed) - 2*unit_drag(film, seen)
  end subroutine add_bearing_speed

  !> Moment of a film on the pin at the unit of angular speed relative to the bearing [N m s].
  pure real(dp) function unit_drag(film, seen)
    class(film_law_t), intent(in) :: film
    type(film_motion_t), intent(in) :: seen
    type(film_motion_t) :: turning
    turning = seen
    turning%turning_speed = 1
    unit_drag = film%drag_moment(turning, [0.0_dp, 0.0_dp])
  end function unit_drag

  !> e' = v*(e, load) + (omega/2) z x e.
  pure subroutine carry(self, place, load, joint)
    class(oil_film_t), intent(in) :: self
    real(dp), intent(in) :: place(2), load(2)
    type(joint_evaluation_t), intent(inout) :: joint
    type(film_motion_t) :: seen
    real(dp) :: drawn, velocity(2), factor
    drawn = 0.5_dp*(joint%pin_angular_speed + joint%bearing_speed)
    joint%eccentricity = place
    seen = film_motion_of(self%film, joint)   ! its rate is not known, and not used
    factor = joint%viscosity_ratio*self%film%thinning(seen)
    call driven_velocity(self%film, place, load/factor, velocity)
    joint%eccentricity_rate = velocity + drawn*[-place(2), place(1)]
    joint%film = -load
    joint%force = -load
    joint%moment = 0
    if (self%film%film_moment) joint%moment = factor*self%film%drag_moment(seen, joint%film/factor)
  end subroutine carry

  pure subroutine add_columns(self, joint, row)
    class(oil_film_t), intent(in) :: self
    type(joint_evaluation_t), intent(in) :: joint
    type(trace_row_t), intent(inout) :: row
    call add_film_force(joint, row)
    call add_film_figures(self, joint, row)
  end subroutine add_columns

  pure subroutine see_film(self, joint, seen, rate, share, thickening)
    class(oil_film_t), intent(in) :: self
    type(joint_evaluation_t), intent(in) :: joint
    type(film_motion_t), intent(out) :: seen
    real(dp), intent(out) :: rate(2), share, thickening
    seen = film_motion_of(self%film, joint)
    rate = joint%eccentricity_rate
    share = merge(0.0_dp, 1.0_dp, joint%touches)
    thickening = joint%viscosity_ratio*self%film%thinning(seen)
  end subroutine see_film
end module oil_film
