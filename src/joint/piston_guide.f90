!> The guide of the piston in its bore: a list of elements, see guide_element_t.
!>
!> An ideal guide keeps the piston on the cylinder's axis; its elements are frictions. With clearance (piston slap) the piston also
!> moves transversely and tilts: see `piston_skirt`.
module piston_guide
  use kinds, only: dp
  use bearing_size, only: crossing_speed
  use state_layout, only: layout_t, slice_t
  use run_state, only: run_state_t
  use chain_motion, only: motion_t, tilting_t
  use chain_loads, only: loads_t
  use piston_skirt, only: skirt_t, corner_t, n_corners, corner_names
  use guide_element, only: guide_element_t, guide_loads_t
  implicit none
  private
  public :: piston_guide_t, guide_loads_t, corner_t, n_corners, corner_names

  integer, parameter :: most_elements = 8

  !> One place in the list of elements.
  type :: slot_t
    class(guide_element_t), allocatable :: element
  end type slot_t

  type, extends(skirt_t) :: piston_guide_t
    integer :: n_elements = 0
    type(slot_t) :: slots(most_elements)
    integer :: touching = 0               !! number of the element whose corners may touch the bore; 0: none
    integer :: n_states = 0               !! of the elements
    integer :: filmed = 0                 !! number of the element with the film of the skirt; 0: none
    real(dp) :: start(2) = 0              !! offset [m] and tilt [rad] at t = 0
    real(dp) :: start_rate(2) = 0         !! [m/s], [rad/s]
  contains
    procedure :: add
    procedure :: claim
    procedure :: set_start
    procedure :: declare
    procedure :: find_contact_state
    procedure :: find_loads
    procedure :: set_rates
    procedure :: own_speed
    procedure :: admits_state
  end type piston_guide_t

contains

  !> Add an element, which has been prepared.
  subroutine add(self, element)
    class(piston_guide_t), intent(inout) :: self
    class(guide_element_t), allocatable, intent(inout) :: element   !! not allocated afterwards
    self%n_elements = self%n_elements + 1
    if (allocated(element%contact)) self%touching = self%n_elements
    element%rates = slice_t(self%n_states + 1, self%n_states + element%n_states)
    self%n_states = element%rates%last
    call move_alloc(element, self%slots(self%n_elements)%element)
  end subroutine add

  !> Claim offset and tilt, and what the elements need, in the state vector. The scale of the offset is the clearance, that of its
  !> rate as for a pin in its bearing; the scale of the tilt is the angle at which top and bottom of the skirt touch opposite walls.
  subroutine claim(self, layout, crank_speed, span)
    class(piston_guide_t), intent(inout) :: self
    type(layout_t), intent(inout) :: layout
    real(dp), intent(in) :: crank_speed   !! natural size of the crank speed [rad/s]
    real(dp), intent(in) :: span          !! duration of the simulation [s]
    type(slice_t) :: one
    real(dp) :: speed, arm
    integer :: k, i
    if (self%is_loose) then
      arm = 0.5_dp*(self%height(1) - self%height(2))
      speed = max(self%clearance*crank_speed, abs(self%start_rate(1)), arm*abs(self%start_rate(2)), &
        0.01_dp*crossing_speed(self%clearance, span))
      call layout%claim_positions(1, self%clearance, speed, self%offset, grows=.false.)
      call layout%claim_positions(1, self%clearance/arm, speed/arm, self%tilt, grows=.false.)
    end if
    do k = 1, self%n_elements
      associate (element => self%slots(k)%element)
        do i = 1, element%n_states
          call layout%claim_states(1, element%state_scale(i), one)
          element%states = slice_t(one%last - i + 1, one%last)
        end do
      end associate
    end do
  end subroutine claim

  !> Natural size of the piston's transverse speed where it does not follow from the crank speed [m/s]; 0 without clearance.
  pure real(dp) function own_speed(self, span)
    class(piston_guide_t), intent(in) :: self
    real(dp), intent(in) :: span   !! [s]
    own_speed = 0
    if (self%is_loose) own_speed = max(abs(self%start_rate(1)), maxval(abs(self%height))*abs(self%start_rate(2)), &
      crossing_speed(self%clearance, span))
  end function own_speed

  !> Set the initial offset and tilt, and the states of the elements, in the state vector.
  pure subroutine set_start(self, y)
    class(piston_guide_t), intent(in) :: self
    real(dp), intent(inout) :: y(:)
    integer :: k
    if (self%is_loose) then
      y([self%offset%position, self%tilt%position]) = self%start
      y([self%offset%rate, self%tilt%rate]) = self%start_rate
    end if
    do k = 1, self%n_elements
      associate (element => self%slots(k)%element)
        y(element%states%first:element%states%last) = element%start(:element%n_states)
      end associate
    end do
  end subroutine set_start

  !> Declare the state of a piston with clearance in its bore, and the states of the elements.
  subroutine declare(self, list, y)
    class(piston_guide_t), intent(inout) :: self
    type(run_state_t), intent(inout) :: list
    real(dp), intent(inout) :: y(:)
    integer :: k
    if (self%is_loose) call declare_place(self, list, y)
    do k = 1, self%n_elements
      associate (element => self%slots(k)%element)
        if (element%n_states > 0) call list%add(trim(element%state_name), y(element%states%first:element%states%last), &
          trim(element%state_unit), '')
      end associate
    end do
  end subroutine declare

  !> Declare where the piston is in its bore, and which corners touch it. In a bore of another clearance it keeps its ratio to the
  !> clearance.
  subroutine declare_place(guide, list, y)
    type(piston_guide_t), intent(inout) :: guide
    type(run_state_t), intent(inout) :: list
    real(dp), intent(inout) :: y(:)
    real(dp) :: clearance
    integer :: touches(n_corners), i
    clearance = guide%clearance
    touches = merge(1, 0, guide%touches)
    call list%add('bore_clearance', clearance, 'm', 'clearance of this position of the piston')
    call list%add('piston_offset', y(guide%offset%position), 'm', 'centre of mass of the piston from the cylinder axis')
    call list%add('piston_offset_rate', y(guide%offset%rate), 'm/s', 'its rate')
    call list%add('piston_tilt', y(guide%tilt%position), 'rad', 'tilt of the piston')
    call list%add('piston_tilt_rate', y(guide%tilt%rate), 'rad/s', 'its rate')
    if (guide%touching > 0) then
      do i = 1, n_corners
        call list%add(trim(corner_names(i))//'_contact', touches(i), '1: this corner of the skirt is in contact')
      end do
      call list%add('guide_impact_speed', guide%impact_speed, 'm/s', 'speeds at which their present or last contacts began')
    end if
    if (.not. list%sets) return
    guide%touches = touches > 0
    if (abs(clearance - guide%clearance) > 0) then
      y([guide%offset%position, guide%tilt%position]) = guide%clearance/clearance*y([guide%offset%position, guide%tilt%position])
      guide%touches = .false.   ! `complete_state` of the scene finds them
    end if
  end subroutine declare_place

  !> Penetrations of the corners, their rates and normal forces: all that follows from the state without the motion of the bodies.
  pure subroutine find_contact_state(self, y, corners)
    class(piston_guide_t), intent(in) :: self
    real(dp), intent(in) :: y(:)
    type(corner_t), intent(inout) :: corners(n_corners)
    type(tilting_t) :: tilting
    integer :: i
    if (self%touching == 0) return
    call self%read_state(y, tilting)
    call self%place_corners(tilting, corners)
    associate (element => self%slots(self%touching)%element)
      do i = 1, n_corners
        corners(i)%normal_force = element%normal_force(self%skirt_t, i, corners(i))
      end do
    end associate
  end subroutine find_contact_state

  !> Whether the state is admissible for every element and, with clearance, the position of the piston for the bore.
  pure logical function admits_state(self, y, tilting) result(admits)
    class(piston_guide_t), intent(in) :: self
    real(dp), intent(in) :: y(*)
    type(tilting_t), intent(in) :: tilting   !! not read without clearance
    integer :: k
    admits = .true.
    if (self%is_loose) admits = self%admits(tilting)
    do k = 1, self%n_elements
      if (admits) admits = self%slots(k)%element%admits(y, tilting)
    end do
  end function admits_state

  !> Loads of the bore on the piston. With clearance force and moment are set in those of the chain too; the friction is not.
  pure subroutine find_loads(self, motion, y, now, all)
    class(piston_guide_t), intent(in) :: self
    type(motion_t), intent(in) :: motion
    real(dp), intent(in) :: y(*)   !! the whole state vector
    type(guide_loads_t), intent(inout) :: now
    type(loads_t), intent(inout) :: all   !! on entry with the force of the gas alone along x
    integer :: k
    now%speed = motion%piston_velocity
    if (self%is_loose) now%speed = motion%tilting%com_velocity
    now%gas_force = all%axial_force
    now%friction_force = -0.0_dp   ! what is added to it keeps its sign, also as a zero
    now%friction_ratio = 0
    now%force = 0
    now%moment = 0
    now%springs_balance = .true.
    do k = 1, self%n_elements
      call self%slots(k)%element%find_loads(self%skirt_t, motion, y, now)
    end do
    if (.not. self%is_loose) return
    all%bore_force = now%force
    all%bore_moment = now%moment
  end subroutine find_loads

  !> Rates of the guide's states.
  pure subroutine set_rates(self, tilting, offset_acceleration, tilt_acceleration, now, dydt)
    class(piston_guide_t), intent(in) :: self
    type(tilting_t), intent(in) :: tilting
    real(dp), intent(in) :: offset_acceleration, tilt_acceleration   !! [m/s^2], [rad/s^2]
    type(guide_loads_t), intent(in) :: now
    real(dp), intent(inout) :: dydt(*)
    integer :: k
    if (self%is_loose) then
      dydt(self%offset%position) = tilting%offset_rate
      dydt(self%offset%rate) = offset_acceleration
      dydt(self%tilt%position) = tilting%tilt_rate
      dydt(self%tilt%rate) = tilt_acceleration
    end if
    if (self%n_states == 0) return
    do k = 1, self%n_elements
      associate (element => self%slots(k)%element)
        dydt(element%states%first:element%states%last) = now%rates(element%rates%first:element%rates%last)
      end associate
    end do
  end subroutine set_rates
end module piston_guide
