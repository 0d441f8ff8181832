!> Derivatives of the loads of a joint with respect to the state, for implicit integration.
submodule (clearance_joint) joint_slopes
  implicit none

contains

  module procedure slopes
    real(dp) :: of_loads(3, 5 + n_film_states), of_rates(n_film_states, 5 + n_film_states)
    derivatives = 0
    if (self%phase == phase_contact) then
      if (allocated(self%transition)) then
        call weighted_slopes(self, self%film_motion(bodies, motion, joint), joint, derivatives)
      else
        call contact_slopes(self, joint, own, derivatives)
      end if
    end if
    if (self%phase /= phase_film) return
    if (allocated(self%transition)) then
      call self%transition%film_derivatives(self%film, self%film_motion(bodies, motion, joint), derivatives)
    else if (allocated(self%elastic)) then
      call self%elastic%slopes(self%film, self%elastic_film_motion(bodies, motion, joint), &
        joint%eccentricity - joint%film_eccentricity, self%film%film_moment, of_loads, of_rates)
      derivatives = of_loads(:, :5)
    else if (allocated(self%asperities)) then
      call mixed_derivatives(self%film, self%asperities, self%pin_radius, self%film_motion(bodies, motion, joint), derivatives)
    else
      call self%film%force_derivatives(self%film_motion(bodies, motion, joint), derivatives)
    end if
  end procedure slopes

  !> Derivatives for a contact and a film that share the load: those of both forces, weighted, and those of the weights.
  pure subroutine weighted_slopes(self, motion, joint, derivatives)
    type(clearance_joint_t), intent(in) :: self
    type(film_motion_t), intent(in) :: motion
    type(joint_motion_t), intent(in) :: joint
    real(dp), intent(out) :: derivatives(3, 5)
    type(joint_loads_t) :: full
    real(dp) :: w, slope, of_film(3, 5), change(3), force(2), moment, ratio
    real(dp) :: friction_slopes(1 + most_friction_states, 1 + most_friction_states)
    integer :: i
    ratio = 0
    if (allocated(self%friction)) call find_friction_slopes(self, joint, ratio, friction_slopes)
    full%normal_force = 0
    if (.not. self%force_is_lost) &
      full%normal_force = self%contact%normal_force(joint%penetration, joint%penetration_rate, self%impact_speed)
    full%friction_force = ratio*full%normal_force
    call contact_slopes(self, joint, full, derivatives)
    if (self%transition%film_is_gone) return
    call self%transition%weight(joint%penetration, w, slope)
    call self%film%film_force(self%transition%held_motion(motion), force, moment)
    call self%transition%film_derivatives(self%film, motion, of_film)
    associate (n => joint%normal, pressing => full%normal_force, friction => full%friction_force)
      change = [-pressing*n(1) - friction*n(2), friction*n(1) - pressing*n(2), friction*self%pin_radius] - [force, moment]
      derivatives = w*derivatives + (1 - w)*of_film
      do i = 1, 2
        derivatives(:, i) = derivatives(:, i) + slope*n(i)*change
      end do
    end associate
  end subroutine weighted_slopes

  pure subroutine contact_slopes(self, joint, own, derivatives)
    class(clearance_joint_t), intent(in) :: self
    type(joint_motion_t), intent(in) :: joint
    type(joint_loads_t), intent(in) :: own
    real(dp), intent(out) :: derivatives(3, 5)
    real(dp) :: stiffness, damping, ratio, ratio_slope, turn(5), depth(5), rate(5), normal(5), friction(5)
    real(dp) :: friction_slopes(1 + most_friction_states, 1 + most_friction_states)
    integer :: i

    associate (n => joint%normal)
      stiffness = 0
      damping = 0
      if (.not. self%force_is_lost) &
        call self%contact%normal_force_slopes(joint%penetration, joint%penetration_rate, self%impact_speed, stiffness, damping)
      ratio = 0
      ratio_slope = 0
      if (allocated(self%friction)) then
        call find_friction_slopes(self, joint, ratio, friction_slopes)
        ratio_slope = friction_slopes(1, 1)
      end if
      turn = [-n(2), n(1), 0.0_dp, 0.0_dp, 0.0_dp]/joint%distance
      depth = [n(1), n(2), 0.0_dp, 0.0_dp, 0.0_dp]
      rate = turn*joint%tangential_rate + [0.0_dp, 0.0_dp, n(1), n(2), 0.0_dp]
      normal = stiffness*depth + damping*rate
      friction = ratio*normal + ratio_slope*own%normal_force*sliding_gradient(self, joint)
      do i = 1, 5
        associate (along => -normal(i) - own%friction_force*turn(i), across => friction(i) - own%normal_force*turn(i))
          derivatives(:, i) = [along*n(1) - across*n(2), along*n(2) + across*n(1), self%pin_radius*friction(i)]
        end associate
      end do
    end associate
  end subroutine contact_slopes

  !> Derivatives of the sliding speed with respect to e_x, e_y, e_x', e_y' and the angular speed of the journal.
  pure function sliding_gradient(self, joint) result(gradient)
    type(clearance_joint_t), intent(in) :: self
    type(joint_motion_t), intent(in) :: joint
    real(dp) :: gradient(5)
    associate (n => joint%normal, turn_rate => joint%penetration_rate/joint%distance)
      gradient = [n(2)*turn_rate, -n(1)*turn_rate, -n(2), n(1), self%pin_radius]
    end associate
  end function sliding_gradient

  !> Ratio of friction to normal force, and derivatives of it (row 1) and of the rates of the states of the friction law (following
  !> rows) with respect to the sliding speed (column 1) and to these states (following columns).
  pure subroutine find_friction_slopes(self, joint, ratio, slopes)
    type(clearance_joint_t), intent(in) :: self
    type(joint_motion_t), intent(in) :: joint
    real(dp), intent(out) :: ratio, slopes(1 + most_friction_states, 1 + most_friction_states)
    real(dp) :: rates(most_friction_states)
    slopes = 0
    if (self%n_friction_states > 0) then
      call self%friction%state_friction(joint%sliding_speed, joint%friction_states, ratio, rates)
      call self%friction%state_slopes(joint%sliding_speed, joint%friction_states, slopes)
    else
      ratio = self%friction%friction_ratio(joint%sliding_speed, self%sliding)
      slopes(1, 1) = self%friction%friction_ratio_slope(joint%sliding_speed)
    end if
  end subroutine find_friction_slopes

  module procedure state_slopes
    real(dp) :: slopes(1 + most_friction_states, 1 + most_friction_states), ratio, of_loads(3, 5 + n_film_states)
    integer :: i
    by_states = 0
    of_rates = 0
    if (allocated(self%elastic)) then
      call self%elastic%slopes(self%film, self%elastic_film_motion(bodies, motion, joint), &
        joint%eccentricity - joint%film_eccentricity, self%film%film_moment, of_loads, of_rates)
      by_states = of_loads(:, 6:)
      return
    end if
    if (self%phase /= phase_contact .or. self%n_friction_states == 0) return
    call find_friction_slopes(self, joint, ratio, slopes)
    do i = 1, self%n_friction_states
      associate (n => joint%normal, force => own%normal_force*slopes(1, 1 + i))
        by_states(:, i) = [-n(2)*force, n(1)*force, self%pin_radius*force]
      end associate
      of_rates(i, :5) = slopes(1 + i, 1)*sliding_gradient(self, joint)
      of_rates(i, 6:5 + self%n_friction_states) = slopes(1 + i, 2:1 + self%n_friction_states)
    end do
  end procedure state_slopes
end submodule joint_slopes
