!> Element of the guide: friction of the bore on the piston as a whole.
!>
!> F_x = mu(x') |N| - c x', where N is the force of the piston on an ideal guide. With clearance in the bore friction by the normal
!> force belongs to what presses there, and the viscous part remains.
module bore_friction
  use kinds, only: dp
  use chain_motion, only: motion_t
  use friction_law, only: friction_law_t
  use piston_skirt, only: skirt_t
  use guide_case, only: guide_case_t
  use guide_element, only: guide_element_t, guide_loads_t
  implicit none
  private
  public :: bore_friction_t

  type, extends(guide_element_t) :: bore_friction_t
    class(friction_law_t), allocatable :: friction   !! not allocated: only viscous friction
    real(dp) :: viscous = 0                          !! c [N s/m]
  contains
    procedure :: prepare
    procedure :: find_loads
  end type bore_friction_t

contains

  subroutine prepare(self, wanted)
    class(bore_friction_t), intent(inout) :: self
    type(guide_case_t), intent(in) :: wanted
    self%viscous = wanted%viscous
    if (wanted%has_clearance() .or. .not. allocated(wanted%friction)) return
    allocate (self%friction, source=wanted%friction)
    call self%friction%prepare()
  end subroutine prepare

  pure subroutine find_loads(self, skirt, motion, y, now)
    class(bore_friction_t), intent(in) :: self
    type(skirt_t), intent(in) :: skirt
    type(motion_t), intent(in) :: motion
    real(dp), intent(in) :: y(*)
    type(guide_loads_t), intent(inout) :: now
    now%friction_force = now%friction_force - self%viscous*now%speed
    if (allocated(self%friction)) now%friction_ratio = self%friction%friction_ratio(now%speed, nint(sign(1.0_dp, now%speed)))
  end subroutine find_loads
end module bore_friction
