!> Friction laws with memory: the surfaces interact through bristles, whose mean deflection z is a state.
!>
!> The deflection is 0 at the beginning of a contact and while there is no contact. Forces are divided by the normal force (and so
!> are the parameters of Canudas de Wit et al.), so that |z| <= c_s/s_0 for any load, and the friction vanishes with the load. As a
!> consequence the energy of the bristles, F_N s_0 z^2/2, depends on the load, and friction may supply energy, up to this amount
!> each time that the load varies while they are deflected (how much: data/manual/choices.md).
module bristle_law
  use kinds, only: dp
  use number_text, only: short_text
  use model_parameters, only: parameter_list_t
  use trace_row, only: trace_row_t
  use static_friction, only: static_friction_t
  implicit none
  private
  public :: bristle_law_t

  !> F_T/F_N = -(s_0 z + s_1(v) z' + s_2 v), with s_1(v) = s_1 exp(-(v/v_d)^2) and v = v_T. Each law defines z'.
  type, abstract, extends(static_friction_t) :: bristle_law_t
    real(dp) :: stribeck_speed = 1        !! v_s, the speed scale of the decrease from c_s to c_f [m/s], > 0
    real(dp) :: bristle_stiffness = 0     !! s_0 [1/m], > 0
    real(dp) :: bristle_damping = 0       !! s_1 [s/m], >= 0
    real(dp) :: damping_speed = 0         !! v_d, the speed scale of the decrease of the damping [m/s]; 0: it is constant
  contains
    procedure :: conflict
    procedure :: touch_down_limit
    procedure :: prepare
    procedure :: sliding_ratio
    procedure :: friction_ratio_slope
    procedure :: state_friction
    procedure :: state_slopes
    procedure :: add_columns
    procedure, non_overridable :: add_common
    procedure, non_overridable :: add_sliding
    procedure, non_overridable :: steady_sliding
    procedure(bristle_rate), deferred :: bristle_rate
    procedure(rate_slopes), deferred :: rate_slopes
  end type bristle_law_t

  abstract interface
    !> z' [m/s] at a sliding speed v [m/s] and a deflection z [m].
    pure real(dp) function bristle_rate(self, v, z)
      import :: bristle_law_t, dp
      class(bristle_law_t), intent(in) :: self
      real(dp), intent(in) :: v, z
    end function bristle_rate

    !> Its derivatives with respect to v [-] and z [1/s].
    pure subroutine rate_slopes(self, v, z, by_speed, by_deflection)
      import :: bristle_law_t, dp
      class(bristle_law_t), intent(in) :: self
      real(dp), intent(in) :: v, z
      real(dp), intent(out) :: by_speed, by_deflection
    end subroutine rate_slopes
  end interface

contains

  !> Declare the parameters of all laws with bristles.
  subroutine add_common(self, list)
    class(bristle_law_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call self%add_coefficient(list)
    call list%add('bristle_stiffness', self%bristle_stiffness, &
      'stiffness of the bristles: friction over normal force per deflection', '1/m', '> 0', example='2.0e4', usual='100 to 1e8')
  end subroutine add_common

  !> Declare the parameters of static friction and of its dependence on the speed.
  subroutine add_sliding(self, list)
    class(bristle_law_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call self%add_static(list)
    call self%add_stribeck_speed(self%stribeck_speed, list)
    call list%add('bristle_damping', self%bristle_damping, &
      'damping of the bristles: friction over normal force per rate of deflection', 's/m', '>= 0', default='0.0', usual='0 to 1e4')
    call list%add('damping_speed', self%damping_speed, 'sliding speed over which bristle_damping decreases; 0: it is constant', &
      'm/s', '>= 0', default='0.0', usual='1e-6 to 1')
    call self%add_viscous(list)
  end subroutine add_sliding

  pure subroutine conflict(self, key, wanted)
    class(bristle_law_t), intent(in) :: self
    character(len=:), allocatable, intent(out) :: key, wanted
    real(dp), parameter :: largest = 0.42888194248035344_dp   !! maximum of x exp(-x^2)
    real(dp) :: static
    static = self%holding_coefficient()
    call self%static_conflict(key, wanted)
    if (key /= '') return
    if (.not. self%coefficient > 0) then
      key = 'coefficient'
      wanted = 'must be > 0 for a law with bristles'
    else if (largest*self%bristle_damping*self%damping_speed >= static) then
      key = 'damping_speed'
      wanted = 'bristle_damping gives more than the static friction at touch-down: must be < '// &
        'static_coefficient/(0.43 bristle_damping) = '//short_text(static/(largest*self%bristle_damping))
    end if
  end subroutine conflict

  !> Largest sliding speed [m/s] at which friction at the beginning of a contact does not exceed static friction. There z is 0 and
  !> F_T/F_N = -(s_1 + s_2) v, whose first part exceeds c_s at high speeds if s_1 is constant.
  pure real(dp) function touch_down_limit(self)
    class(bristle_law_t), intent(in) :: self
    touch_down_limit = huge(touch_down_limit)
    if (self%damping_speed > 0 .or. .not. self%bristle_damping > 0) return
    touch_down_limit = self%holding_coefficient()/self%bristle_damping
  end function touch_down_limit

  subroutine prepare(self)
    class(bristle_law_t), intent(inout) :: self
    self%n_states = 1
    call self%find_static_part()
    self%state_scale = (self%coefficient + self%static_part)/self%bristle_stiffness   ! deflection at the beginning of sliding
  end subroutine prepare

  !> g(v) = c_f + (c_s - c_f) exp(-(v/v_s)^2) [-] and its derivative [s/m]: the friction of steady sliding without the viscous part.
  pure subroutine steady_sliding(self, v, g, slope)
    class(bristle_law_t), intent(in) :: self
    real(dp), intent(in) :: v
    real(dp), intent(out) :: g
    real(dp), intent(out), optional :: slope
    real(dp) :: fall
    fall = 0
    if (self%static_part > 0) fall = self%static_part*exp(-(v/self%stribeck_speed)**2)
    g = self%coefficient + fall
    if (present(slope)) slope = -2*v/self%stribeck_speed**2*fall
  end subroutine steady_sliding

  !> s_1(v) [s/m] and its derivative.
  pure subroutine damping_at(self, v, damping, slope)
    class(bristle_law_t), intent(in) :: self
    real(dp), intent(in) :: v
    real(dp), intent(out) :: damping
    real(dp), intent(out), optional :: slope
    damping = self%bristle_damping
    if (self%damping_speed > 0) damping = damping*exp(-(v/self%damping_speed)**2)
    if (.not. present(slope)) return
    slope = 0
    if (self%damping_speed > 0) slope = -2*v/self%damping_speed**2*damping
  end subroutine damping_at

  !> Friction of steady sliding, which is reached after sliding some micrometres in one direction.
  pure function sliding_ratio(self, sliding_speed) result(ratio)
    class(bristle_law_t), intent(in) :: self
    real(dp), value, intent(in) :: sliding_speed
    real(dp) :: ratio
    call self%steady_sliding(sliding_speed, ratio)
    ratio = -(sign(ratio, sliding_speed) + self%viscous_coefficient*sliding_speed)
  end function sliding_ratio

  pure function friction_ratio_slope(self, sliding_speed) result(slope)
    class(bristle_law_t), intent(in) :: self
    real(dp), intent(in) :: sliding_speed
    real(dp) :: slope
    real(dp) :: g
    call self%steady_sliding(sliding_speed, g, slope)
    slope = -(sign(1.0_dp, sliding_speed)*slope + self%viscous_coefficient)
  end function friction_ratio_slope

  pure subroutine state_friction(self, sliding_speed, states, ratio, rates)
    class(bristle_law_t), intent(in) :: self
    real(dp), intent(in) :: sliding_speed
    real(dp), intent(in) :: states(self%n_states)
    real(dp), intent(out) :: ratio
    real(dp), intent(out) :: rates(self%n_states)
    real(dp) :: damping
    associate (v => sliding_speed, z => states(1))
      rates(1) = self%bristle_rate(v, z)
      call damping_at(self, v, damping)
      ratio = -(self%bristle_stiffness*z + damping*rates(1) + self%viscous_coefficient*v)
    end associate
  end subroutine state_friction

  pure subroutine state_slopes(self, sliding_speed, states, slopes)
    class(bristle_law_t), intent(in) :: self
    real(dp), intent(in) :: sliding_speed
    real(dp), intent(in) :: states(self%n_states)
    real(dp), intent(out) :: slopes(1 + self%n_states, 1 + self%n_states)
    real(dp) :: damping, damping_slope
    associate (v => sliding_speed, z => states(1))
      call self%rate_slopes(v, z, slopes(2, 1), slopes(2, 2))
      call damping_at(self, v, damping, damping_slope)
      slopes(1, 1) = -(damping_slope*self%bristle_rate(v, z) + damping*slopes(2, 1) + self%viscous_coefficient)
      slopes(1, 2) = -(self%bristle_stiffness + damping*slopes(2, 2))
    end associate
  end subroutine state_slopes

  pure subroutine add_columns(self, states, row)
    class(bristle_law_t), intent(in) :: self
    real(dp), intent(in) :: states(:)
    type(trace_row_t), intent(inout) :: row
    call row%add('bristle[m]', states(1), 'mean deflection of the bristles, the state of the friction law')
  end subroutine add_columns
end module bristle_law
