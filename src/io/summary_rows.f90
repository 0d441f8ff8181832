!> The rows of a table `quantity,value,unit`, read from its text.
module summary_rows
  use, intrinsic :: ieee_arithmetic, only: ieee_value, ieee_quiet_nan
  use kinds, only: dp
  use text_tools, only: next_line
  implicit none
  private
  public :: summary_row_t, read_rows

  !> A quantity of a summary.
  type :: summary_row_t
    character(len=:), allocatable :: name, unit, text
    real(dp) :: value = 0   !! not a number if it is a word
  end type summary_row_t

contains

  !> All rows of a summary or, without its header, of a part of one.
  subroutine read_rows(table, rows)
    character(len=*), intent(in) :: table
    type(summary_row_t), allocatable, intent(out) :: rows(:)
    type(summary_row_t), allocatable :: found(:)
    character(len=:), allocatable :: line
    integer :: at, n, first, last, ios
    allocate (found(count([(table(at:at) == achar(10), at=1, len(table))])))
    at = 1
    n = 0
    do while (at <= len(table))
      call next_line(table, at, line)
      if (line == '' .or. line == 'quantity,value,unit') cycle
      n = n + 1
      first = index(line, ',')
      last = index(line, ',', back=.true.)
      associate (row => found(n))
        row%name = line(:first - 1)
        row%unit = line(last + 1:)
        row%text = line(first + 1:last - 1)
        if (index(row%text, '"') == 1) row%text = row%text(2:len(row%text) - 1)
        row%value = ieee_value(1.0_dp, ieee_quiet_nan)
        if (verify(row%text, '+-.0123456789eE') > 0 .or. scan(row%text, '0123456789') == 0) cycle
        read (row%text, *, iostat=ios) row%value
        if (ios /= 0) row%value = ieee_value(1.0_dp, ieee_quiet_nan)
      end associate
    end do
    rows = found(:n)
  end subroutine read_rows
end module summary_rows
