!> The identity of a run. Results, checkpoint and summary belong to the same run and case if their identities are equal.
module run_identity
  use, intrinsic :: iso_c_binding, only: c_long
  use, intrinsic :: iso_fortran_env, only: compiler_version, compiler_options
  use gudgeon_kinds, only: dp
  use gudgeon_checksum, only: checksum_t
  use gudgeon_posix, only: open_file, to_read, read_at, close_file
  use text_file, only: read_whole
  use text_tools, only: next_line
  use gudgeon_version, only: program_version
  implicit none
  private
  public :: identity_length, program_identity, identity_of, compare_cases

  integer, parameter :: identity_length = 16   !! hexadecimal digits
  character(len=*), parameter :: newline = achar(10)

  !> Keys of a case that may change between a run and its continuation: limits at which a run gives up, and the path of a table
  !> whose content is described by another key.
  character(len=*), parameter :: free_keys(5) = [character(len=30) :: 'max_steps', 'max_evaluations', &
    'max_evaluations_per_revolution', 'table', 'torque_table']

contains

  !> A digest of the program file, and of the rounding of its functions on this machine.
  function program_identity() result(identity)
    character(len=identity_length) :: identity
    type(checksum_t) :: sum
    call sum%add(program_version//newline//compiler_version()//newline//compiler_options()//newline)
    call add_program(sum)
    call add_functions(sum)
    identity = sum%hexadecimal()
  end function program_identity

  !> A digest of everything on which the results of a run depend: the program, and the resolved case without the keys that may
  !> change. That of the ideal twin is the digest of the text 'ideal twin' and the identity of the run instead of a program.
  function identity_of(case_text, program) result(identity)
    character(len=*), intent(in) :: case_text                 !! the resolved case
    character(len=identity_length), intent(in) :: program     !! identity of the program
    character(len=identity_length) :: identity
    type(checksum_t) :: sum
    character(len=:), allocatable :: line
    integer :: at
    call sum%add(program)
    at = 1
    do while (at <= len(case_text))
      call next_fixed_line(case_text, at, line)
      call sum%add(line//newline)
    end do
    identity = sum%hexadecimal()
  end function identity_of

  !> Add the program to a checksum: the first page of its file, which contains a digest of the whole file (the build id of the
  !> linker); without a build id, the whole file.
  subroutine add_program(sum)
    type(checksum_t), intent(inout) :: sum
    character(len=*), parameter :: file = '/proc/self/exe', build_id = achar(3)//repeat(achar(0), 3)//'GNU'//achar(0)
    character(len=4096) :: page
    character(len=:), allocatable :: bytes
    integer :: descriptor, status, done, ignored
    done = 0
    call open_file(file, to_read, descriptor, status)
    if (status == 0) then
      call read_at(descriptor, 0_c_long, page, done, status)
      call close_file(descriptor, ignored)
    end if
    if (index(page(:max(0, done)), build_id) > 0) then
      call sum%add(page(:done))
    else
      call read_whole(file, bytes, status)
      call sum%add(bytes)
    end if
  end subroutine add_program

  !> Add the values of elementary functions at a thousand points: the C library has several versions of them, selects one for the
  !> processor, and these round differently at about one point in a thousand.
  pure subroutine add_functions(sum)
    type(checksum_t), intent(inout) :: sum
    integer, parameter :: points = 1000
    real(dp) :: x, values(7)
    character(len=8*size(values)) :: bytes
    integer :: i
    do i = 1, points
      x = 0.0137_dp*i
      values = [sin(x), cos(x), tan(x), exp(-x), log(x), x**1.5_dp, atan2(x, 3.0_dp)]
      bytes = transfer(values, bytes)
      call sum%add(bytes)
    end do
  end subroutine add_functions

  !> The first difference of two resolved cases, apart from the keys that may change: group and line of each. `difference` is empty
  !> if there is none.
  subroutine compare_cases(case_text, earlier, difference)
    character(len=*), intent(in) :: case_text, earlier
    character(len=:), allocatable, intent(out) :: difference
    character(len=:), allocatable :: line, other, group
    integer :: at, other_at
    difference = ''
    group = ''
    at = 1
    other_at = 1
    do while (difference == '' .and. (at <= len(case_text) .or. other_at <= len(earlier)))
      call next_fixed_line(case_text, at, line)
      call next_fixed_line(earlier, other_at, other)
      if (line == other) then
        if (index(line, '&') == 1) group = line
      else
        difference = group//' '//trim(adjustl(line))//', but the stopped run has '//trim(adjustl(other))
        if (index(line//other, '&') > 0) difference = 'the groups '//line//' and '//other//' differ from those of the stopped run'
      end if
    end do
  end subroutine compare_cases

  !> The next line from position `at` on that does not belong to a key that may change; `at` is moved behind it.
  subroutine next_fixed_line(text, at, line)
    character(len=*), intent(in) :: text
    integer, intent(inout) :: at
    character(len=:), allocatable, intent(out) :: line
    character(len=len(free_keys)) :: key
    do
      call next_line(text, at, line)
      key = adjustl(line(:index(line, ' =')))
      if (key == '' .or. all(free_keys /= key)) return
    end do
  end subroutine next_fixed_line
end module run_identity
