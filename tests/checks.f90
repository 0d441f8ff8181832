!> The test harness: named assertions; failures are printed at once.
!>
!> An assertion is identified by its suite and its name without digits: an assertion that is made a thousand times in a loop, or at
!> several tolerances, counts once. It passes if it holds each time.
module checks
  use, intrinsic :: iso_fortran_env, only: output_unit, int64
  use, intrinsic :: ieee_arithmetic, only: ieee_is_nan
  use kinds, only: dp
  implicit none
  private
  public :: checks_t, without_figures

  integer, parameter :: most_printed = 5   !! failures of one assertion that are printed
  character(len=*), parameter :: letters = 'ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz'

  !> One assertion, and how often it was made.
  type :: assertion_t
    character(len=:), allocatable :: name   !! suite, and name without numbers
    integer :: turns = 0
    integer :: failures = 0                 !! how often it failed
  end type assertion_t

  !> The assertions of one test run. A check prints only when it fails.
  type :: checks_t
    logical :: is_silent = .false.     !! print nothing, because failures are intended
    character(len=:), allocatable, private :: suite
    type(assertion_t), allocatable, private :: assertion(:)
    integer, allocatable, private :: place(:)   !! index of an assertion by the hash of its name, 0: none
    integer, private :: n = 0                   !! number of assertions
  contains
    procedure :: begin_suite   !! the assertions that follow belong to this suite
    procedure :: passed        !! number of assertions that never failed
    procedure :: failed        !! number of assertions that failed at least once
    procedure :: say_unprinted !! print the number of failures that were not printed
    procedure :: that          !! a condition holds
    procedure :: close_to      !! |got - want| <= tolerance
    procedure :: relative      !! |got - want| <= tolerance*|want|
    procedure :: equal_text    !! two texts are the same
    procedure :: begins_with
    procedure, private :: record
    procedure, private :: find
    procedure, private :: enlarge
  end type checks_t

contains

  subroutine begin_suite(self, name)
    class(checks_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    self%suite = name
  end subroutine begin_suite

  pure integer function passed(self)
    class(checks_t), intent(in) :: self
    passed = self%n - self%failed()
  end function passed

  pure integer function failed(self)
    class(checks_t), intent(in) :: self
    failed = 0
    if (self%n > 0) failed = count(self%assertion(:self%n)%failures > 0)
  end function failed

  subroutine say_unprinted(self)
    class(checks_t), intent(in) :: self
    integer :: i
    do i = 1, self%n
      associate (one => self%assertion(i))
        if (one%failures > most_printed) write (output_unit, '(3a,i0,a,i0,a)') 'FAILED: ', one%name, ': ', one%failures, ' of ', &
          one%turns, ' turns'
      end associate
    end do
  end subroutine say_unprinted

  subroutine that(self, condition, name)
    class(checks_t), intent(inout) :: self
    logical, intent(in) :: condition
    character(len=*), intent(in) :: name
    call self%record(condition, name, '')
  end subroutine that

  !> A NaN never passes.
  subroutine close_to(self, got, want, tolerance, name)
    class(checks_t), intent(inout) :: self
    real(dp), intent(in) :: got, want, tolerance
    character(len=*), intent(in) :: name
    character(len=120) :: figures
    logical :: is_close
    is_close = .false.   ! comparing a NaN would trap if floating-point traps are set
    if (.not. ieee_is_nan(got - want)) is_close = abs(got - want) <= tolerance
    write (figures, '(a,es23.16,a,es23.16,a,es8.1)') ': got ', got, ', want ', want, ' within ', tolerance
    call self%record(is_close, name, trim(figures))
  end subroutine close_to

  subroutine relative(self, got, want, tolerance, name)
    class(checks_t), intent(inout) :: self
    real(dp), intent(in) :: got, want, tolerance
    character(len=*), intent(in) :: name
    call self%close_to(got, want, tolerance*abs(want), name)
  end subroutine relative

  subroutine equal_text(self, got, want, name)
    class(checks_t), intent(inout) :: self
    character(len=*), intent(in) :: got, want, name
    call self%record(got == want .and. len(got) == len(want), name, ': got "'//got//'", want "'//want//'"')
  end subroutine equal_text

  !> Text that begins with another, such as a list of names that may become longer.
  subroutine begins_with(self, got, want, name)
    class(checks_t), intent(inout) :: self
    character(len=*), intent(in) :: got, want, name
    call self%record(index(got, want) == 1, name, ': got "'//got//'", want "'//want//'..."')
  end subroutine begins_with

  !> Count the assertion `name` once, with what was found.
  subroutine record(self, condition, name, found)
    class(checks_t), intent(inout) :: self
    logical, intent(in) :: condition
    character(len=*), intent(in) :: name, found
    integer :: i
    i = self%find(name)
    associate (one => self%assertion(i))
      one%turns = one%turns + 1
      if (condition) return
      one%failures = one%failures + 1
      if (one%failures <= most_printed .and. .not. self%is_silent) &
        write (output_unit, '(5a)') 'FAILED: ', self%suite, ': ', name, found
    end associate
  end subroutine record

  !> The index of an assertion of the present suite; a new index if it has not been made before.
  integer function find(self, name)
    class(checks_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    character(len=:), allocatable :: full
    integer :: slot
    if (.not. allocated(self%suite)) self%suite = 'tests'
    call self%enlarge()
    full = self%suite//': '//without_figures(trim(name))
    slot = 1 + int(modulo(hash(full), int(size(self%place), int64)))
    do
      find = self%place(slot)
      if (find == 0) exit
      if (self%assertion(find)%name == full) return
      slot = 1 + modulo(slot, size(self%place))
    end do
    self%n = self%n + 1
    find = self%n
    self%assertion(find)%name = full
    self%place(slot) = find
  end function find

  !> Make room for one more assertion.
  subroutine enlarge(self)
    class(checks_t), intent(inout) :: self
    type(assertion_t), allocatable :: larger(:)
    integer :: i, slot
    if (allocated(self%assertion)) then
      if (self%n < size(self%assertion)) return
    end if
    allocate (larger(max(512, 2*self%n)))
    if (self%n > 0) larger(:self%n) = self%assertion(:self%n)
    call move_alloc(larger, self%assertion)
    if (allocated(self%place)) deallocate (self%place)
    allocate (self%place(2*size(self%assertion)))
    self%place = 0
    do i = 1, self%n
      slot = 1 + int(modulo(hash(self%assertion(i)%name), int(size(self%place), int64)))
      do while (self%place(slot) > 0)
        slot = 1 + modulo(slot, size(self%place))
      end do
      self%place(slot) = i
    end do
  end subroutine enlarge

  !> A hash of a text.
  pure integer(int64) function hash(text)
    character(len=*), intent(in) :: text
    integer(int64), parameter :: modulus = 2147483647_int64
    integer :: i
    hash = 1
    do i = 1, len(text)
      hash = modulo(257*hash + iachar(text(i:i)), modulus)
    end do
  end function hash

  !> The name with every number replaced by '#'. A number consists of digits, points, signs and exponents and begins where a word
  !> may begin. Digits inside a word, as in `dry_0100um`, are kept.
  pure function without_figures(name) result(text)
    character(len=*), intent(in) :: name
    character(len=:), allocatable :: text
    integer :: i, j
    text = ''
    i = 1
    do while (i <= len(name))
      j = i
      if (begins_word(name, i)) j = i + number_length(name(i:))
      if (j > i) then
        text = text//'#'
        i = j
      else
        text = text//name(i:i)
        i = i + 1
      end if
    end do
  end function without_figures

  !> Whether no letter, digit or underscore precedes character i.
  pure logical function begins_word(name, i)
    character(len=*), intent(in) :: name
    integer, intent(in) :: i
    begins_word = i == 1
    if (i > 1) begins_word = scan(name(i - 1:i - 1), letters//'_0123456789') == 0
  end function begins_word

  !> Length of the number at the beginning of a text, 0 if there is none.
  pure integer function number_length(text)
    character(len=*), intent(in) :: text
    integer :: first
    number_length = 0
    first = verify(text, '+-.')
    if (first == 0) return
    if (scan(text(first:first), '0123456789') == 0) return
    number_length = verify(text(first:), '0123456789.+-eEdD') - 1
    if (number_length < 0) number_length = len(text) - first + 1
    number_length = number_length + first - 1
  end function number_length
end module checks
