!> The contact laws that set the loss by a coefficient of restitution and one formula, chi(e).
module restitution_laws
  use gudgeon_kinds, only: dp
  use restitution_law, only: restitution_law_t
  implicit none
  private
  public :: lankarani_nikravesh_t, hunt_crossley_t

  !> Lankarani and Nikravesh 1990 (4.7): chi = (3/4)(1 - e^2). A free impact gives back more than e: 0.913 for 0.9, 0.725 for 0.5.
  type, extends(restitution_law_t) :: lankarani_nikravesh_t
  contains
    procedure, nopass :: name => name_of_lankarani_nikravesh
    procedure, nopass :: damping_for => lankarani_nikravesh_damping
  end type lankarani_nikravesh_t

  !> Hunt and Crossley 1975: chi = (3/2)(1 - e), exact to first order for e near 1. Gives back 0.909 for 0.9, 0.663 for 0.5.
  type, extends(restitution_law_t) :: hunt_crossley_t
  contains
    procedure, nopass :: name => name_of_hunt_crossley
    procedure, nopass :: damping_for => hunt_crossley_damping
  end type hunt_crossley_t

contains

  pure function name_of_lankarani_nikravesh() result(name)
    character(len=:), allocatable :: name
    name = 'lankarani_nikravesh'
  end function name_of_lankarani_nikravesh

  pure real(dp) function lankarani_nikravesh_damping(restitution) result(damping)
    real(dp), intent(in) :: restitution
    damping = 0.75_dp*(1 - restitution**2)
  end function lankarani_nikravesh_damping

  pure function name_of_hunt_crossley() result(name)
    character(len=:), allocatable :: name
    name = 'hunt_crossley'
  end function name_of_hunt_crossley

  pure real(dp) function hunt_crossley_damping(restitution) result(damping)
    real(dp), intent(in) :: restitution
    damping = 1.5_dp*(1 - restitution)
  end function hunt_crossley_damping
end module restitution_laws
