!> The integration methods by name.
module ode_methods
  use error_handling, only: error_t, fail, status_case_file
  use ode_method, only: ode_method_t
  use adams, only: adams_t
  use radau, only: radau_t
  use auto_method, only: auto_t
  implicit none
  private
  public :: new_method

contains

  !> Create the integration method of a given name. Error: an unknown name.
  subroutine new_method(name, method, error)
    character(len=*), intent(in) :: name
    class(ode_method_t), allocatable, intent(out) :: method
    type(error_t), allocatable, intent(out) :: error
    select case (name)
    case ('auto')
      allocate (auto_t :: method)
    case ('adams')
      allocate (adams_t :: method)
    case ('radau')
      allocate (radau_t :: method)
    case default
      call fail(error, "&integrator method = '"//name//"': must be 'auto', 'adams' or 'radau'", status_case_file)
    end select
  end subroutine new_method
end module ode_methods
