!> Files of states, NAME.state.nml: the state that a run has reached, and from which another run may start. The group &initial holds
!> the motion, the group &so_far what the run has counted. Without &so_far a run begins at t = 0 with that motion.
module state_file
  use kinds, only: dp
  use error_handling, only: error_t, fail, status_case_file
  use run_state, only: run_state_t, state_number_t
  use case_definition, only: case_t
  use case_values, only: case_values_t
  use posix_files, only: absolute_path
  use namelist_reader, only: namelist_t, read_namelist
  use number_text, only: exact_text
  use text_file, only: read_text_file
  use result_file, only: write_text
  use text_tools, only: printable, integer_text, path_beside
  implicit none
  private
  public :: write_state, provide_state, reached, state_suffix

  character(len=*), parameter :: state_suffix = '.state.nml'
  character(len=*), parameter :: groups(2) = [character(len=7) :: 'initial', 'so_far']
  character(len=*), parameter :: newline = achar(10)
  integer, parameter :: largest_file = 10   !! MB
  integer, parameter :: in_a_line = 4       !! numbers

contains

  !> Write BASE.state.nml with a state that a run of the case in a file has reached. Error: it cannot be written.
  subroutine write_state(state, file, base, error)
    type(run_state_t), intent(in) :: state
    character(len=*), intent(in) :: file, base
    type(error_t), allocatable, intent(out) :: error
    call write_text(base//state_suffix, state_text(state, 'State of '//printable(file, 200)//': gudgeon '//printable(file, 200)// &
      ' --from '//printable(base, 200)//state_suffix//' goes on from it'), error)
  end subroutine write_state

  !> A state as text, with a heading.
  function state_text(state, heading) result(text)
    type(run_state_t), intent(in) :: state
    character(len=*), intent(in) :: heading
    character(len=:), allocatable :: text, line
    integer :: group, i, k
    text = '! '//heading//newline
    do group = 1, size(groups)
      text = text//newline//'&'//trim(groups(group))//newline
      do i = 1, size(state%numbers)
        associate (number => state%numbers(i))
          if (number%is_total .neqv. group == 2) cycle
          line = '  '//trim(number%name)//' ='
          do k = 1, size(number%values)
            if (k > 1) line = line//','
            if (k > 1 .and. mod(k, in_a_line) == 1) line = line//newline//'   '
            if (number%is_whole) then
              line = line//' '//integer_text(nint(number%values(k)))
            else
              line = line//' '//exact_text(number%values(k))
            end if
          end do
          line = line//'   ! '//number%says
          if (number%unit /= '') line = line//' ['//trim(number%unit)//']'
          text = text//line//newline
        end associate
      end do
      text = text//'/'//newline
    end do
  end function state_text

  !> Read the state from which a case starts, unless it has been read before. In the values its file is then named by its absolute
  !> path. If the file cannot be read, or is no file of a state, this is noted in the values.
  subroutine provide_state(values, into)
    type(case_values_t), intent(inout) :: values
    type(case_t), intent(inout) :: into
    type(error_t), allocatable :: error
    type(run_state_t), allocatable :: state
    character(len=:), allocatable :: path, text
    type(namelist_t) :: list
    integer :: place
    if (into%initial%from == '') return
    path = absolute_path(path_beside(into%file, into%initial%from))
    place = values%place_of('initial', 'from')
    values%values(place)%text = path
    if (allocated(into%initial%state)) then
      if (into%initial%state%file == path) return
    end if
    call read_text_file(path, largest_file, 'file of a state', text, error)
    if (.not. allocated(error)) call read_namelist(text, path, list, error)
    if (.not. allocated(error)) then
      allocate (state)
      state%file = path
      call read_state(list, state, error)
    end if
    if (allocated(error)) then
      call values%refuse_file('initial', 'from', error)
    else
      call move_alloc(state, into%initial%state)
    end if
  end subroutine provide_state

  !> What the state in a file has reached, with the option that goes on from it; empty if there is none.
  function reached(path) result(text)
    character(len=*), intent(in) :: path
    character(len=:), allocatable :: text, content
    type(namelist_t) :: list
    type(error_t), allocatable :: error
    integer :: i
    text = ''
    call read_text_file(path, largest_file, 'file of a state', content, error)
    if (.not. allocated(error)) call read_namelist(content, path, list, error)
    if (allocated(error)) return
    do i = 1, size(list%entries)
      associate (entry => list%entries(i))
        if (entry%group == groups(2) .and. entry%key == 'time') text = ' at t = '//printable(entry%tokens(1)%text, 40)// &
          ' s; --from '//printable(path, 200)//' would have gone on from there'
      end associate
    end do
  end function reached

  !> The numbers of a file.
  subroutine read_state(list, state, error)
    type(namelist_t), intent(in) :: list
    type(run_state_t), intent(inout) :: state
    type(error_t), allocatable, intent(out) :: error
    type(state_number_t) :: number
    integer :: i, k
    do i = 1, size(list%groups)
      if (all(groups /= list%groups(i)%name)) call refuse(list%groups(i)%line, '&'//printable(list%groups(i)%name, 48)// &
        ': the file of a state has the groups &initial and &so_far')
      if (allocated(error)) return
    end do
    allocate (state%numbers(0))
    do i = 1, size(list%entries)
      associate (entry => list%entries(i))
        number%name = entry%key
        number%is_total = entry%group == groups(2)
        if (entry%index > 0) call refuse_key('takes no index')
        do k = 1, size(state%numbers)
          if (state%numbers(k)%name == number%name .and. (state%numbers(k)%is_total .eqv. number%is_total)) &
            call refuse_key('given twice')
        end do
        allocate (number%values(sum(entry%tokens%repeat)))
        call read_numbers()
        if (allocated(error)) return
        state%numbers = [state%numbers, number]
        deallocate (number%values)
      end associate
    end do

  contains

    subroutine refuse(line, message)
      integer, intent(in) :: line
      character(len=*), intent(in) :: message
      if (.not. allocated(error)) call fail(error, list%at(line)//message, status_case_file)
    end subroutine refuse

    subroutine refuse_key(message)
      character(len=*), intent(in) :: message
      associate (entry => list%entries(i))
        call refuse(entry%line, '&'//entry%group//' '//printable(entry%key, 48)//': '//message)
      end associate
    end subroutine refuse_key

    !> Read the numbers of an entry: unlike those of a case they may have any size.
    subroutine read_numbers()
      real(dp) :: value
      integer :: at, status
      at = 0
      do k = 1, size(list%entries(i)%tokens)
        associate (token => list%entries(i)%tokens(k))
          value = 0
          status = 1
          if (.not. token%quoted .and. verify(token%text, '+-.0123456789eEdD') == 0) read (token%text, *, iostat=status) value
          if (status /= 0 .or. .not. abs(value) <= huge(value)) &
            call refuse_key('must be a number, not '//printable(token%text, 40))
          number%values(at + 1:at + token%repeat) = value
          at = at + token%repeat
        end associate
      end do
    end subroutine read_numbers
  end subroutine read_state
end module state_file
