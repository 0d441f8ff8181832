!> Load element: dry contact of a round pin in a round bore, with friction.
!>
!> The contact law gives the normal force F_N, the friction law the force F_T along the tangent t. On the pin act the force -F_N
!> n + F_T t and the moment F_T R. If set-valued friction holds the surfaces together, its force follows from the accelerations.
module dry_contact
  use kinds, only: dp
  use trace_row, only: trace_row_t, largest
  use contact_law, only: contact_law_t
  use friction_law, only: friction_law_t, most_friction_states
  use contact_arc, only: contact_arc_t
  use joint_case, only: joint_case_t
  use joint_evaluation, only: joint_evaluation_t, joint_rates_t, most_element_states, find_polar, find_sliding, outward_acceleration
  use load_element, only: load_element_t, n_motions, n_slopes
  implicit none
  private
  public :: dry_contact_t, add_friction_columns

  type, extends(load_element_t) :: dry_contact_t
    class(contact_law_t), allocatable :: contact
    class(friction_law_t), allocatable :: friction   !! not allocated: smooth surfaces
  contains
    procedure :: prepare
    procedure :: find_loads
    procedure, non_overridable :: add_friction
    procedure :: normal_force
    procedure :: find_slopes
    procedure, non_overridable :: find_friction_slopes
    procedure :: find_share
    procedure :: free_impact_speed
    procedure :: add_columns
    procedure :: spread
  end type dry_contact_t

contains

  subroutine prepare(self, wanted, tolerance, makes_tables)
    class(dry_contact_t), intent(inout) :: self
    type(joint_case_t), intent(in) :: wanted
    real(dp), intent(in) :: tolerance
    logical, intent(in) :: makes_tables
    self%rubs = .true.
    allocate (self%contact, source=wanted%contact)
    call self%contact%prepare(self%bearing)
    self%may_lose_force = self%contact%may_lose_force
    self%fastest_impact = self%contact%geometry%fastest_impact()
    self%deepest = self%contact%geometry%deepest
    if (.not. allocated(wanted%friction)) return
    allocate (self%friction, source=wanted%friction)
    call self%friction%prepare()
    self%has_friction = .true.
    self%may_stick = self%friction%set_valued
    self%holding_ratio = self%friction%holding_ratio()
    self%static_speed = self%friction%static_speed()
    self%n_states = self%friction%n_states
    self%state_name = 'bristle_deflection'
    self%state_unit = 'm'
    self%state_scale = self%friction%state_scale
    self%starts_again = .true.
    self%integrates_friction = self%n_states > 0 .or. wanted%reports_friction_work .or. allocated(wanted%wear)
  end subroutine prepare

  pure subroutine find_loads(self, y, joint)
    class(dry_contact_t), intent(in) :: self
    real(dp), intent(in) :: y(*)
    type(joint_evaluation_t), intent(inout) :: joint
    call find_polar(self%bearing%clearance, joint)
    joint%normal_force = self%contact%normal_force(joint%penetration, joint%penetration_rate, joint%impact_speed)
    if (self%force_is_lost) joint%normal_force = 0
    call self%add_friction(y, joint)
  end subroutine find_loads

  !> Add friction to a normal force, and find the force and the moment of both.
  pure subroutine add_friction(self, y, joint)
    class(dry_contact_t), intent(in) :: self
    real(dp), intent(in) :: y(*)
    type(joint_evaluation_t), intent(inout) :: joint
    real(dp) :: ratio
    joint%friction_force = 0
    if (allocated(self%friction)) then
      call find_sliding(self%pin_radius, joint)
      if (self%n_states > 0) then
        call self%friction%state_friction(joint%sliding_speed, y(self%states%first), ratio, joint%rates)
        joint%friction_force = joint%normal_force*ratio
      else
        joint%sticks = self%may_stick .and. self%sliding == 0
        if (.not. joint%sticks) &
          joint%friction_force = joint%normal_force*self%friction%friction_ratio(joint%sliding_speed, self%sliding)
      end if
    end if
    associate (n => joint%normal, pressing => joint%normal_force, friction => joint%friction_force)
      joint%contact(1) = -pressing*n(1) - friction*n(2)
      joint%contact(2) = friction*n(1) - pressing*n(2)
      joint%moment = friction*self%pin_radius
    end associate
    joint%force = joint%contact
  end subroutine add_friction

  pure real(dp) function normal_force(self, joint)
    class(dry_contact_t), intent(in) :: self
    type(joint_evaluation_t), intent(in) :: joint
    normal_force = 0
    if (.not. self%force_is_lost) &
      normal_force = self%contact%normal_force(joint%penetration, joint%penetration_rate, joint%impact_speed)
  end function normal_force

  pure subroutine find_slopes(self, joint, of_loads, of_rates)
    class(dry_contact_t), intent(in) :: self
    type(joint_evaluation_t), intent(in) :: joint
    real(dp), intent(out) :: of_loads(3, n_slopes), of_rates(most_element_states, n_slopes)
    real(dp) :: stiffness, damping, ratio, of_friction(1 + most_friction_states, 1 + most_friction_states)
    real(dp), dimension(n_motions) :: turn, depth, rate, sliding, normal, friction
    integer :: i, n

    of_loads = 0
    of_rates = 0
    stiffness = 0
    damping = 0
    if (.not. self%force_is_lost) &
      call self%contact%normal_force_slopes(joint%penetration, joint%penetration_rate, joint%impact_speed, stiffness, damping)
    call self%find_friction_slopes(joint, ratio, of_friction)
    associate (e => joint%distance, n => joint%normal)
      turn = [-n(2), n(1), 0.0_dp, 0.0_dp, 0.0_dp, 0.0_dp]/e
      depth = [n(1), n(2), 0.0_dp, 0.0_dp, 0.0_dp, 0.0_dp]
      rate = turn*joint%tangential_rate + [0.0_dp, 0.0_dp, n(1), n(2), 0.0_dp, 0.0_dp]
      sliding = [n(2)*(joint%penetration_rate/e), -n(1)*(joint%penetration_rate/e), -n(2), n(1), self%pin_radius, &
        -(e + self%pin_radius)] - joint%bearing_speed*depth
      normal = stiffness*depth + damping*rate
      friction = ratio*normal + of_friction(1, 1)*joint%normal_force*sliding
      do i = 1, n_motions
        associate (along => -normal(i) - joint%friction_force*turn(i), across => friction(i) - joint%normal_force*turn(i))
          of_loads(:, i) = [along*n(1) - across*n(2), along*n(2) + across*n(1), self%pin_radius*friction(i)]
        end associate
      end do
    end associate
    n = self%n_states
    do i = 1, n
      of_loads(:, n_motions + i) = joint%normal_force*of_friction(1, 1 + i)*[-joint%normal(2), joint%normal(1), self%pin_radius]
      of_rates(i, :n_motions) = of_friction(1 + i, 1)*sliding
      of_rates(i, n_motions + 1:n_motions + n) = of_friction(1 + i, 2:1 + n)
    end do
  end subroutine find_slopes

  !> Ratio of friction to normal force, and derivatives of it (row 1) and of the rates of the states of the friction law (following
  !> rows) with respect to the sliding speed (column 1) and to these states (following columns).
  pure subroutine find_friction_slopes(self, joint, ratio, slopes)
    class(dry_contact_t), intent(in) :: self
    type(joint_evaluation_t), intent(in) :: joint
    real(dp), intent(out) :: ratio, slopes(1 + most_friction_states, 1 + most_friction_states)
    real(dp) :: rates(most_friction_states)
    ratio = 0
    slopes = 0
    if (.not. allocated(self%friction)) return
    if (self%n_states > 0) then
      call self%friction%state_friction(joint%sliding_speed, joint%states, ratio, rates)
      call self%friction%state_slopes(joint%sliding_speed, joint%states, slopes)
    else
      ratio = self%friction%friction_ratio(joint%sliding_speed, self%sliding)
      slopes(1, 1) = self%friction%friction_ratio_slope(joint%sliding_speed)
    end if
  end subroutine find_friction_slopes

  pure subroutine find_share(self, joint, rates, share, share_rate)
    class(dry_contact_t), intent(in) :: self
    type(joint_evaluation_t), intent(in) :: joint
    type(joint_rates_t), intent(in) :: rates
    real(dp), intent(out) :: share, share_rate
    call self%contact%find_share(joint%penetration, joint%penetration_rate, outward_acceleration(joint, rates), share, share_rate)
  end subroutine find_share

  pure real(dp) function free_impact_speed(self, joint, deceleration) result(speed)
    class(dry_contact_t), intent(in) :: self
    type(joint_evaluation_t), intent(in) :: joint
    real(dp), intent(in) :: deceleration
    speed = self%contact%free_impact_speed(joint%penetration, joint%penetration_rate, deceleration)
  end function free_impact_speed

  pure subroutine add_columns(self, joint, row)
    class(dry_contact_t), intent(in) :: self
    type(joint_evaluation_t), intent(in) :: joint
    type(trace_row_t), intent(inout) :: row
    call row%add('normal_force[N]', joint%normal_force, &
      'contact force along the line of centres, positive where it presses; 0 without contact')
    call row%keep('max_normal_force', largest, 'largest contact force of this pin', is_of_contact=.true.)
    call add_friction_columns(joint, row)
    call self%contact%geometry%add_columns(merge(joint%penetration, 0.0_dp, joint%touches), joint%normal_force, row)
    if (allocated(self%friction)) call self%friction%add_columns(joint%states, row)
  end subroutine add_columns

  !> Add the columns of friction, of a contact or of asperities.
  pure subroutine add_friction_columns(joint, row)
    type(joint_evaluation_t), intent(in) :: joint
    type(trace_row_t), intent(inout) :: row
    call row%add('friction_force[N]', joint%friction_force, &
      'friction on the pin along the tangent t = (-n_y, n_x), n from the bearing centre to the pin centre')
    call row%add('sliding_speed[m/s]', joint%sliding_speed, &
      'velocity of the pin surface relative to the bearing along the same tangent')
  end subroutine add_friction_columns

  pure subroutine spread(self, joint, ratio, width, arc)
    class(dry_contact_t), intent(in) :: self
    type(joint_evaluation_t), intent(in) :: joint
    real(dp), intent(out), optional :: ratio
    real(dp), intent(in), optional :: width
    type(contact_arc_t), intent(inout), optional :: arc
    real(dp) :: half_angle   ! 0 without contact, or if the geometry of the contact does not say it
    integer :: i
    half_angle = 0
    if (joint%touches .and. joint%penetration > 0) half_angle = self%contact%geometry%half_angle(joint%penetration)
    if (present(ratio)) then
      ratio = 1
      if (half_angle > 0) ratio = self%contact%geometry%total_pressure(half_angle)
    end if
    if (.not. present(arc)) return
    call arc%divide(half_angle, width)
    do i = 1, arc%n
      arc%loads(i) = arc%loads(i)*self%contact%geometry%pressure(half_angle, arc%middles(i))
    end do
  end subroutine spread
end module dry_contact
