!> Coulomb friction with a linear ramp at small sliding speeds, after Ambrosio (4.9, 4.10).
module ambrosio
  use kinds, only: dp
  use number_text, only: short_text
  use model_parameters, only: parameter_list_t
  use friction_law, only: friction_law_t
  implicit none
  private
  public :: ambrosio_t

  !> F_T = -c_f c_d F_N sign(v_T), where c_d rises from 0 at |v_T| = v0 to 1 at v1. Without a ramp, v0 = v1 = 0, it is Coulomb's
  !> law.
  type, extends(friction_law_t) :: ambrosio_t
    real(dp) :: v0 = 0            !! largest sliding speed without friction [m/s], >= 0
    real(dp) :: v1 = 0            !! smallest sliding speed with full friction [m/s], >= v0
  contains
    procedure :: parameters
    procedure :: conflict
    procedure :: prepare
    procedure :: sliding_ratio
    procedure :: friction_ratio_slope
  end type ambrosio_t

contains

  subroutine parameters(self, list)
    class(ambrosio_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call self%add_coefficient(list)
    call list%add('v0', self%v0, 'sliding speed below which there is no friction', 'm/s', '>= 0', example='0.001', &
      usual='1e-6 to 0.1')
    call list%add('v1', self%v1, 'sliding speed above which friction is full', 'm/s', '>= 0', example='0.010', usual='1e-6 to 1')
  end subroutine parameters

  pure subroutine conflict(self, key, wanted)
    class(ambrosio_t), intent(in) :: self
    character(len=:), allocatable, intent(out) :: key, wanted
    key = ''
    wanted = 'must be >= v0 = '//short_text(self%v0)
    if (self%v1 < self%v0) key = 'v1'
  end subroutine conflict

  subroutine prepare(self)
    class(ambrosio_t), intent(inout) :: self
    self%set_valued = .not. self%v1 > 0
  end subroutine prepare

  !> (4.9) with (4.10). Continuous for v0 < v1; for v0 = v1 > 0 it has a jump of c_f at v1.
  pure function sliding_ratio(self, sliding_speed) result(ratio)
    class(ambrosio_t), intent(in) :: self
    real(dp), value, intent(in) :: sliding_speed
    real(dp) :: ratio
    real(dp) :: speed
    speed = abs(sliding_speed)
    if (speed >= self%v1) then
      ratio = self%coefficient
    else if (speed <= self%v0) then
      ratio = 0
    else
      ratio = self%coefficient*(speed - self%v0)/(self%v1 - self%v0)
    end if
    ratio = -sign(ratio, sliding_speed)
  end function sliding_ratio

  pure function friction_ratio_slope(self, sliding_speed) result(slope)
    class(ambrosio_t), intent(in) :: self
    real(dp), intent(in) :: sliding_speed
    real(dp) :: slope
    slope = 0
    if (abs(sliding_speed) > self%v0 .and. abs(sliding_speed) < self%v1) &
      slope = -self%coefficient/(self%v1 - self%v0)
  end function friction_ratio_slope
end module ambrosio
