!> Load element: dry contact in a bore whose worn shape acts, on a foundation of springs.
module worn_contact
  use kinds, only: dp
  use worn_bore, only: worn_bore_t, touching_cells_t
  use contact_arc, only: contact_arc_t
  use joint_case, only: joint_case_t
  use joint_evaluation, only: joint_evaluation_t, joint_rates_t, find_polar
  use dry_contact, only: dry_contact_t
  implicit none
  private
  public :: worn_contact_t

  type, extends(dry_contact_t) :: worn_contact_t
    type(worn_bore_t) :: bore
  contains
    procedure :: prepare
    procedure :: find_loads
    procedure :: find_gap
    procedure :: normal_force
    procedure :: find_share
    procedure :: spread
    procedure :: wear_bore
  end type worn_contact_t

contains

  subroutine prepare(self, wanted, tolerance, makes_tables)
    class(worn_contact_t), intent(inout) :: self
    type(joint_case_t), intent(in) :: wanted
    real(dp), intent(in) :: tolerance
    logical, intent(in) :: makes_tables
    call self%dry_contact_t%prepare(wanted, tolerance, makes_tables)
    call self%bore%prepare(wanted%wear%bins, self%bearing%clearance, self%contact%geometry%foundation())
    self%has_own_gap = .true.
    self%has_slopes = .false.
  end subroutine prepare

  pure subroutine find_loads(self, y, joint)
    class(worn_contact_t), intent(in) :: self
    real(dp), intent(in) :: y(*)
    type(joint_evaluation_t), intent(inout) :: joint
    call find_polar(self%bearing%clearance, joint)
    call self%find_gap(y, joint)
    call press(self, joint, joint%normal_force)
    call self%add_friction(y, joint)
  end subroutine find_loads

  !> Depth of the deepest point of the pin in the foundation, and its rate.
  pure subroutine find_gap(self, y, joint)
    class(worn_contact_t), intent(in) :: self
    real(dp), intent(in) :: y(*)
    type(joint_evaluation_t), intent(inout) :: joint
    real(dp) :: gradient(2)
    call self%bore%find_gap(joint%eccentricity, joint%penetration, gradient)
    joint%penetration_rate = dot_product(gradient, joint%eccentricity_rate)
  end subroutine find_gap

  !> The normal force, and the direction in which the pin presses on the bore, if it does.
  pure subroutine press(self, joint, normal_force)
    type(worn_contact_t), intent(in) :: self
    type(joint_evaluation_t), intent(inout) :: joint
    real(dp), intent(out) :: normal_force
    real(dp) :: elastic(2), unused, pressing
    normal_force = 0
    call self%bore%press(joint%eccentricity, elastic, unused)
    pressing = norm2(elastic)
    if (.not. pressing > 0) return
    joint%normal = elastic/pressing
    associate (n => joint%normal, rate => joint%eccentricity_rate)
      joint%tangential_rate = n(1)*rate(2) - n(2)*rate(1)
      if (.not. self%force_is_lost) &
        normal_force = self%contact%damped_by(pressing, joint%penetration, dot_product(n, rate), joint%impact_speed)
    end associate
  end subroutine press

  pure real(dp) function normal_force(self, joint)
    class(worn_contact_t), intent(in) :: self
    type(joint_evaluation_t), intent(in) :: joint
    type(joint_evaluation_t) :: pressed
    pressed = joint
    call press(self, pressed, normal_force)
  end function normal_force

  !> The rate of the share is a difference over a short part of the motion.
  pure subroutine find_share(self, joint, rates, share, share_rate)
    class(worn_contact_t), intent(in) :: self
    type(joint_evaluation_t), intent(in) :: joint
    type(joint_rates_t), intent(in) :: rates
    real(dp), intent(out) :: share, share_rate
    real(dp) :: onwards
    if (.not. joint%penetration > 0) then
      call self%dry_contact_t%find_share(joint, rates, share, share_rate)
      return
    end if
    associate (e => joint%eccentricity, rate => joint%eccentricity_rate)
      share = share_at(e, rate)
      share_rate = 0
      if (.not. norm2(rate) > 0) return
      onwards = 1e-6_dp*joint%penetration/norm2(rate)
      share_rate = (share_at(e + onwards*rate, rate + onwards*rates%eccentricity) - share)/onwards
    end associate

  contains

    !> The share at an eccentricity [m] and its rate [m/s]; 1 without contact.
    pure real(dp) function share_at(e, rate)
      real(dp), intent(in) :: e(2), rate(2)
      real(dp) :: elastic(2), unused, pressing, penetration, gradient(2)
      share_at = 1
      call self%bore%press(e, elastic, unused)
      pressing = norm2(elastic)
      call self%bore%find_gap(e, penetration, gradient)
      if (pressing > 0 .and. penetration > 0) &
        share_at = self%contact%damped_force(pressing, penetration, dot_product(elastic, rate)/pressing)/pressing
    end function share_at
  end subroutine find_share

  !> The pin may touch the bore on several arcs.
  pure subroutine spread(self, joint, ratio, width, arc)
    class(worn_contact_t), intent(in) :: self
    type(joint_evaluation_t), intent(in) :: joint
    real(dp), intent(out), optional :: ratio
    real(dp), intent(in), optional :: width
    type(contact_arc_t), intent(inout), optional :: arc
    type(touching_cells_t) :: touching
    real(dp) :: elastic(2), total
    call self%bore%press(joint%eccentricity, elastic, total)
    if (present(ratio)) then
      ratio = 1
      if (total > 0) ratio = total/norm2(elastic)
    end if
    if (.not. present(arc)) return
    call self%bore%cells(joint%eccentricity, touching)
    call arc%allocate_cells(touching%n)
    arc%ends(:, :arc%n) = touching%ends(:, :arc%n) - atan2(elastic(2), elastic(1))
    arc%loads(:arc%n) = touching%loads(:arc%n)
  end subroutine spread

  pure subroutine wear_bore(self, depth)
    class(worn_contact_t), intent(inout) :: self
    real(dp), intent(in) :: depth(:)
    self%bore%depth = depth
  end subroutine wear_bore
end module worn_contact
