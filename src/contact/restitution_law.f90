!> Contact with a loss that is set by a coefficient of restitution.
!>
!> A free impact under F = f(delta) [1 + chi delta_dot/delta_dot_minus] gives back a share e* of its speed that depends on chi
!> alone, whatever the mass and the geometry: chi (1 + e*) = ln[(1 + chi)/(1 - chi e*)]. The laws differ in the chi that they take
!> for the coefficient e of the case, and so in how far e* is from e.
module restitution_law
  use gudgeon_kinds, only: dp
  use gudgeon_parameters, only: parameter_list_t
  use gudgeon_bearing, only: bearing_t
  use contact_law, only: contact_law_t
  implicit none
  private
  public :: restitution_law_t

  type, abstract, extends(contact_law_t) :: restitution_law_t
    real(dp) :: restitution = 1   !! e of the case [-], 0 to 1
  contains
    procedure :: parameters
    procedure :: prepare
    procedure(damping_for), deferred, nopass :: damping_for
  end type restitution_law_t

  abstract interface
    !> chi [-] for a coefficient of restitution, >= 0 and 0 for 1.
    pure function damping_for(restitution) result(damping)
      import :: dp
      real(dp), intent(in) :: restitution   !! e [-], 0 to 1
      real(dp) :: damping
    end function damping_for
  end interface

contains

  subroutine parameters(self, list)
    class(restitution_law_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call list%add('restitution', self%restitution, 'coefficient of restitution', range='>= 0 and <= 1', default='0.9')
    call list%add('least_impact_speed', self%least_impact_speed, 'slower impacts are damped as one of this speed', 'm/s', &
      '>= 1e-9 and <= 1', default='1.0e-5')
  end subroutine parameters

  subroutine prepare(self, bearing)
    class(restitution_law_t), intent(inout) :: self
    type(bearing_t), intent(in) :: bearing
    call self%prepare_geometry(bearing)
    self%damping = self%damping_for(self%restitution)
  end subroutine prepare
end module restitution_law
