!> The runs of a study: for each run the values of its parameters as texts. The run uses exactly the values in these texts, so that
!> every row of the results can be repeated as a single run.
module study_design
  use, intrinsic :: iso_fortran_env, only: int64
  use gudgeon_kinds, only: dp
  use gudgeon_errors, only: error_t, fail, status_case_file
  use text_tools, only: printable, integer_text
  use number_text, only: number_writer_t, longest_number
  use study_definition, only: study_t, parameter_t
  use study_table, only: study_table_t, read_table
  use random_numbers, only: random_numbers_t
  use sobol_points, only: sobol_points_t, most_dimensions
  implicit none
  private
  public :: study_design_t, new_design

  integer, parameter :: most_runs = 10000000

  type :: study_design_t
    integer :: runs = 0
    integer :: text_length = 1                          !! length of the longest value
    character(len=:), allocatable :: keys(:)            !! GROUP.KEY of each parameter
    logical, allocatable :: is_whole(:)  !! parameters whose ranges are of whole numbers; must be set before `get_values` is called
    type(study_table_t) :: table                        !! without rows for a design over parameters
    type(parameter_t), allocatable, private :: axes(:)
    real(dp), allocatable, private :: fraction(:, :)    !! relative position in the range, (parameters, runs), for a Latin hypercube
    type(sobol_points_t), private :: sobol              !! prepared for a design of Sobol's points
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
      design%text_length = design%table%longest
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
    if (study%design /= 'grid') runs = study%runs
    if (runs > most_runs) then
      call fail(error, printable(study%file, 200)//': the grid has more than '//integer_text(most_runs)//' runs', &
                status_case_file)
      return
    end if
    design%runs = int(runs)
    if (study%design == 'latin_hypercube') call fill_hypercube(design, study%seed)
    if (study%design == 'sobol') call begin_sobol(study, design, error)
  end subroutine new_design

  !> Latin hypercube (McKay, Beckman and Conover 1979): each range is divided into as many equal parts as there are runs. Every part
  !> contains one run, at a random position; for each parameter a random permutation assigns the parts to the runs.
  subroutine fill_hypercube(design, seed)
    type(study_design_t), intent(inout) :: design
    integer, intent(in) :: seed
    type(random_numbers_t) :: random
    integer :: permutation(design%runs), i, k, other, kept
    real(dp) :: u
    call random%begin(seed)
    allocate (design%fraction(size(design%axes), design%runs))
    do i = 1, size(design%axes)
      permutation = [(k, k=0, design%runs - 1)]
      do k = design%runs, 2, -1
        call random%below(k, other)
        kept = permutation(k)
        permutation(k) = permutation(other + 1)
        permutation(other + 1) = kept
      end do
      do k = 1, design%runs
        call random%uniform(u)
        design%fraction(i, k) = (permutation(k) + u)/design%runs
      end do
    end do
  end subroutine fill_hypercube

  !> Sobol's points 0, 1, ...; a seed other than 0 adds a random digital shift in every dimension.
  subroutine begin_sobol(study, design, error)
    type(study_t), intent(in) :: study
    type(study_design_t), intent(inout) :: design
    type(error_t), allocatable, intent(out) :: error
    type(random_numbers_t) :: random
    real(dp) :: u
    integer :: i
    if (size(design%axes) > most_dimensions) then
      call fail(error, printable(study%file, 200)//': design = ''sobol'' takes up to '//integer_text(most_dimensions)// &
                ' parameters', status_case_file)
      return
    end if
    call design%sobol%prepare(size(design%axes))
    if (study%seed == 0) return
    call random%begin(study%seed)
    do i = 1, size(design%axes)
      call random%uniform(u)
      design%sobol%shift(i) = int(u*2.0_dp**32, int64)
    end do
  end subroutine begin_sobol

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
    real(dp) :: fraction
    if (self%table%rows > 0) then
      do i = 1, size(values)
        values(i) = self%table%field(i, run)
      end do
      return
    end if
    rest = run - 1
    do i = size(self%axes), 1, -1
      associate (axis => self%axes(i))
        if (allocated(self%fraction)) then
          fraction = self%fraction(i, run)
          level = int(fraction*axis%levels())
        else if (allocated(self%sobol%direction)) then
          fraction = self%sobol%coordinate(run - 1, i)
          level = int(fraction*axis%levels())
        else
          level = mod(rest, axis%levels())
          rest = rest/axis%levels()
          fraction = real(level, dp)/max(1, axis%levels() - 1)
        end if
        if (size(axis%list) > 0) then
          values(i) = axis%list(level + 1)%text
        else
          call put_number(self%numbers, axis, self%is_whole(i), fraction, values(i))
        end if
      end associate
    end do
  end subroutine get_values

  !> The number at a relative position in a range.
  pure subroutine put_number(numbers, p, is_whole, fraction, text)
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
  end subroutine put_number
end module study_design
