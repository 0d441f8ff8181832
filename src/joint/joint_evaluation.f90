!> A joint in one evaluation of a scene: the relative motion of pin and bearing (Reis 2013, 3.70-3.78), and the loads.
module joint_evaluation
  use kinds, only: dp
  implicit none
  private
  public :: joint_evaluation_t, joint_rates_t, most_element_states, clear_loads
  public :: find_polar, find_sliding, sliding_acceleration, outward_acceleration, reach_event

  integer, parameter :: most_element_states = 2   !! largest number of states of a load element

  !> Motion and loads of a joint. The right-hand side sets only the components that it needs.
  type :: joint_evaluation_t
    real(dp) :: eccentricity(2)       !! e, from the centre of the bearing to the centre of the pin [m]
    real(dp) :: eccentricity_rate(2)  !! [m/s]
    real(dp) :: pin_angular_speed         !! angular speeds of both bodies, positive from x to y [rad/s]
    real(dp) :: bearing_speed
    real(dp) :: normal(2)             !! n = e/|e|, (1, 0) at e = 0; the tangent is t = (-n_y, n_x)
    real(dp) :: distance              !! |e| [m]
    real(dp) :: penetration           !! |e| - c [m], negative without contact
    real(dp) :: penetration_rate      !! n . e' [m/s]
    real(dp) :: tangential_rate       !! t . e' [m/s]
    real(dp) :: sliding_speed         !! v_T, of the pin's surface relative to the bearing's [m/s]
    logical :: touches                !! the joint is in contact
    real(dp) :: impact_speed          !! penetration rate at the beginning of this contact [m/s]
    ! motion of an ideal mechanism at (q, q'), set only for a film that needs it
    real(dp) :: ideal_speed           !! sum of the angular speeds of pin and bearing [rad/s]
    real(dp) :: ideal_acceleration    !! its rate at constant crank speed [rad/s^2]
    real(dp) :: frequency             !! |q'| [rad/s]
    ! the film
    real(dp) :: temperature           !! of a film that heats up [K]
    real(dp) :: viscosity_ratio       !! of its viscosity to that which its law was prepared for [-]
    ! of a numbered bearing (`joint_places`)
    real(dp) :: pin_angle             !! by which the pin has turned [rad]
    real(dp) :: rod(2)                !! cosine and sine of the angle A of the rod that holds the bearing; 1, 0: the frame
    ! loads on the pin; the opposite forces act on the bearing
    real(dp) :: force(2)              !! of all kinds [N]
    real(dp) :: moment                !! of all kinds, about the pin's centre, positive from x to y [N m]
    real(dp) :: power                 !! of all kinds, on the bodies [W]
    real(dp) :: contact(2)            !! force of contact and friction [N]
    real(dp) :: film(2)               !! force of the film [N]
    real(dp) :: normal_force          !! normal force of the contact, positive in compression [N]
    real(dp) :: friction_force        !! friction force along the tangent t [N]
    logical :: sticks  !! set-valued friction holds the surfaces together: its force follows from the accelerations
    ! of the element that acts, if it has any
    real(dp) :: states(most_element_states)
    real(dp) :: rates(most_element_states)   !! of these states
  end type joint_evaluation_t

  !> Accelerations of pin and bearing relative to each other.
  type :: joint_rates_t
    real(dp) :: eccentricity(2)       !! e'' [m/s^2]
    real(dp) :: pin, bearing      !! angular accelerations [rad/s^2]
  end type joint_rates_t

contains

  !> Set all loads to 0, and the viscosity of a film to that of its law.
  pure subroutine clear_loads(joint)
    type(joint_evaluation_t), intent(inout) :: joint
    joint%viscosity_ratio = 1
    joint%force = 0
    joint%moment = 0
    joint%power = 0
    joint%contact = 0
    joint%film = 0
    joint%normal_force = 0
    joint%friction_force = 0
    joint%sticks = .false.
    joint%states = 0
    joint%rates = 0
  end subroutine clear_loads

  !> Compute distance, normal, penetration and the components of the rate from the eccentricity and its rate.
  pure subroutine find_polar(clearance, joint)
    real(dp), intent(in) :: clearance   !! [m]
    type(joint_evaluation_t), intent(inout) :: joint
    associate (e => joint%eccentricity, rate => joint%eccentricity_rate, n => joint%normal)
      joint%distance = sqrt(e(1)**2 + e(2)**2)
      if (joint%distance > 0) then
        n = e*(1/joint%distance)
      else
        n = [1.0_dp, 0.0_dp]
      end if
      joint%penetration = joint%distance - clearance
      joint%penetration_rate = n(1)*rate(1) + n(2)*rate(2)
      joint%tangential_rate = n(1)*rate(2) - n(2)*rate(1)
    end associate
  end subroutine find_polar

  !> Sliding speed v_T = t . e' + omega_pin R - omega_bearing (|e| + R), with the pin's radius R: the relative velocity of
  !> the material points in contact. Equations (3.74)-(3.76) as printed let the contact points rotate with the eccentricity, so that
  !> no sliding remains.
  pure subroutine find_sliding(pin_radius, joint)
    real(dp), intent(in) :: pin_radius   !! [m]
    type(joint_evaluation_t), intent(inout) :: joint
    joint%sliding_speed = joint%tangential_rate + joint%pin_angular_speed*pin_radius &
      - joint%bearing_speed*(joint%distance + pin_radius)
  end subroutine find_sliding

  !> Rate of the sliding speed, v_T' [m/s^2] = t . e'' - gamma' n . e' + omega_pin' R - omega_bearing' (|e| + R) - omega_bearing
  !> |e|', with gamma' = t . e'/|e|. With `at_rest` only the terms with accelerations are included.
  pure real(dp) function sliding_acceleration(pin_radius, joint, rates, at_rest) result(a)
    real(dp), intent(in) :: pin_radius
    type(joint_evaluation_t), intent(in) :: joint
    type(joint_rates_t), intent(in) :: rates
    logical, intent(in) :: at_rest
    associate (n => joint%normal, pin => rates%eccentricity)
      a = n(1)*pin(2) - n(2)*pin(1)
      if (.not. at_rest) a = a - joint%tangential_rate*joint%penetration_rate/joint%distance &
        - joint%bearing_speed*joint%penetration_rate
      a = a + rates%pin*pin_radius - rates%bearing*(joint%distance + pin_radius)
    end associate
  end function sliding_acceleration

  !> Half the difference of e . e from its value at an eccentricity [m^2], which is smooth in every state, and its rate, with the
  !> sign that makes the next passage one from negative to positive.
  pure subroutine reach_event(joint, reach, is_beyond, g, g_rate)
    type(joint_evaluation_t), intent(in) :: joint
    real(dp), intent(in) :: reach       !! [m]
    logical, intent(in) :: is_beyond    !! the eccentricity is the larger one
    real(dp), intent(out) :: g, g_rate
    associate (e => joint%eccentricity, rate => joint%eccentricity_rate)
      g = 0.5_dp*(e(1)**2 + e(2)**2 - reach**2)
      g_rate = e(1)*rate(1) + e(2)*rate(2)
      if (.not. is_beyond) return
      g = -g
      g_rate = -g_rate
    end associate
  end subroutine reach_event

  !> d2|e|/dt2 [m/s^2].
  pure real(dp) function outward_acceleration(joint, rates)
    type(joint_evaluation_t), intent(in) :: joint
    type(joint_rates_t), intent(in) :: rates
    outward_acceleration = dot_product(joint%normal, rates%eccentricity) + joint%tangential_rate**2/joint%distance
  end function outward_acceleration
end module joint_evaluation
