!> A table of results, `quantity,value,unit`. The unit of a quantity is that of its declaration.
module result_table
  use kinds, only: dp
  use row_text, only: row_text_t
  use summary_quantities, only: quantities_of_runs, unit_of
  use number_text, only: real_text
  use text_tools, only: integer_text, next_line, replaced
  implicit none
  private
  public :: result_table_t

  type, extends(row_text_t) :: result_table_t
    integer :: digits = 10   !! significant digits: those of the trace, so that no row of it exceeds an extreme by rounding
  contains
    generic :: add => add_real, add_integer, add_words
    procedure, private :: add_real, add_integer, add_words
    procedure :: add_numbered
    procedure :: add_with_unit
    procedure :: add_notes
  end type result_table_t

contains

  !> Add a row. `prefix` is the place of the quantity, or PHASE_ of the declared name; `for` stands for NAME or N in it.
  pure subroutine add_words(self, name, value, prefix, for)
    class(result_table_t), intent(inout) :: self
    character(len=*), intent(in) :: name   !! as it is declared
    character(len=*), intent(in) :: value
    character(len=*), intent(in), optional :: prefix, for
    character(len=:), allocatable :: whole
    whole = name
    if (present(for)) whole = replaced(replaced(name, 'NAME', for), 'N', for)
    if (present(prefix)) whole = prefix//replaced(whole, 'PHASE_', '')
    call self%add_text(whole)
    call self%add_text(value)
    call self%add_text(unit_of(quantities_of_runs, name))
    call self%end_row()
  end subroutine add_words

  !> Add a row whose own name has numbers in the place of letters of the declared one. It has a value unless it has a text.
  pure subroutine add_numbered(self, declared, name, value, text)
    class(result_table_t), intent(inout) :: self
    character(len=*), intent(in) :: declared, name
    real(dp), intent(in) :: value
    character(len=*), intent(in), optional :: text
    call self%add_text(name)
    if (present(text)) then
      call self%add_text(text)
    else
      call self%add_text(real_text(value, self%digits))
    end if
    call self%add_text(unit_of(quantities_of_runs, declared))
    call self%end_row()
  end subroutine add_numbered

  !> Add a row of a quantity that is not declared: a result that is kept of a column.
  pure subroutine add_with_unit(self, name, value, unit)
    class(result_table_t), intent(inout) :: self
    character(len=*), intent(in) :: name, unit
    real(dp), intent(in) :: value
    call self%add_text(name)
    call self%add_text(real_text(value, self%digits))
    call self%add_text(unit)
    call self%end_row()
  end subroutine add_with_unit

  !> Add a row `note_N` for each line of a text that is not empty.
  subroutine add_notes(self, notes)
    class(result_table_t), intent(inout) :: self
    character(len=*), intent(in) :: notes
    character(len=:), allocatable :: line
    integer :: at, number
    at = 1
    number = 0
    do while (at <= len(notes))
      call next_line(notes, at, line)
      if (line == '') cycle
      number = number + 1
      call self%add('note_N', line, for=integer_text(number))
    end do
  end subroutine add_notes

  pure subroutine add_real(self, name, value, prefix, for)
    class(result_table_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    real(dp), intent(in) :: value
    character(len=*), intent(in), optional :: prefix, for
    call self%add(name, real_text(value, self%digits), prefix, for)
  end subroutine add_real

  pure subroutine add_integer(self, name, value, prefix, for)
    class(result_table_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    integer, intent(in) :: value
    character(len=*), intent(in), optional :: prefix, for
    call self%add(name, integer_text(value), prefix, for)
  end subroutine add_integer
end module result_table
