!> What every normal contact law answers.
module contact_law
  use kinds, only: dp
  implicit none
  private
  public :: contact_law_t

  !> A compliant normal contact between pin and bearing.
  type, abstract :: contact_law_t
  contains
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
end module contact_law
