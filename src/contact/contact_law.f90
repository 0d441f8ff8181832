!> What every normal contact law answers.
module contact_law
  use gudgeon_kinds, only: dp
  use gudgeon_parameters, only: law_t
  use gudgeon_bearing, only: bearing_t
  implicit none
  private
  public :: contact_law_t

  !> A compliant normal contact between pin and bearing.
  type, abstract, extends(law_t) :: contact_law_t
  contains
    procedure :: prepare => nothing_to_prepare
    procedure :: fastest_impact => any_speed
    procedure(normal_force), deferred :: normal_force
    procedure(normal_force_slopes), deferred :: normal_force_slopes
  end type contact_law_t

  abstract interface
    !> The pressing force [N] between pin and bearing, never negative (no adhesion).
    pure function normal_force(self, penetration, penetration_rate, impact_speed) result(force)
      import :: contact_law_t, dp
      class(contact_law_t), intent(in) :: self
      real(dp), value, intent(in) :: penetration       !! |e| - c [m]; the force is 0 where it is not positive
      real(dp), value, intent(in) :: penetration_rate  !! its rate [m/s], positive while the pin goes deeper
      real(dp), value, intent(in) :: impact_speed      !! penetration_rate at the instant contact began [m/s], >= 0
      real(dp) :: force
    end function normal_force

    !> Derivatives of the force by the penetration [N/m] and by its rate [N s/m], for implicit integration. The arguments are
    !> those of `normal_force`; where the force is 0 both are 0.
    pure subroutine normal_force_slopes(self, penetration, penetration_rate, impact_speed, stiffness, damping)
      import :: contact_law_t, dp
      class(contact_law_t), intent(in) :: self
      real(dp), intent(in) :: penetration, penetration_rate, impact_speed
      real(dp), intent(out) :: stiffness, damping
    end subroutine normal_force_slopes
  end interface

contains

  !> Find what follows from the parameters and the bearing, before the first force is asked for. The default has nothing to find.
  subroutine nothing_to_prepare(self, bearing)
    class(contact_law_t), intent(inout) :: self
    type(bearing_t), intent(in) :: bearing
    associate (unused_self => self, unused_bearing => bearing)
    end associate
  end subroutine nothing_to_prepare

  !> The fastest impact for which the law is meant [m/s]. The default is a law without such a limit.
  pure real(dp) function any_speed(self)
    class(contact_law_t), intent(in) :: self
    associate (unused_self => self)
    end associate
    any_speed = huge(any_speed)
  end function any_speed
end module contact_law
