!> Element of the guide: dry contact of the four corners of the skirt with the bore, each with its own contact and friction.
module skirt_corners
  use kinds, only: dp
  use bearing_size, only: bearing_t
  use trace_row, only: trace_row_t, least, largest, impacts, of_cycle
  use chain_motion, only: motion_t
  use friction_law, only: friction_law_t
  use piston_skirt, only: skirt_t, n_corners, corner_names
  use guide_case, only: guide_case_t
  use guide_element, only: guide_element_t, guide_loads_t
  implicit none
  private
  public :: skirt_corners_t

  type, extends(guide_element_t) :: skirt_corners_t
    class(friction_law_t), allocatable :: friction   !! not allocated: smooth surfaces
  contains
    procedure :: prepare
    procedure :: find_loads
    procedure :: add_columns
  end type skirt_corners_t

contains

  subroutine prepare(self, wanted)
    class(skirt_corners_t), intent(inout) :: self
    type(guide_case_t), intent(in) :: wanted
    allocate (self%contact, source=wanted%contact)
    call self%contact%prepare(bearing_t())
    if (.not. allocated(wanted%friction)) return
    allocate (self%friction, source=wanted%friction)
    call self%friction%prepare()
  end subroutine prepare

  pure subroutine find_loads(self, skirt, motion, y, now)
    class(skirt_corners_t), intent(in) :: self
    type(skirt_t), intent(in) :: skirt
    type(motion_t), intent(in) :: motion
    real(dp), intent(in) :: y(*)
    type(guide_loads_t), intent(inout) :: now
    real(dp) :: side
    integer :: i
    call skirt%place_corners(motion%tilting, now%corner)
    do i = 1, n_corners
      associate (corner => now%corner(i))
        corner%sliding_speed = now%speed - corner%from_com(2)*motion%tilting%tilt_rate
        corner%normal_force = 0
        corner%friction_force = 0
        if (.not. skirt%touches(i)) cycle
        corner%normal_force = self%normal_force(skirt, i, corner)
        if (allocated(self%friction)) corner%friction_force = corner%normal_force* &
          self%friction%friction_ratio(corner%sliding_speed, nint(sign(1.0_dp, corner%sliding_speed)))
        side = merge(1, -1, i <= 2)
        now%friction_force = now%friction_force + corner%friction_force
        now%force = now%force - side*corner%normal_force
        now%moment = now%moment - side*corner%from_com(1)*corner%normal_force - corner%from_com(2)*corner%friction_force
      end associate
    end do
  end subroutine find_loads

  pure subroutine add_columns(self, now, row)
    class(skirt_corners_t), intent(in) :: self
    type(guide_loads_t), intent(in) :: now
    type(trace_row_t), intent(inout) :: row
    integer :: i
    do i = 1, n_corners
      row%place = corner_names(i)//'_'
      call row%add('gap[m]', -now%corner(i)%depth, &
        'gap between this corner of the skirt and the bore; negative where it penetrates')
      call row%keep('min_gap', least, 'smallest gap at this corner of the skirt; negative: deepest penetration', &
        rate=-now%corner(i)%depth_rate, is_of_contact=.true.)
      call row%add_on_request('closing_speed[m/s]', now%corner(i)%depth_rate, 'speed at which this gap closes')
      call row%keep('max_impact_speed', largest, 'largest speed at which a contact of this corner began; 0: none began', &
        at_impacts=.true., has_angle=.true.)
      call row%keep('impacts', impacts, 'contacts of this corner that began', told=of_cycle, unit='1', at_impacts=.true.)
      call row%add('force[N]', now%corner(i)%normal_force, &
        'contact force of this corner, positive where it presses; 0 without contact')
      call row%keep('max_force', largest, 'largest contact force of this corner of the skirt', is_of_contact=.true.)
      call row%add('friction[N]', now%corner(i)%friction_force, 'friction of the bore on this corner, along x')
    end do
    row%place = ''
  end subroutine add_columns
end module skirt_corners
