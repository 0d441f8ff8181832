!> Pressure gradient and velocities inside an oscillating film, from which tests compute its force and its moment anew.
module oscillating_flow
  use kinds, only: dp
  use constants, only: two_pi
  use film_law, only: film_motion_t
  use oscillating_response, only: oscillating_response_t, film_phasors_t, inertia_function, max_eccentricity_ratio
  use oscillating_film, only: oscillating_film_t
  implicit none
  private
  public :: response_at, response_of, pressure_gradient, velocity

contains

  !> The response at an eccentricity ratio and Q = c^2 w/(4 nu).
  pure type(film_phasors_t) function response_at(response, eccentricity_ratio, q) result(phasors)
    type(oscillating_response_t), intent(in) :: response
    real(dp), intent(in) :: eccentricity_ratio   !! >= 0
    real(dp), intent(in) :: q                    !! >= 0
    real(dp) :: eps
    eps = min(eccentricity_ratio, max_eccentricity_ratio)
    call response%respond(eps**2, (1 - eps)*(1 + eps), q, phasors)
    phasors%pressure = two_pi*eps*phasors%pressure
    phasors%shear = two_pi*eps*phasors%shear
    phasors%moment = two_pi*phasors%moment
  end function response_at

  !> Response of a film to a unit surface speed.
  pure type(film_phasors_t) function response_of(film, motion) result(phasors)
    type(oscillating_film_t), intent(in) :: film
    type(film_motion_t), intent(in) :: motion
    phasors = response_at(film%response, min(norm2(motion%eccentricity)/film%clearance, film%largest_ratio), &
      film%inertia_scale*motion%frequency)
  end function response_of

  !> dP/dth [Pa] as a phasor, at the angle theta [rad] from the thinnest film (the direction of the eccentricity), positive from x
  !> to y. Its real part is the present gradient.
  pure complex(dp) function pressure_gradient(film, motion, theta) result(gradient)
    type(oscillating_film_t), intent(in) :: film
    type(film_motion_t), intent(in) :: motion
    real(dp), intent(in) :: theta
    complex(dp) :: speed
    speed = film%surface_speed(motion)
    gradient = driving_gradient(film, motion, theta)
    if (film%response%as_printed) gradient = gradient - film%viscosity/film%kinematic_viscosity &
      *film%pin_radius*motion%frequency*(0.0_dp, 1.0_dp)*speed
    gradient = gradient + film%viscosity/film%kinematic_viscosity*motion%frequency*film%arm_length*sin(theta)*speed
  end function pressure_gradient

  !> The part of dP/dth [Pa] that drives the flow.
  pure complex(dp) function driving_gradient(film, motion, theta) result(gradient)
    type(oscillating_film_t), intent(in) :: film
    type(film_motion_t), intent(in) :: motion
    real(dp), intent(in) :: theta
    complex(dp) :: inertia
    type(film_phasors_t) :: response
    real(dp) :: eta, v
    response = response_of(film, motion)
    eta = gap(film, motion, theta)/film%clearance
    v = film%inertia_scale*motion%frequency*eta**2
    inertia = inertia_function(v)
    gradient = 2*film%viscosity*film%pin_radius/film%clearance**2*film%surface_speed(motion) &
      *(eta*inertia - response%flow*(inertia + cmplx(0.0_dp, v, dp)))/eta**3
  end function driving_gradient

  !> Velocity along the film [m/s] as a phasor (5.1), at theta as above and at the relative height y/h above the pin's surface (0 at
  !> the pin, 1 at the bearing). With the local gap h, lambda = sqrt(i w/nu) and C(z) = sinh(z)/z, it is
  !> V = U (1 - y/h) C(lambda(h-y))/C(lambda h) - P' y(h-y)/(2 mu R) C(lambda y/2) C(lambda(h-y)/2)/cosh(lambda h/2).
  !> Limit: |lambda h| < 700.
  pure complex(dp) function velocity(film, motion, theta, height)
    type(oscillating_film_t), intent(in) :: film
    type(film_motion_t), intent(in) :: motion
    real(dp), intent(in) :: theta, height
    complex(dp) :: wave
    real(dp) :: h
    h = gap(film, motion, theta)
    wave = h*sqrt(motion%frequency/(2*film%kinematic_viscosity))*(1.0_dp, 1.0_dp)
    velocity = film%surface_speed(motion)*(1 - height)*sinhc(wave*(1 - height))/sinhc(wave) &
      - driving_gradient(film, motion, theta)*h**2*height*(1 - height)/(2*film%viscosity*film%pin_radius) &
      *sinhc(wave*height/2)*sinhc(wave*(1 - height)/2)/cosh(wave/2)
  end function velocity

  !> Thickness of the film [m], with the eccentricity limited as in the response.
  pure real(dp) function gap(film, motion, theta)
    type(oscillating_film_t), intent(in) :: film
    type(film_motion_t), intent(in) :: motion
    real(dp), intent(in) :: theta
    real(dp) :: eps
    eps = min(norm2(motion%eccentricity)/film%clearance, film%largest_ratio, max_eccentricity_ratio)
    gap = film%clearance*(1 - eps*cos(theta))
  end function gap

  !> sinh(z)/z.
  pure complex(dp) function sinhc(z)
    complex(dp), intent(in) :: z
    if (abs(z) < 1e-2_dp) then
      sinhc = 1 + z**2/6*(1 + z**2/20*(1 + z**2/42))
    else
      sinhc = sinh(z)/z
    end if
  end function sinhc
end module oscillating_flow
