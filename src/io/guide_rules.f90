!> Rules that the values of a case with a guide that is not ideal must obey together.
module guide_rules
  use gudgeon_kinds, only: dp
  use gudgeon_constants, only: two_pi
  use gudgeon_errors, only: error_t
  use number_text, only: short_text
  use case_definition, only: case_t
  use case_values, only: case_values_t
  use ambrosio, only: ambrosio_t
  use piston_guide, only: piston_guide_t, corner_t, n_corners
  use chain_motion, only: tilting_t
  implicit none
  private
  public :: check_guide, bore_reach

contains

  !> Largest distance of the pin's bearing from the cylinder's axis that the bore allows [m].
  pure real(dp) function bore_reach(c)
    type(case_t), intent(in) :: c
    bore_reach = 0
    if (.not. c%has_loose_guide()) return
    associate (guide => c%guide)   ! the piston is tilted until top and bottom of the skirt touch opposite walls
      bore_reach = guide%bore_clearance + abs(guide%piston_com(2))
      if (guide%skirt_top + guide%skirt_bottom > 0) &
        bore_reach = bore_reach + abs(guide%piston_com(1))*2*guide%bore_clearance/(guide%skirt_top + guide%skirt_bottom)
    end associate
  end function bore_reach

  !> Check that a guide has the keys of its kind, that its friction does not jam the piston, and that the piston starts in its bore.
  subroutine check_guide(c, values, error)
    type(case_t), intent(in) :: c
    type(case_values_t), intent(in) :: values
    type(error_t), allocatable, intent(out) :: error
    if (c%has_loose_guide()) then
      call check_clearance()
      if (.not. allocated(error)) call check_piston_start()
    else
      call check_on_axis()
    end if
    if (allocated(error) .or. .not. allocated(c%guide)) return
    if (allocated(c%guide%friction)) call check_friction()

  contains

    !> The error for a value of the case.
    subroutine refuse(group, name, wanted)
      character(len=*), intent(in) :: group, name, wanted
      call values%refuse(group, name, wanted, error)
    end subroutine refuse

    !> Check that the dimensions of the skirt, the piston's inertia and a stiffness are given.
    subroutine check_clearance()
      character(len=*), parameter :: needed(6) = [character(len=14) :: 'bore_clearance', 'skirt_top', 'skirt_bottom', &
        'piston_radius', 'piston_inertia', 'stiffness']
      integer :: i
      do i = 1, size(needed)
        if (values%is_said(values%place_of('guide', trim(needed(i))))) cycle
        if (values%is_given('guide', trim(needed(i)))) then
          call refuse('guide', trim(needed(i)), 'must be > 0')
        else
          call refuse('guide', trim(needed(i)), 'required with kind = ''clearance''')
        end if
        return
      end do
      if (values%is_said(values%place_of('guide', 'dissipation'))) call values%check_family('guide', 'dissipation', error)
    end subroutine check_clearance

    !> Check that a piston without clearance starts on the cylinder's axis.
    subroutine check_on_axis()
      character(len=*), parameter :: keys(4) = [character(len=18) :: 'piston_offset', 'piston_offset_rate', 'piston_tilt', &
        'piston_tilt_rate']
      integer :: i
      do i = 1, size(keys)
        if (.not. values%is_said(values%place_of('initial', trim(keys(i))))) cycle
        call refuse('initial', trim(keys(i)), 'must be 0 without clearance in the bore (&guide kind = ''clearance'')')
        return
      end do
      if (.not. allocated(c%guide)) return
      if (values%is_said(values%place_of('guide', 'bore_clearance')) .and. .not. values%is_given('guide', 'kind')) &
        call refuse('guide', 'bore_clearance', 'needs kind = ''clearance''; the default is friction')
    end subroutine check_on_axis

    !> Check that the friction law has no sticking, which the guide does not support, and that friction does not jam a piston with
    !> an ideal pin: an axial force causes a side force of at most tan A times its size, where A is at most arcsin R/L.
    subroutine check_friction()
      real(dp) :: most, speed
      select type (law => c%guide%friction)
      type is (ambrosio_t)
        if (law%coefficient > 0 .and. .not. law%v1 > 0) then
          call refuse('guide', 'v1', 'must be > 0: friction on the guide is a function of the speed')
          return
        end if
      end select
      if (c%has_loose_guide() .or. c%joint%has_clearance()) return
      associate (m => c%mechanism)
        speed = 2*m%crank_length*max(abs(c%initial%crank_speed), two_pi)
        most = sqrt((m%rod_length - m%crank_length)*(m%rod_length + m%crank_length))/m%crank_length
      end associate
      if (c%guide%most_friction(speed) < most) return
      call refuse('guide', 'coefficient', 'friction over normal force must stay < '//short_text(most)// &
        ', the least of rod_length cos A/(crank_length sin q): more would jam the piston')
    end subroutine check_friction

    !> Check that the piston starts in its bore, or with corners in the wall but not beyond it.
    subroutine check_piston_start()
      type(piston_guide_t) :: guide
      type(corner_t) :: corner(n_corners)
      type(tilting_t) :: at
      call c%guide%build(guide)
      at%offset = c%initial%piston_offset
      at%tilt = c%initial%piston_tilt
      at%offset_rate = 0
      at%tilt_rate = 0
      call guide%place_corners(at, corner)
      if (.not. guide%admits(at)) then
        if (abs(at%tilt) < 1) then
          call refuse('initial', 'piston_offset', 'must be shorter than bore_clearance + piston_radius')
        else
          call refuse('initial', 'piston_tilt', 'must be > -1 and < 1')
        end if
      else if (maxval(corner%depth) > c%guide%piston_radius) then
        call refuse('initial', 'piston_tilt', 'must not put a corner of the skirt into the bore''s wall by more than piston_radius')
      end if
    end subroutine check_piston_start
  end subroutine check_guide
end module guide_rules
