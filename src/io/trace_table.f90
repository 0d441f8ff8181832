!> Writes NAME.csv, the trace of a run: rows of numbers; the phase is one digit.
module trace_table
  use gudgeon_kinds, only: dp
  use gudgeon_columns, only: column_list_t
  use number_writer, only: number_writer_t, longest_number
  use result_file, only: result_file_t
  implicit none
  private
  public :: trace_table_t

  type :: trace_table_t
    type(number_writer_t) :: numbers
    integer, private :: phase_column = 1   !! index of the phase's column; the last index plus one if there is none
  contains
    procedure :: prepare
    procedure :: put_row
  end type trace_table_t

contains

  !> Prepare the table before the first row; numbers have `digits` significant digits.
  subroutine prepare(self, list, digits)
    class(trace_table_t), intent(inout) :: self
    type(column_list_t), intent(in) :: list
    integer, intent(in) :: digits
    self%phase_column = findloc([list%names(list%id) == 'phase[-]', .true.], .true., 1)
    call self%numbers%prepare(digits)
  end subroutine prepare

  !> Add a row to a file, written directly into its buffer.
  subroutine put_row(self, values, file)
    class(trace_table_t), intent(in) :: self
    real(dp), intent(in), contiguous :: values(:)
    type(result_file_t), intent(inout) :: file
    call file%make_room((longest_number + 1)*size(values))
    associate (text => file%buffer, used => file%used, phase => self%phase_column)
      call self%numbers%append_list(text, used, values(:phase - 1))
      if (phase <= size(values)) then
        text(used + 1:used + 1) = achar(iachar('0') + int(values(phase)))
        text(used + 2:used + 2) = ','
        used = used + 2
        call self%numbers%append_list(text, used, values(phase + 1:))
      end if
      text(used:used) = achar(10)
    end associate
  end subroutine put_row
end module trace_table
