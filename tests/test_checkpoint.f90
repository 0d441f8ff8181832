!> Checkpoints: what is restored, what is refused, what the checksum detects, and the identity of a run.
module test_checkpoint
  use, intrinsic :: iso_fortran_env, only: int64
  use gudgeon_kinds, only: dp
  use gudgeon_errors, only: error_t, status_case_file
  use gudgeon_archive, only: archive_t
  use gudgeon_checksum, only: checksum_t
  use gudgeon_checkpoint, only: checkpoint_t, file_mark_t
  use run_identity, only: program_identity, identity_of, compare_cases
  use text_file, only: read_whole
  use result_file, only: result_file_t
  use gudgeon_posix, only: make_directory, remove_file
  use checks, only: checks_t
  implicit none
  private
  public :: run_test_checkpoint

  character(len=*), parameter :: folder = 'build/test_checkpoint', n = achar(10)

contains

  subroutine run_test_checkpoint(check)
    class(checks_t), intent(inout) :: check
    integer :: status
    call make_directory(folder, status)
    call test_checksum(check)
    call test_mark(check)
    call test_round_trip(check)
    call test_damage(check)
    call test_comparison(check)
    call test_identity(check)
    call execute_command_line('rmdir '//folder, exitstat=status)
    call check%that(status == 0, 'nothing is left in the scratch folder')
  end subroutine run_test_checkpoint

  !> Known values of CRC-64, computed in one piece and in every two pieces.
  subroutine test_checksum(check)
    class(checks_t), intent(inout) :: check
    type(checksum_t) :: sum
    character(len=256) :: all_bytes
    integer(int64) :: whole
    integer :: i
    call check%that(sum%sum == 0, 'checksum of no bytes')
    call sum%add('123456789')
    call check%that(sum%sum == -7395533204333446662_int64 .and. sum%hexadecimal() == '995DC9BBDF1939FA', &
      'checksum of 123456789: 995DC9BBDF1939FA')
    do i = 1, 256
      all_bytes(i:i) = achar(i - 1)
    end do
    sum = checksum_t()
    call sum%add(all_bytes)
    call check%that(sum%hexadecimal() == '72414B2F65DB3AB0', 'checksum of all bytes: 72414B2F65DB3AB0')
    whole = sum%sum
    do i = 1, 255
      sum = checksum_t()
      call sum%add(all_bytes(:i))
      call sum%add(all_bytes(i + 1:))
      call check%that(sum%sum == whole, 'checksum in two pieces')
    end do
  end subroutine test_checksum

  !> A mark that is advanced in steps equals that of the whole file; a file that is too short, or changed, is detected.
  subroutine test_mark(check)
    class(checks_t), intent(inout) :: check
    character(len=*), parameter :: path = folder//'/text'
    type(file_mark_t) :: whole, parts
    logical :: is_there
    integer :: status, i, same
    character(len=:), allocatable :: bytes
    call write_file(path, repeat('0123456789'//n, 300000))
    call whole%move_to(path, 3000000_int64, is_there)
    call check%that(is_there .and. whole%length == 3000000_int64, 'a mark at a position')
    call parts%move_to(path, 17_int64, is_there)
    call parts%move_to(path, 2000001_int64, is_there)
    call parts%move_to(path, 3000000_int64, is_there)
    call check%that(is_there .and. parts%checksum == whole%checksum, 'a mark reached in steps')
    call parts%move_to(path, 3300000_int64, is_there)
    call check%that(is_there .and. parts%checksum /= whole%checksum, 'a mark at the end')
    call parts%move_to(path, 3300001_int64, is_there)
    call check%that(.not. is_there, 'a file that is too short has no mark')
    parts = file_mark_t()
    call parts%move_to(folder//'/none', 5_int64, is_there)
    call check%that(.not. is_there, 'a file that does not exist has no mark')
    bytes = repeat('0123456789'//n, 50)
    call write_file(path, bytes)
    whole = file_mark_t()
    call whole%move_to(path, 500_int64, is_there)
    same = 0
    do i = 1, 500   ! every byte is changed
      call write_file(path, bytes(:i - 1)//'x'//bytes(i + 1:))
      parts = file_mark_t()
      call parts%move_to(path, 500_int64, is_there)
      if (parts%checksum == whole%checksum) same = same + 1
      parts = file_mark_t()
      call parts%move_to(path, int(i - 1, int64), is_there)
      if (parts%checksum == whole%checksum) same = same + 1
    end do
    call check%that(is_there .and. same == 0, 'every change of a byte is detected')
    call remove_file(path, status)
  end subroutine test_mark

  subroutine test_round_trip(check)
    class(checks_t), intent(inout) :: check
    type(checkpoint_t) :: saved, loaded
    type(error_t), allocatable :: error
    logical :: found
    integer :: status
    call fill(saved)
    call saved%save(error)
    call check%that(.not. allocated(error), 'a checkpoint is written')
    loaded%path = saved%path
    call loaded%load(found, error)
    call check%that(found .and. .not. allocated(error), 'a checkpoint is read')
    call check%equal_text(loaded%identity, '0123456789ABCDEF', 'identity in a checkpoint')
    call check%that(loaded%case_text == saved%case_text .and. loaded%state == saved%state .and. &
      .not. abs(loaded%wall_time - 2.5_dp) > 0 .and. loaded%mark(1)%length == 3_int64 .and. &
      loaded%mark(2)%checksum == -7, 'a checkpoint is restored unchanged')
    call remove_file(loaded%path, status)
    call loaded%load(found, error)
    call check%that(.not. found .and. .not. allocated(error), 'a missing checkpoint is not an error')
    saved%path = folder//'/none/a.checkpoint'
    call saved%save(error)
    call check%that(allocated(error), 'a checkpoint that cannot be written is an error')
  end subroutine test_round_trip

  !> Checkpoints with each byte changed, with each shorter length, with additional bytes, and files of other kinds.
  subroutine test_damage(check)
    class(checks_t), intent(inout) :: check
    type(checkpoint_t) :: saved
    type(error_t), allocatable :: error
    character(len=:), allocatable :: bytes, changed
    integer :: i, k, status, accepted
    call fill(saved)
    call saved%save(error)
    call read_whole(saved%path, bytes, status)
    call check%that(status == 0 .and. len(bytes) > 300, 'the bytes of a checkpoint')
    accepted = 0
    do i = 1, len(bytes)
      do k = 0, 7, 7
        changed = bytes
        changed(i:i) = achar(ieor(ichar(bytes(i:i)), 2**k))
        call try(changed)
      end do
      call try(bytes(:i - 1))
    end do
    call check%that(accepted == 0, 'a checkpoint with a changed byte or a lost end is refused')
    call try(bytes//' ')
    call try(bytes//bytes)
    call check%that(accepted == 0, 'a checkpoint with additional bytes is refused')
    call try('')
    call try('time[s]'//n)
    call try(repeat(achar(0), 5000))
    call check%that(accepted == 0, 'other files are refused')
    call try(of_version(4))
    call check%that(accepted == 0, 'another version of the format is refused')
    call try(of_version(5))
    call check%that(accepted == 1, 'the present version of the format is accepted')
    call remove_file(saved%path, status)

  contains

    !> Count a file of these bytes if it is not refused.
    subroutine try(bytes)
      character(len=*), intent(in) :: bytes
      type(checkpoint_t) :: loaded
      type(error_t), allocatable :: error
      logical :: found
      call write_file(saved%path, bytes)
      loaded%path = saved%path
      call loaded%load(found, error)
      if (.not. refused(found, error, saved%path)) accepted = accepted + 1
    end subroutine try

    !> The checkpoint with another number of its format, and the correct checksum.
    function of_version(version) result(text)
      integer, intent(in) :: version
      character(len=:), allocatable :: text
      type(checksum_t) :: sum
      character(len=8) :: mark
      character(len=4) :: number
      integer :: at
      text = bytes(:len(bytes) - 8)
      at = index(text, n) + 6   ! behind the kind and the count of the first entry
      text(at:at + 3) = transfer(version, number)
      call sum%add(text)
      text = text//transfer(sum%sum, mark)
    end function of_version
  end subroutine test_damage

  !> The same case and program have the same identity for any limits; another value, the ideal twin or a missing line change it.
  subroutine test_identity(check)
    class(checks_t), intent(inout) :: check
    character(len=*), parameter :: case = '&joint'//n//'  clearance = 1'//n//'/'//n//'&integrator'//n
    character(len=16) :: identity, program
    program = program_identity()
    call check%equal_text(program_identity(), program, 'a program has one identity')
    identity = identity_of(case//'  max_steps = 0'//n//'/'//n, program)
    call check%that(verify(identity, '0123456789ABCDEF') == 0, 'an identity is 16 digits')
    call check%equal_text(identity_of(case//'  max_steps = 700'//n//'/'//n, program), identity, &
      'a limit does not change the identity')
    call check%equal_text(identity_of(case//'/'//n, program), identity, 'a limit that is left out does not change the identity')
    call check%that(identity_of(case//'  max_step = 0'//n//'/'//n, program) /= identity, 'another key changes the identity')
    call check%that(identity_of('ideal twin', identity) /= identity, 'the ideal twin has another identity')
    call check%that(identity_of('&joint'//n//'  clearance = 2'//n//'/'//n//'&integrator'//n//'/'//n, program) /= identity, &
      'another value changes the identity')
    program = 'another program '
    call check%that(identity_of(case//'/'//n, program) /= identity, 'another program changes the identity')
  end subroutine test_identity

  !> Cases are compared without the limits, and the message names a difference.
  subroutine test_comparison(check)
    class(checks_t), intent(inout) :: check
    character(len=*), parameter :: one = '&joint'//n//'  clearance = 1  ! m'//n//'/'//n//'&integrator'//n//'  max_steps = 0'//n// &
      '  max_step = 1'//n//'/'//n
    character(len=*), parameter :: other = '&joint'//n//'  clearance = 1  ! m'//n//'/'//n//'&integrator'//n// &
      '  max_steps = 100'//n//'  max_step = 2'//n//'/'//n
    character(len=:), allocatable :: difference
    call compare_cases(one, one, difference)
    call check%equal_text(difference, '', 'a case equals itself')
    call compare_cases(one, other, difference)
    call check%equal_text(difference, '&integrator max_step = 1, but the stopped run has max_step = 2', 'a key differs')
    call compare_cases(one, other(:index(other, '  max_step =') - 1)//'  max_step = 1'//n//'/'//n, difference)
    call check%equal_text(difference, '', 'a limit may differ')
    call compare_cases(one, one//'&output'//n//'/'//n, difference)
    call check%that(index(difference, '&output') > 0, 'an additional group is a difference')
    call compare_cases('', one, difference)
    call check%that(difference /= '', 'a case and an empty text differ')
  end subroutine test_comparison

  subroutine fill(checkpoint)
    type(checkpoint_t), intent(out) :: checkpoint
    type(archive_t) :: archive
    real(dp) :: numbers(20)
    integer :: i
    numbers = [(sqrt(real(i, dp)), i=1, 20)]
    call archive%begin_writing()
    call archive%exchange(numbers)
    checkpoint%path = folder//'/a.checkpoint'
    checkpoint%identity = '0123456789ABCDEF'
    checkpoint%case_text = '&joint'//n//'/'//n
    checkpoint%wall_time = 2.5_dp
    checkpoint%mark(1)%length = 3
    checkpoint%mark(2)%checksum = -7
    call archive%contents(checkpoint%state)
  end subroutine fill

  logical function refused(found, error, word)
    logical, intent(in) :: found
    type(error_t), allocatable, intent(in) :: error
    character(len=*), intent(in) :: word
    refused = allocated(error) .and. .not. found
    if (refused) refused = error%status == status_case_file .and. index(error%message, word) > 0 .and. &
      index(error%message, n) == 0
  end function refused

  subroutine write_file(path, bytes)
    character(len=*), intent(in) :: path, bytes
    type(result_file_t) :: file
    type(error_t), allocatable :: error
    call file%open(path, error)
    call file%put(bytes)
    call file%close(error)
  end subroutine write_file
end module test_checkpoint
