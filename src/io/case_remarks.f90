!> The remarks on the values of a case: what is said of a key, and which keys are remarkable already.
module case_remarks
  use kinds, only: dp
  use case_schema, only: find_group, shown_group
  use case_values, only: case_values_t
  use number_text, only: short_text
  use text_tools, only: integer_text, replaced
  use unit_hints, only: likely_unit
  use value_reader, only: n_values, read_bounds, is_default
  implicit none
  private
  public :: remarks_t

  type :: remarks_t
    character(len=:), allocatable :: notes   !! each ends with a line end
    type(case_values_t), pointer :: values => null()
    logical, allocatable, private :: is_noted(:), is_unusual(:)   !! for each key
  contains
    procedure :: begin
    procedure :: add_line
    procedure :: expect
    procedure :: remark
    procedure :: any_remarkable
    procedure :: any_in
    procedure :: is_given
    procedure :: note_sizes
    procedure, private :: note
    procedure, private :: note_size
    procedure, private :: unusual_element
    procedure, private :: meant_unit
  end type remarks_t

contains

  !> Begin without remarks, and find the keys with a number that is not of a usual size. 0 is never unusual: no unit makes it so.
  subroutine begin(self, values)
    class(remarks_t), intent(out) :: self
    type(case_values_t), intent(in), target :: values   !! must stay as long as the remarks
    integer :: place
    self%notes = ''
    self%values => values
    allocate (self%is_noted(size(values%keys)), self%is_unusual(size(values%keys)), source=.false.)
    do place = 1, size(values%keys)
      self%is_unusual(place) = self%unusual_element(place) > 0
    end do
  end subroutine begin

  !> Note all keys with a number that is not of a usual size and that are not noted yet.
  subroutine note_sizes(self)
    class(remarks_t), intent(inout) :: self
    integer :: i
    do i = 1, size(self%is_unusual)
      if (self%is_unusual(i)) call self%note_size(i)
    end do
  end subroutine note_sizes

  !> Whether a key of a group is of an unusual size or noted.
  logical function any_in(self, group)
    class(remarks_t), intent(in) :: self
    character(len=*), intent(in) :: group
    any_in = any(self%values%keys%group == group .and. (self%is_unusual .or. self%is_noted))
  end function any_in

  !> Add a note.
  subroutine add_line(self, text)
    class(remarks_t), intent(inout) :: self
    character(len=*), intent(in) :: text
    self%notes = self%notes//text//achar(10)
  end subroutine add_line

  !> The element of the key at `place` that is not of a usual size; 0 if all are, or the key is not used.
  integer function unusual_element(self, place) result(element)
    class(remarks_t), intent(in) :: self
    integer, intent(in) :: place
    real(dp) :: least, most
    associate (key => self%values%keys(place), value => self%values%values(place))
      element = 0
      if (key%usual == '' .or. .not. any(value%given)) return
      if (.not. (self%values%is_present(find_group(self%values%groups, trim(key%group))) .and. self%values%is_used(place))) return
      call read_bounds(trim(key%usual), least, most)
      do element = 1, n_values(key, value)
        if (.not. abs(value%reals(element)) > 0) cycle
        if (is_default(key, value, element)) cycle   ! as in a resolved case
        if (abs(value%reals(element)) < least .or. abs(value%reals(element)) > most) return
      end do
      element = 0
    end associate
  end function unusual_element

  !> Note a key for its size, if no relation has noted it.
  subroutine note_size(self, place)
    class(remarks_t), intent(inout) :: self
    integer, intent(in) :: place
    real(dp) :: least, most
    integer :: element
    if (self%is_noted(place)) return
    element = self%unusual_element(place)
    associate (key => self%values%keys(place), number => self%values%values(place)%reals(element))
      call read_bounds(trim(key%usual), least, most)
      call self%note(place, ': usually '//trim(key%usual)//self%meant_unit(place, number, least, most), element)
    end associate
  end subroutine note_size

  !> Note a key: group, key, value and unit, followed by what is remarkable.
  subroutine note(self, place, text, element)
    class(remarks_t), intent(inout) :: self
    integer, intent(in) :: place
    character(len=*), intent(in) :: text
    integer, intent(in) :: element
    character(len=:), allocatable :: line
    self%is_noted(place) = .true.
    associate (key => self%values%keys(place))
      line = shown_group(trim(key%group))//' '//trim(key%name)
      if (element > 1) line = line//'['//integer_text(element)//']'
      line = line//' = '//trim(self%values%values(place)%written(element))
      if (key%unit /= '' .and. .not. self%values%values(place)%has_unit) line = line//' '//trim(key%unit)
      call self%add_line(line//text)
    end associate
  end subroutine note

  !> The unit that was probably meant, of a number without a unit.
  function meant_unit(self, place, number, least, most) result(text)
    class(remarks_t), intent(in) :: self
    integer, intent(in) :: place
    real(dp), intent(in) :: number, least, most
    character(len=:), allocatable :: text
    text = ''
    if (.not. self%values%values(place)%has_unit) text = likely_unit(trim(self%values%keys(place)%unit), number, least, most)
  end function meant_unit

  !> Note a number whose ratio to `scale` should be from `least` to `most`. In `says` # stands for this ratio and @ for the scale;
  !> `hint` is what may have been meant instead, if no other unit explains the number.
  subroutine expect(self, group, name, number, scale, least, most, says, others, hint)
    class(remarks_t), intent(inout) :: self
    character(len=*), intent(in) :: group, name
    real(dp), intent(in) :: number                !! in the unit of the key
    real(dp), intent(in) :: scale, least, most    !! least 0: there is no lower limit
    character(len=*), intent(in) :: says, others  !! see `remark`
    character(len=*), intent(in), optional :: hint
    real(dp), parameter :: rounding = 1e-9_dp, near = 4   !! times the largest ratio: no other unit, but a hint explains that
    character(len=:), allocatable :: text, usual, meant
    real(dp) :: ratio
    if (.not. (abs(number) > 0 .and. scale > 0)) return
    ratio = abs(number)/scale
    if (ratio >= least*(1 - rounding) .and. ratio <= most*(1 + rounding)) return
    usual = ', usually '//short_text(least)//' to '//short_text(most)
    if (.not. least > 0) usual = ', usually up to '//short_text(most)
    meant = self%meant_unit(self%values%place_of(group, name), number, least*scale, most*scale)
    if (present(hint) .and. (meant == '' .or. ratio < near*most)) meant = ': '//hint//'?'
    text = replaced(replaced(says, '#', short_text(ratio, 3)), '@', short_text(scale))
    call self%remark(group, name, text//usual//meant, others)
  end subroutine expect

  !> Note a key for its relation to others, unless the user has not set it, it is noted already, or one of the `others` is
  !> remarkable itself: then that one is wrong.
  subroutine remark(self, group, name, text, others)
    class(remarks_t), intent(inout) :: self
    character(len=*), intent(in) :: group, name, text
    character(len=*), intent(in) :: others   !! GROUP.KEY of other keys, separated by blanks
    integer :: place
    place = self%values%place_of(group, name)
    if (self%is_noted(place) .or. .not. any(self%values%values(place)%given)) return
    if (.not. self%any_remarkable(others)) call self%note(place, ' '//text, 1)
  end subroutine remark

  !> Whether one of the keys in a list is of an unusual size or noted.
  logical function any_remarkable(self, list)
    class(remarks_t), intent(in) :: self
    character(len=*), intent(in) :: list   !! GROUP.KEY, separated by blanks
    integer :: first, length, dot, place
    any_remarkable = .false.
    first = 1
    do while (first <= len(list))
      length = index(list(first:)//' ', ' ') - 1
      dot = index(list(first:first + length - 1), '.', back=.true.)
      place = self%values%place_of(list(first:first + dot - 2), list(first + dot:first + length - 1))
      if (place > 0) any_remarkable = any_remarkable .or. self%is_unusual(place) .or. self%is_noted(place)
      first = first + length + 1
    end do
  end function any_remarkable

  !> Whether the case gives a key itself.
  logical function is_given(self, group, name)
    class(remarks_t), intent(in) :: self
    character(len=*), intent(in) :: group, name
    is_given = any(self%values%values(self%values%place_of(group, name))%given)
  end function is_given
end module case_remarks
