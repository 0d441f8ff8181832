!> The way into a group that a case may have for all joints or for one: by an override, a parameter of a study, or a program that
!> sets one of its keys.
module own_groups
  use error_handling, only: error_t, fail, status_case_file
  use joint_places, only: places, n_places, in_order, joint_group
  use case_schema, only: find_group, is_apart
  use case_values, only: case_values_t
  implicit none
  private
  public :: enter_group

contains

  !> Make a group present before its key is set. A group of one joint begins with the values of the group for all joints, if the
  !> case has that. Error: the group for all joints, where the case has groups of single joints and no joint follows the one for
  !> all: the key would act elsewhere or nowhere.
  subroutine enter_group(values, name, key, at, error)
    type(case_values_t), intent(inout) :: values
    character(len=*), intent(in) :: name, key, at   !! group of the table; .KEY, =none or nothing; origin in messages
    type(error_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: own, has, write
    integer :: group, common, i, dot
    group = find_group(values%groups, name)
    dot = index(name, '.')
    if (dot == 0) then
      if (values%is_present(group) .and. (name == 'joint' .or. key == '=none' .or. is_followed(values, name))) return
      has = ''
      write = ''
      do i = 1, n_places
        own = trim(places(in_order(i))%name)//'.'//name
        if (.not. has_group(values, own)) cycle
        has = has//' and '//trim(places(in_order(i))%name)
        write = write//' or '//own//key
      end do
      if (has /= '' .and. .not. (name == 'joint' .and. key == '.kind')) then
        call fail(error, at//'&'//name//': the case has this group for '//has(6:)//': write '//write(5:), status_case_file)
        return
      end if
    else if (.not. (values%is_present(group) .or. is_apart(values%groups(group))) .and. has_group(values, name(dot + 1:))) then
      common = find_group(values%groups, name(dot + 1:))
      if (values%groups(common)%is_law) then
        do i = values%groups(group)%first, values%groups(group)%last
          values%values(i) = values%values(values%place_of(name(dot + 1:), trim(values%keys(i)%name)))
          values%values(i)%is_override = .false.
          values%values(i)%replaces = .false.
        end do
      end if
    end if
    values%is_present(group) = .true.
  end subroutine enter_group

  !> Whether a joint follows the group of a law for all joints: it is not ideal and has no such group of its own.
  pure logical function is_followed(values, name)
    type(case_values_t), intent(in) :: values
    character(len=*), intent(in) :: name
    integer :: i, kind
    is_followed = .false.
    do i = 1, n_places
      kind = values%place_of(joint_group(i), 'kind')
      if (kind == 0 .or. has_group(values, trim(places(i)%name)//'.'//name)) cycle
      is_followed = is_followed .or. has_group(values, joint_group(i)) .and. values%values(kind)%text /= 'ideal'
    end do
  end function is_followed

  pure logical function has_group(values, name)
    type(case_values_t), intent(in) :: values
    character(len=*), intent(in) :: name
    integer :: group
    group = find_group(values%groups, name)
    has_group = .false.
    if (group > 0) has_group = values%is_present(group)
  end function has_group
end module own_groups
