!> Coulomb friction (4.8).
module coulomb
  use gudgeon_kinds, only: dp
  use gudgeon_parameters, only: parameter_list_t
  use friction_law, only: friction_law_t, static_or_sliding, static_conflict
  implicit none
  private
  public :: coulomb_t

  !> F_T = -c_f F_N sign(v_T), set-valued at v_T = 0: surfaces that stick hold up to |F_T| = c_s F_N.
  type, extends(friction_law_t) :: coulomb_t
    real(dp) :: coefficient = 0          !! c_f of sliding [-], >= 0
    real(dp) :: static_coefficient = 0   !! c_s of sticking [-], >= c_f; 0: as c_f
  contains
    procedure, nopass :: name
    procedure :: parameters
    procedure :: conflict
    procedure :: prepare
    procedure :: friction_ratio
    procedure :: holding_ratio
  end type coulomb_t

contains

  pure function name()
    character(len=:), allocatable :: name
    name = 'coulomb'
  end function name

  subroutine parameters(self, list)
    class(coulomb_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call list%add('coefficient', self%coefficient, 'of sliding friction', range='>= 0', example='0.03')
    call list%add('static_coefficient', self%static_coefficient, 'of friction at rest; 0: as coefficient', range='>= 0', &
      default='0.0')
  end subroutine parameters

  pure subroutine conflict(self, key, wanted)
    class(coulomb_t), intent(in) :: self
    character(len=:), allocatable, intent(out) :: key, wanted
    call static_conflict(self%static_coefficient, self%coefficient, key, wanted)
  end subroutine conflict

  subroutine prepare(self)
    class(coulomb_t), intent(inout) :: self
    self%set_valued = .true.
  end subroutine prepare

  !> (4.8). The sign is that of `direction`, which the scene holds fixed between its reversals of sliding: the sliding
  !> speed itself is not asked, so that the force is smooth within a step.
  pure function friction_ratio(self, sliding_speed, direction) result(ratio)
    class(coulomb_t), intent(in) :: self
    real(dp), value, intent(in) :: sliding_speed
    integer, value, intent(in) :: direction
    real(dp) :: ratio
    associate (unused => sliding_speed)
    end associate
    ratio = -self%coefficient*direction
  end function friction_ratio

  pure real(dp) function holding_ratio(self)
    class(coulomb_t), intent(in) :: self
    holding_ratio = static_or_sliding(self%static_coefficient, self%coefficient)
  end function holding_ratio
end module coulomb
