!> Tables of numbers from the folder data.
module data_tables
  use kinds, only: dp
  implicit none
  private
  public :: load_table

contains

  !> Read a table of numbers from data/: the names of its columns, cut at 40 characters, and its values (columns, rows).
  subroutine load_table(name, names, values)
    character(len=*), intent(in) :: name
    character(len=40), allocatable, intent(out) :: names(:)
    real(dp), allocatable, intent(out) :: values(:, :)
    character(len=2000) :: line
    integer :: unit, status, i, rows, commas
    open (newunit=unit, file='data/'//name, status='old', action='read')
    read (unit, '(a)') line
    commas = count([(line(i:i) == ',', i=1, len_trim(line))])
    allocate (names(commas + 1), values(commas + 1, 3000))
    names = split(line, commas + 1)
    rows = 0
    do
      read (unit, *, iostat=status) values(:, rows + 1)
      if (status /= 0) exit
      rows = rows + 1
    end do
    close (unit)
    values = values(:, :rows)
  end subroutine load_table

  !> The fields of a line, split at commas (list-directed input would stop at the / of a unit).
  pure function split(line, n) result(fields)
    character(len=*), intent(in) :: line
    integer, intent(in) :: n
    character(len=40) :: fields(n)
    integer :: i, first, next
    first = 1
    do i = 1, n
      next = index(line(first:)//',', ',')
      fields(i) = line(first:first + next - 2)
      first = first + next
    end do
  end function split
end module data_tables
