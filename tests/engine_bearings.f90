!> Tables of data/film/engine, and results of the library in their columns.
module engine_bearings
  use kinds, only: dp
  use film_results, only: film_row_t
  implicit none
  private
  public :: word_length, read_table, words_of, result_names, results_of

  integer, parameter :: word_length = 40

  character(len=*), parameter :: folder = 'data/film/engine/'

  !> The columns of results that all bearings have.
  character(len=word_length), parameter :: result_names(11) = [character(len=word_length) :: 'time[s]', &
    'eccentricity_x[m]', 'eccentricity_y[m]', &
    'film_force_x[N]', 'film_force_y[N]', 'min_film_thickness[m]', 'max_film_pressure[Pa]', 'film_fill[-]', 'supply_flow[m3/s]', &
    'side_flow[m3/s]', 'film_moment[N.m]']

contains

  !> A table of numbers (rows, columns) and its heads.
  subroutine read_table(file, heads, values)
    character(len=*), intent(in) :: file
    character(len=word_length), allocatable, intent(out) :: heads(:)
    real(dp), allocatable, intent(out) :: values(:, :)
    character(len=400) :: line
    integer :: unit, status, rows, i
    open (newunit=unit, file=folder//file, status='old', action='read')
    read (unit, '(a)') line
    heads = words_of(line)
    rows = 0
    do
      read (unit, '(a)', iostat=status) line
      if (status /= 0) exit
      rows = rows + 1
    end do
    allocate (values(rows, size(heads)))
    rewind (unit)
    read (unit, '(a)') line
    do i = 1, rows
      read (unit, *) values(i, :)
    end do
    close (unit)
  end subroutine read_table

  !> The texts between the commas of a line. (To read them as a list would end at the slash of a unit.)
  pure function words_of(line) result(words)
    character(len=*), intent(in) :: line
    character(len=word_length), allocatable :: words(:)
    integer :: first, last, k
    allocate (words(count(transfer(line, ['a'], len(line)) == ',') + 1))
    first = 1
    do k = 1, size(words)
      last = first + index(line(first:)//',', ',') - 2
      words(k) = line(first:last)
      first = last + 2
    end do
  end function words_of

  !> The columns of results of rows, as in `result_names`.
  pure function results_of(rows) result(values)
    type(film_row_t), intent(in) :: rows(:)
    real(dp) :: values(size(rows), size(result_names))
    integer :: i
    do i = 1, size(rows)
      associate (row => rows(i))
        values(i, :) = [row%time, row%eccentricity, row%force, row%min_thickness, row%max_pressure, row%fill, row%supply_flow, &
          row%side_flow, row%moment]
      end associate
    end do
  end function results_of
end module engine_bearings
