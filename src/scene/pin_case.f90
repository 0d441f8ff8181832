!> The piston pin as a case describes it: the body that holds it, or its own mass and inertia where it turns in both bearings.
module pin_case
  use kinds, only: dp
  use model_parameters, only: has_parameters_t, parameter_list_t
  implicit none
  private
  public :: pin_case_t, pin_of_rod, pin_of_piston, pin_floating

  character(len=*), parameter :: pin_of_rod = 'rod', pin_of_piston = 'piston', pin_floating = 'floating'   !! kinds

  type, extends(has_parameters_t) :: pin_case_t
    character(len=:), allocatable :: kind
    real(dp) :: mass = 0      !! of a floating pin [kg]
    real(dp) :: inertia = 0   !! about its axis [kg m^2]
  contains
    procedure :: parameters
  end type pin_case_t

contains

  subroutine parameters(self, list)
    class(pin_case_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call list%word('kind', self%kind, pin_of_rod//', '//pin_of_piston//', '//pin_floating, pin_of_rod, &
      'body that holds the pin; floating: it turns in both. The bearing is in the other: place = ''piston_pin'' for rod, '// &
      '''small_end'' for piston, both for floating')
    call list%add('mass', self%mass, 'mass of a floating pin, not part of rod_mass or piston_mass', 'kg', '> 0', default='0.0', &
      usual='1e-5 to 1e3')
    call list%add('inertia', self%inertia, 'moment of inertia of a floating pin about its axis; hollow: mass (r_o^2 + r_i^2)/2', &
      'kg m^2', '> 0', default='0.0', usual='1e-11 to 1e2')
  end subroutine parameters
end module pin_case
