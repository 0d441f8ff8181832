!> Transition from film to contact: sudden when pin and bearing touch, or weighted over a range of penetrations (proposed in
!> chapter 7 of Reis 2013; weights after Flores et al. 2004).
!>
!> With the penetration d = |e| - c the total force is (1 - w) F_film + w F_contact, friction included, where w = s or s^2 (3 - 2
!> s), and s = d/e0 is limited to 0 to 1. The theoretical film force is infinite at |e| = c; beyond |e| = (1 - q) c the force at
!> this eccentricity is used, with the actual direction and rate of the eccentricity. The depth e0 and q are not properties of the
!> joint: results depend on them.
module film_transition
  use kinds, only: dp
  use model_parameters, only: has_parameters_t, parameter_list_t
  use bearing_size, only: bearing_t
  use film_law, only: film_law_t, film_motion_t
  implicit none
  private
  public :: film_transition_t

  !> A transition. Whether the eccentricity is beyond a kink is a discrete state that the procedures are told, so that forces are
  !> smooth between two events, even for trial states beyond a kink.
  type, extends(has_parameters_t) :: film_transition_t
    character(len=:), allocatable :: transition   !! switch or weighted
    character(len=:), allocatable :: shape        !! linear or smooth
    real(dp) :: depth = 0                         !! e0 [m], > 0 for a weighted transition
    logical :: is_smooth = .false.                !! the shape is smooth
    real(dp) :: film_reach = 0                    !! (1 - q) c, eccentricity beyond which the film force is held [m]
    real(dp) :: contact_reach = 0                 !! c + e0, eccentricity beyond which the film does not act [m]
  contains
    procedure :: parameters
    procedure :: is_weighted
    procedure :: prepare
    procedure :: weight
    procedure :: held_motion
    procedure :: film_derivatives
  end type film_transition_t

contains

  subroutine parameters(self, list)
    class(film_transition_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call list%word('transition', self%transition, 'switch, weighted', 'switch', &
      'from film to contact; switch: at the clearance; weighted: both share the load over transition_depth')
    call list%add('transition_depth', self%depth, &
      'weighted: penetration above which the contact alone carries the load', 'm', '> 0', &
      default='0.0', usual='1e-9 to 1e-4')
    call list%word('transition_shape', self%shape, 'linear, smooth', 'linear', &
      'weighted: growth of the share of the contact with the penetration')
  end subroutine parameters

  pure logical function is_weighted(self)
    class(film_transition_t), intent(in) :: self
    is_weighted = .false.
    if (allocated(self%transition)) is_weighted = self%transition == 'weighted'
  end function is_weighted

  !> Find the kinks for a bearing.
  subroutine prepare(self, bearing, least_film_ratio)
    class(film_transition_t), intent(inout) :: self
    type(bearing_t), intent(in) :: bearing
    real(dp), intent(in) :: least_film_ratio   !! q [-]
    self%is_smooth = self%shape == 'smooth'
    self%film_reach = (1 - least_film_ratio)*bearing%clearance
    self%contact_reach = bearing%clearance + self%depth
  end subroutine prepare

  !> Share w of the contact at a penetration [m], and its derivative [1/m]. A linear share continues beyond its ends for trial
  !> states, since its kinks are events. The smooth share is constant beyond its ends, where its derivative has no jump.
  pure subroutine weight(self, penetration, film_is_gone, w, slope)
    class(film_transition_t), intent(in) :: self
    real(dp), intent(in) :: penetration
    logical, intent(in) :: film_is_gone   !! the eccentricity is beyond contact_reach
    real(dp), intent(out) :: w
    real(dp), intent(out), optional :: slope
    real(dp) :: s, w_slope
    s = penetration/self%depth
    w = 1
    w_slope = 0
    if (.not. film_is_gone) then
      w = s
      w_slope = 1/self%depth
      if (self%is_smooth) then
        s = min(max(s, 0.0_dp), 1.0_dp)
        w = s**2*(3 - 2*s)
        w_slope = 6*s*(1 - s)/self%depth
      end if
    end if
    if (present(slope)) slope = w_slope
  end subroutine weight

  !> Derivatives of the film force in the form of those of a film law: a held film rotates with the eccentricity and does not depend
  !> on its magnitude.
  pure subroutine film_derivatives(self, film, motion, is_held, derivatives)
    class(film_transition_t), intent(in) :: self
    class(film_law_t), intent(in) :: film
    type(film_motion_t), intent(in) :: motion
    logical, intent(in) :: is_held        !! the eccentricity is beyond film_reach
    real(dp), intent(out) :: derivatives(3, 5)
    real(dp) :: distance, along(3)
    call film%force_derivatives(self%held_motion(motion, is_held), derivatives)
    if (.not. is_held) return
    associate (e => motion%eccentricity)
      distance = norm2(e)
      along = (derivatives(:, 2)*e(1) - derivatives(:, 1)*e(2))*self%film_reach/distance**3
      derivatives(:, 1) = -along*e(2)
      derivatives(:, 2) = along*e(1)
    end associate
  end subroutine film_derivatives

  !> The motion on which the force of the full film depends, which is held where it would grow without bound.
  pure type(film_motion_t) function held_motion(self, motion, is_held) result(held)
    class(film_transition_t), intent(in) :: self
    type(film_motion_t), intent(in) :: motion
    logical, intent(in) :: is_held
    held = motion
    if (is_held) held%eccentricity = motion%eccentricity*(self%film_reach/norm2(motion%eccentricity))
  end function held_motion
end module film_transition
