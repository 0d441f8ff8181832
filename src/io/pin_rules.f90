!> Rules of the piston pin: which of its two joints exist, and what a pin that floats needs.
module pin_rules
  use case_definition, only: case_t
  use case_values, only: case_values_t
  use pin_case, only: pin_floating
  use joint_places, only: places, joint_group, piston_pin, small_end
  implicit none
  private
  public :: check_piston_pin, provide_film_moments

contains

  !> Let the shear of the films act on the bodies where the piston pin floats, unless the case says something else: this is put into
  !> the values too.
  subroutine provide_film_moments(values, into)
    type(case_values_t), intent(inout) :: values
    type(case_t), intent(inout) :: into
    integer :: place, key
    if (.not. into%has_floating_pin()) return
    do place = 1, size(places)
      if (.not. allocated(into%joints(place)%film)) cycle
      key = values%place_of(values%law_group('lubrication', place), 'film_moment')
      if (values%values(key)%given(1)) cycle
      into%joints(place)%film%film_moment = .true.
      values%values(key)%switch = .true.
    end do
  end subroutine provide_film_moments

  !> Note the errors of the group pin, and of the joints at both ends of the piston pin beside it.
  subroutine check_piston_pin(c, values)
    type(case_t), intent(in) :: c
    type(case_values_t), intent(inout) :: values
    character(len=*), parameter :: keys(2) = [character(len=7) :: 'mass', 'inertia']
    integer :: i
    if (allocated(c%pin)) then
      do i = 1, size(keys)
        if (c%has_floating_pin()) then
          call values%demand(values%is_said(values%place_of('pin', trim(keys(i)))), 'pin', trim(keys(i)), &
            'with kind = ''floating''')
        else
          call values%forbid(values%is_said(values%place_of('pin', trim(keys(i)))), 'pin', trim(keys(i)), &
            'is for kind = ''floating'': else the '//trim(keys(i))//' of the pin belongs to '//c%pin%kind)
        end if
      end do
    end if
    if (c%has_floating_pin()) then
      call values%forbid(.not. all(c%joints([piston_pin, small_end])%has_clearance()), 'pin', 'kind', &
        'needs two joints with kind = ''clearance'', place = ''piston_pin'' and place = ''small_end''')
      do i = 1, size(places)
        if (any(i == [piston_pin, small_end])) call check_film(i)
      end do
    else
      call values%forbid(values%is_said(values%place_of('initial', 'pin_speed')), 'initial', 'pin_speed', &
        'is for &pin kind = '''//pin_floating//''' alone')
      call values%forbid(c%joints(small_end)%has_bearing() .and. .not. c%may_have_joint(small_end), joint_group(small_end), &
        'kind', 'needs &pin kind = ''piston'' or ''floating'': without it the pin is fixed in the rod, its bearing in the piston')
      call values%forbid(c%joints(piston_pin)%has_bearing() .and. .not. c%may_have_joint(piston_pin), joint_group(piston_pin), &
        'kind', 'must be ideal with &pin kind = ''piston'', whose bearing is in the rod: place = ''small_end''')
      if (c%joints(small_end)%has_bearing()) call check_film(small_end)
    end if

  contains

    !> Check that the film of a joint knows the speed of its journal, and turns a floating pin.
    subroutine check_film(place)
      integer, intent(in) :: place
      character(len=:), allocatable :: group
      associate (joint => c%joints(place))
        if (.not. allocated(joint%film)) return
        group = values%law_group('lubrication', place)
        call values%forbid(.not. joint%film%gives_pressure(), group, 'law', &   ! that of an oscillating pin
          'follows the motion of an ideal mechanism, for &pin kind = ''rod'' alone; finite_bearing, for example, can')
        if (.not. c%has_floating_pin()) return
        call values%forbid(.not. joint%film%film_moment, group, 'film_moment', &
          'must be .true. with a floating pin: the shear of the films turns it')
      end associate
    end subroutine check_film
  end subroutine check_piston_pin
end module pin_rules
