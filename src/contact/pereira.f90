!> The contact of a pin in a bore by Pereira, Ramalho and Ambrosio (2011): a power of the penetration, fitted to Johnson's law.
module pereira
  use kinds, only: dp
  use model_parameters, only: parameter_list_t
  use bearing_size, only: bearing_t
  use hertz_sphere, only: hertz_sphere_t
  implicit none
  private
  public :: pereira_t

  !> In mm and N: f = (0.965 c + 0.0965) L E*/c delta^n, n = Y c^-0.005, Y = 1.51 [ln(1000 c)]^-0.151 for c < 0.34954 and
  !> 0.0151 c + 1.151 above. Limits: 5 um <= c <= 10 mm; for delta from a hundredth to a tenth of c within 6 % of Johnson's law at
  !> c = 0.1 mm, within 14 % at 20 um. The power law is that of its parent, with another stiffness and exponent.
  type, extends(hertz_sphere_t) :: pereira_t
  contains
    procedure :: parameters
    procedure :: bearing_conflict
    procedure :: prepare
    procedure, nopass :: needs_length
  end type pereira_t

  real(dp), parameter :: per_metre = 1e3_dp   !! [mm]
  real(dp), parameter :: branch_clearance = 0.34954_dp   !! [mm]

contains

  subroutine parameters(self, list)
    class(pereira_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call self%material_parameters(list)
  end subroutine parameters

  !> Report a clearance outside the range of the fit.
  pure subroutine bearing_conflict(self, bearing, key, wanted)
    class(pereira_t), intent(in) :: self
    type(bearing_t), intent(in) :: bearing
    character(len=:), allocatable, intent(out) :: key, wanted
    key = ''
    wanted = 'must be >= 5e-6 and <= 1e-2 with contact geometry = '''//trim(self%name)//''''
    if (bearing%clearance < 5e-6_dp .or. bearing%clearance > 1e-2_dp) key = 'clearance'
  end subroutine bearing_conflict

  subroutine prepare(self, bearing)
    class(pereira_t), intent(inout) :: self
    type(bearing_t), intent(in) :: bearing
    real(dp) :: factor
    associate (c => bearing%clearance*per_metre)
      if (c < branch_clearance) then
        factor = 1.51_dp*log(1000*c)**(-0.151_dp)
      else
        factor = 0.0151_dp*c + 1.151_dp
      end if
      self%exponent = factor*c**(-0.005_dp)
      ! E* in N/mm^2, L in mm, and delta^n converted from mm to m
      self%stiffness = (0.965_dp*c + 0.0965_dp)/c*(bearing%length*per_metre) &
        *(self%contact_modulus()/per_metre**2)*per_metre**self%exponent
    end associate
  end subroutine prepare

  pure logical function needs_length()
    needs_length = .true.
  end function needs_length
end module pereira
