!> Contact laws whose damping is set by a coefficient of restitution.
!>
!> In a free impact under F = f(delta) [1 + chi delta_dot/delta_dot_minus] the ratio e* of the speeds after and before depends on
!> chi alone, for any mass and geometry: chi (1 + e*) = ln[(1 + chi)/(1 - chi e*)]. The laws differ in their chi for the coefficient
!> e of the case, and therefore in the difference between e* and e.
module restitution_law
  use kinds, only: dp
  use number_text, only: short_text
  use model_parameters, only: parameter_list_t
  use bearing_size, only: bearing_t
  use contact_law, only: contact_law_t
  implicit none
  private
  public :: restitution_law_t, one_percent

  type, abstract, extends(contact_law_t) :: restitution_law_t
    real(dp) :: restitution = 1   !! e, given in the case [-], 0 to 1; used if the case does not give the `dissipation`
  contains
    procedure :: parameters
    procedure :: conflict
    procedure :: prepare
    procedure :: remembers_impact
    procedure(damping_for), deferred, nopass :: damping_for
    procedure, nopass :: least_restitution => zero
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
    call list%add('restitution', self%restitution, 'coefficient of restitution', range='>= 0 and <= 1', default='0.9', &
      family='loss', usual='0 to 1')
    call list%add('dissipation', self%dissipation, &
      'factor a in force = elastic force (1 + a rate), instead of restitution; 0: from restitution', &
      's/m', '> 0', default='0.0', family='loss', usual='1e-3 to 100')
    call list%add('least_impact_speed', self%least_impact_speed, &
      'impacts slower than this are damped as if they had this speed; a contact that lasts keeps the damping of its first '// &
      'touch: then give the dissipation', 'm/s', '>= 1e-9 and <= 1', default='1.0e-5', usual='1e-7 to 0.1')
  end subroutine parameters

  subroutine prepare(self, bearing)
    class(restitution_law_t), intent(inout) :: self
    type(bearing_t), intent(in) :: bearing
    self%has_own_damping = self%dissipation > 0
    if (.not. self%has_own_damping) self%damping = self%damping_for(self%restitution)
    call self%prepare_geometry(bearing)
  end subroutine prepare

  !> Without a `dissipation`: the law divides by the impact speed.
  pure logical function remembers_impact(self)
    class(restitution_law_t), intent(in) :: self
    remembers_impact = self%restitution < 1 .and. .not. self%dissipation > 0
  end function remembers_impact

  !> Report a restitution near 0 for a law whose chi grows as 1/e.
  pure subroutine conflict(self, key, wanted)
    class(restitution_law_t), intent(in) :: self
    character(len=:), allocatable, intent(out) :: key, wanted
    key = ''
    wanted = ''
    if (self%restitution >= self%least_restitution() .or. self%dissipation > 0) return
    key = 'restitution'
    wanted = 'must be >= '//short_text(self%least_restitution())//' with law = '''//trim(self%name)//''''
  end subroutine conflict

  pure real(dp) function zero()
    zero = 0
  end function zero

  !> Smallest coefficient of restitution for laws whose chi grows as 1/e; at 0.01 the force already rises almost as at a rigid wall.
  pure real(dp) function one_percent()
    one_percent = 0.01_dp
  end function one_percent
end module restitution_law
