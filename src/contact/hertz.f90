!> Hertz contact (4.1): an elastic force, without loss.
module hertz
  use kinds, only: dp
  use contact_law, only: contact_law_t
  implicit none
  private
  public :: hertz_t

  !> F = K delta^n, a pure function of the penetration.
  type, extends(contact_law_t) :: hertz_t
    real(dp) :: stiffness = 0          !! K [N/m^n], > 0
    real(dp) :: exponent = 1.5_dp      !! n [-], >= 1
    logical :: is_three_halves = .true. !! n is 3/2, which a square root answers; set by `set_elastic_part`
  contains
    procedure :: normal_force
    procedure :: normal_force_slopes
    procedure, non_overridable :: elastic_force
    procedure, non_overridable :: set_elastic_part
  end type hertz_t

contains

  pure subroutine set_elastic_part(self, stiffness, exponent)
    class(hertz_t), intent(inout) :: self
    real(dp), intent(in) :: stiffness   !! K [N/m^n]
    real(dp), intent(in) :: exponent    !! n [-]
    self%stiffness = stiffness
    self%exponent = exponent
    self%is_three_halves = abs(exponent - 1.5_dp) <= 0
  end subroutine set_elastic_part

  !> K delta^n [N], 0 where the pin does not penetrate.
  pure function elastic_force(self, penetration) result(force)
    class(hertz_t), intent(in) :: self
    real(dp), intent(in) :: penetration   !! delta [m]
    real(dp) :: force
    if (penetration <= 0) then
      force = 0
    else if (self%is_three_halves) then
      force = self%stiffness*penetration*sqrt(penetration)
    else
      force = self%stiffness*penetration**self%exponent
    end if
  end function elastic_force

  !> (4.1). Neither speed matters.
  pure function normal_force(self, penetration, penetration_rate, impact_speed) result(force)
    class(hertz_t), intent(in) :: self
    real(dp), value, intent(in) :: penetration, penetration_rate, impact_speed
    real(dp) :: force
    associate (unused_rate => penetration_rate, unused_speed => impact_speed)
    end associate
    force = self%elastic_force(penetration)
  end function normal_force

  pure subroutine normal_force_slopes(self, penetration, penetration_rate, impact_speed, stiffness, damping)
    class(hertz_t), intent(in) :: self
    real(dp), intent(in) :: penetration, penetration_rate, impact_speed
    real(dp), intent(out) :: stiffness, damping
    associate (unused_rate => penetration_rate, unused_speed => impact_speed)
    end associate
    stiffness = 0
    if (penetration > 0) stiffness = self%exponent*self%elastic_force(penetration)/penetration
    damping = 0
  end subroutine normal_force_slopes
end module hertz
