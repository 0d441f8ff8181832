!> The runs of a study: for each run the values of its parameters as texts. The run uses exactly the values in these texts, so that
!> every row of the results can be repeated as a single run.
module study_design
  use, intrinsic :: iso_fortran_env, only: int64
  use kinds, only: dp
  use error_handling, only: error_t, fail, status_case_file
  use text_tools, only: printable, integer_text
  use number_text, only: number_writer_t, longest_number
  use study_definition, only: study_t, parameter_t
  use study_table, only: study_table_t, read_table
  implicit none
  private
  public :: study_design_t, new_design

  integer, parameter :: most_runs = 10000000

  type :: study_design_t
    integer :: runs = 0
    integer :: text_length = 1                          !! length of the longest value
    character(len=:), allocatable :: keys(:)            !! GROUP.KEY of each parameter
    logical, allocatable :: is_whole(:)  !! parameters whose ranges are of whole numbers; must be set before `get_values` is called
    type(study_table_t) :: table                        !! without rows for a grid
    type(parameter_t), allocatable, private :: axes(:)
    type(number_writer_t), private :: numbers
  contains
    procedure :: get_values
    procedure :: outermost
  end type study_design_t

contains

  !> Make the design of a study; numbers have `digits` significant digits. Errors: in the table, or more runs than allowed.
  subroutine new_design(study, digits, design, error)
    type(study_t), intent(in) :: study
    integer, intent(in) :: digits
    type(study_design_t), intent(out) :: design
    type(error_t), allocatable, intent(out) :: error
    integer(int64) :: runs
    integer :: i, k, longest

    call design%numbers%prepare(digits)
    if (study%table /= '') then
      call read_table(study%table, design%table, error)
      if (allocated(error)) error%message = printable(study%file, 200)//': &study table: '//error%message
      if (allocated(error)) return
      design%runs = design%table%rows
      design%text_length = max(design%table%longest, longest_number)
      allocate (design%keys, source=design%table%keys)
      return
    end if
    longest = maxval([(len(study%varied(i)%key), i=1, size(study%varied))])
    allocate (character(len=longest) :: design%keys(size(study%varied)))
    design%axes = study%varied
    allocate (design%is_whole(size(study%varied)), source=.false.)
    design%text_length = longest_number
    runs = 1
    do i = 1, size(design%axes)
      associate (p => design%axes(i))
        design%keys(i) = p%key
        runs = min(runs*p%levels(), 10_int64*most_runs)
        do k = 1, size(p%list)
          design%text_length = max(design%text_length, len(p%list(k)%text))
        end do
      end associate
    end do
    if (runs > most_runs) then
      call fail(error, printable(study%file, 200)//': the grid has more than '//integer_text(most_runs)//' runs', &
                status_case_file)
      return
    end if
    design%runs = int(runs)
  end subroutine new_design

  !> The run of a grid in which parameter i has its last value and all others have their first value.
  pure integer function outermost(self, i)
    class(study_design_t), intent(in) :: self
    integer, intent(in) :: i
    integer :: k
    outermost = self%axes(i)%levels() - 1
    do k = i + 1, size(self%axes)
      outermost = outermost*self%axes(k)%levels()
    end do
    outermost = outermost + 1
  end function outermost

  !> The values of a run, 1 to `runs`.
  pure subroutine get_values(self, run, values)
    class(study_design_t), intent(in) :: self
    integer, intent(in) :: run
    character(len=*), intent(out) :: values(:)   !! (parameters), of length text_length
    integer :: i, rest, level
    if (self%table%rows > 0) then
      do i = 1, size(values)
        values(i) = self%table%field(i, run)
      end do
      return
    end if
    rest = run - 1
    do i = size(self%axes), 1, -1
      associate (axis => self%axes(i))
        level = mod(rest, axis%levels())
        rest = rest/axis%levels()
        if (size(axis%list) > 0) then
          values(i) = axis%list(level + 1)%text
        else
          call write_number(self%numbers, axis, self%is_whole(i), real(level, dp)/max(1, axis%levels() - 1), values(i))
        end if
      end associate
    end do
  end subroutine get_values

  !> The number at a relative position in a range.
  pure subroutine write_number(numbers, p, is_whole, fraction, text)
    type(number_writer_t), intent(in) :: numbers
    type(parameter_t), intent(in) :: p
    logical, intent(in) :: is_whole
    real(dp), intent(in) :: fraction
    character(len=*), intent(out) :: text
    real(dp) :: number
    integer :: used
    if (p%scale == 'log') then
      number = exp((1 - fraction)*log(p%from) + fraction*log(p%to))
    else
      number = (1 - fraction)*p%from + fraction*p%to
    end if
    text = ''
    used = 0
    if (is_whole) then
      write (text, '(i0)') nint(number, int64)
    else
      call numbers%append(text, used, number)
    end if
  end subroutine write_number
end module study_design
