!> The parts of parameter studies: random numbers, Sobol's points, designs, tables, rows, files of rows, checksums.
module test_study
  use gudgeon_kinds, only: dp
  use checks, only: checks_t
  use gudgeon_errors, only: error_t
  use gudgeon_checksum, only: checksum_t
  use number_text, only: number_writer_t
  use gudgeon_posix, only: remove_file
  use random_numbers, only: random_numbers_t
  use sobol_points, only: sobol_points_t, most_dimensions
  use study_definition, only: study_t
  use study_file, only: read_study
  use study_design, only: study_design_t, new_design
  use study_table, only: study_table_t, parse_table
  use row_text, only: row_text_t
  use row_file, only: row_file_t
  implicit none
  private
  public :: run_test_study

  character(len=*), parameter :: n = achar(10), cr = achar(13), q = '"'
  character(len=*), parameter :: file = 'build/test_study.nml'

contains

  subroutine run_test_study(check)
    class(checks_t), intent(inout) :: check
    type(checksum_t) :: checksum
    call checksum%add('1234')
    call checksum%add('56789')
    call check%equal_text(checksum%hexadecimal(), '995DC9BBDF1939FA', 'check value of CRC-64/XZ, in two pieces')
    call test_random_numbers(check)
    call test_sobol(check)
    call test_grid(check)
    call test_hypercube(check)
    call test_sobol_design(check)
    call test_tables(check)
    call a_long_table_takes_time_as_its_length(check)
    call test_row_text(check)
    call test_row_file(check)
  end subroutine run_test_study

  !> The first numbers of all six components from the state 12345, and the sum of 10,000, from integer arithmetic of any length.
  subroutine test_random_numbers(check)
    class(checks_t), intent(inout) :: check
    type(random_numbers_t) :: random, other
    real(dp), parameter :: first(4) = [0.12701112204657714_dp, 0.3185275653967945_dp, 0.3091860155832701_dp, &
      0.8258468629271135_dp]
    real(dp) :: u, v, sum
    integer :: i, number
    logical :: differs, covers(0:2)
    sum = 0
    do i = 1, 10000
      call random%uniform(u)
      if (i <= size(first)) call check%relative(u, first(min(i, size(first))), 1e-15_dp, 'MRG32k3a')
      sum = sum + u
    end do
    call check%relative(sum, 5001.493769254248_dp, 1e-13_dp, 'MRG32k3a, sum of 10,000')
    differs = .true.
    covers = .false.
    call random%begin(0)
    call other%begin(1)
    do i = 1, 100
      call random%uniform(u)
      call other%uniform(v)
      differs = differs .and. abs(u - v) > 1e-9_dp
      call random%below(3, number)
      covers(number) = .true.
    end do
    call check%that(differs, 'seeds give different numbers')
    call check%that(all(covers), 'whole numbers below 3')
  end subroutine test_random_numbers

  !> Points 12345 and 54321 in all dimensions, times 2^16, from scipy.stats.qmc.Sobol.
  subroutine test_sobol(check)
    class(checks_t), intent(inout) :: check
    integer, parameter :: late(most_dimensions) = [38013, 38699, 48017, 12657, 26599, 37447, 44907, 29445, 62121, 32337, 5347, &
      16099, 40331, 58301, 43107, 55413, 8375, 52471, 53837, 56631, 33183]
    integer, parameter :: early(most_dimensions) = [42004, 53308, 10508, 34524, 58228, 3860, 8340, 7428, 52548, 28156, 4868, &
      39244, 61012, 61724, 2260, 41996, 4100, 3340, 20932, 22508, 13060]
    type(sobol_points_t) :: points
    integer :: d
    call points%prepare(most_dimensions)
    do d = 1, most_dimensions
      call check%close_to(points%coordinate(0, d), 0.0_dp, 0.0_dp, 'point 0')
      call check%close_to(points%coordinate(1, d), 0.5_dp, 0.0_dp, 'point 1')
      call check%that(int(65536*points%coordinate(12345, d)) == early(d), 'point 12345')
      call check%that(int(65536*points%coordinate(54321, d)) == late(d), 'point 54321')
    end do
  end subroutine test_sobol

  !> The design of a study with this text; the study must be correct.
  subroutine design_of(text, design)
    character(len=*), intent(in) :: text
    type(study_design_t), intent(out) :: design
    type(study_t) :: study
    type(error_t), allocatable :: error
    integer :: unit
    open (newunit=unit, file=file, status='replace', action='write')
    write (unit, '(a)') text
    close (unit)
    call read_study(file, study, error)
    if (.not. allocated(error)) call new_design(study, 10, design, error)
    if (allocated(error)) error stop 'test_study: a study is refused'
  end subroutine design_of

  !> A number of a run's values.
  real(dp) function value_of(design, run, parameter)
    type(study_design_t), intent(in) :: design
    integer, intent(in) :: run, parameter
    character(len=design%text_length) :: values(size(design%keys))
    call design%get_values(run, values)
    read (values(parameter), *) value_of
  end function value_of

  subroutine test_grid(check)
    class(checks_t), intent(inout) :: check
    type(study_design_t) :: design
    character(len=40) :: values(3)
    call design_of("&study case = 'x.nml' / &parameter key = 'a.b', from = 1, to = 100, count = 3, scale = 'log' /"//n// &
      "&parameter key = 'C.D', values = 'closed_form', as_printed / &parameter key = 'e.f', from = 5, to = 1, count = 5 /", design)
    design%is_whole(3) = .true.
    call check%that(design%runs == 30, 'runs of a grid')
    call check%that(all(design%keys == ['a.b', 'c.d', 'e.f']), 'keys in lower case')
    call design%get_values(1, values)
    call check%equal_text(trim(values(1))//' '//trim(values(2))//' '//trim(values(3)), '1.000000000E+00 closed_form 5', 'run 1')
    call design%get_values(17, values)
    call check%equal_text(trim(values(1))//' '//trim(values(2))//' '//trim(values(3)), '1.000000000E+01 as_printed 4', 'run 17')
    call design%get_values(30, values)
    call check%equal_text(trim(values(1))//' '//trim(values(2))//' '//trim(values(3)), '1.000000000E+02 as_printed 1', 'run 30')
    call remove_study()
  end subroutine test_grid

  !> In every dimension each of the equal parts has one point; another seed gives other points, the same seed the same.
  subroutine test_hypercube(check)
    class(checks_t), intent(inout) :: check
    type(study_design_t) :: design, other, same
    character(len=*), parameter :: axes = "&parameter key = 'a.b', from = 0, to = 1 / "// &
      "&parameter key = 'c.d', from = 1, to = 1000, scale = 'log' / &parameter key = 'e.f', values = 1, 2, 3, 4 /"
    integer :: part(64, 2), run, k, listed(4)
    real(dp) :: apart, product
    call design_of("&study case = 'x.nml', design = 'latin_hypercube', runs = 64, seed = 7 / "//axes, design)
    call design_of("&study case = 'x.nml', design = 'latin_hypercube', runs = 64, seed = 8 / "//axes, other)
    call design_of("&study case = 'x.nml', design = 'latin_hypercube', runs = 64, seed = 7 / "//axes, same)
    part = 0
    listed = 0
    apart = 0
    product = 0
    do run = 1, 64
      k = 1 + int(64*value_of(design, run, 1))
      part(k, 1) = part(k, 1) + 1
      k = 1 + int(64*log10(value_of(design, run, 2))/3)
      part(k, 2) = part(k, 2) + 1
      k = nint(value_of(design, run, 3))
      listed(k) = listed(k) + 1
      apart = max(apart, abs(value_of(design, run, 1) - value_of(same, run, 1)))
      product = product + abs(value_of(design, run, 1) - value_of(other, run, 1))/64
    end do
    call check%that(all(part == 1), 'one run in each part of each range')
    call check%that(all(listed == 16), 'each value of a list is used equally often')
    call check%that(.not. apart > 0, 'the same seed gives the same runs')
    call check%that(product > 0.2_dp, 'another seed gives other runs')
    call remove_study()
  end subroutine test_hypercube

  !> Without a seed the points of the sequence; with a seed they are shifted, and each part still has one point.
  subroutine test_sobol_design(check)
    class(checks_t), intent(inout) :: check
    type(study_design_t) :: design, shifted
    integer :: part(32), run, k
    character(len=*), parameter :: axes = "&parameter key = 'a.b', from = 2, to = 4 / &parameter key = 'c.d', from = 0, to = 1 /"
    call design_of("&study case = 'x.nml', design = 'sobol', runs = 32 / "//axes, design)
    call check%close_to(value_of(design, 1, 1), 2.0_dp, 0.0_dp, 'point 0')
    call check%close_to(value_of(design, 3, 1), 3.5_dp, 0.0_dp, 'point 2')
    call check%close_to(value_of(design, 3, 2), 0.25_dp, 0.0_dp, 'point 2, second dimension')
    call design_of("&study case = 'x.nml', design = 'sobol', runs = 32, seed = 5 / "//axes, shifted)
    part = 0
    do run = 1, 32
      k = 1 + int(32*value_of(shifted, run, 2))
      part(k) = part(k) + 1
    end do
    call check%that(all(part == 1), 'a shifted sequence has one point in each part')
    call check%that(abs(value_of(shifted, 1, 2) - value_of(design, 1, 2)) > 1e-6_dp, 'a seed shifts the sequence')
    call remove_study()
  end subroutine test_sobol_design

  subroutine remove_study()
    integer :: ignored
    call remove_file(file, ignored)
  end subroutine remove_study

  subroutine test_tables(check)
    class(checks_t), intent(inout) :: check
    type(study_table_t) :: table
    type(error_t), allocatable :: error
    character(len=:), allocatable :: text
    integer :: i
    text = char(239)//char(187)//char(191)//'A.b,'//q//'c.d'//q//cr//n//cr//n//' 1e-5 ,'//q//'2,'//q//q//n//'3'//q// &
      cr//n//',4'
    call parse_table(text, 't.csv', table, error)
    call check%that(.not. allocated(error), 'byte order mark, CR LF, quotes, an empty line, no last end of line')
    if (allocated(error)) return
    call check%that(table%rows == 2, 'rows')
    call check%equal_text(trim(table%keys(1))//' '//trim(table%keys(2)), 'a.b c.d', 'keys')
    call check%equal_text(trim(table%field(1, 1)), '1e-5', 'blanks around a field')
    call check%equal_text(trim(table%field(2, 1)), '2,'//q//n//'3', 'a quoted field')
    call check%equal_text(trim(table%field(1, 2)), '', 'an empty field')
    call check%equal_text(trim(table%field(2, 2)), '4', 'the last field')
    call check%that(all(table%lines(1:2) == [3, 5]), 'line numbers of the rows')
    text = "a.b"//n//"'=1+1"//n//q//"'-2,x"//q//n//"'''-a"//n//"'a'"//n//"'"//n//'-1'//n
    call parse_table(text, 't.csv', table, error)
    call check%that(table%rows == 6 .and. .not. allocated(error), 'a table of texts')
    call check%equal_text(trim(table%field(1, 1)), '=1+1', 'an apostrophe before a formula is removed')
    call check%equal_text(trim(table%field(1, 2)), '-2,x', 'an apostrophe in quotes is removed')
    call check%equal_text(trim(table%field(1, 3)), "''-a", 'one of three apostrophes is removed')
    call check%equal_text(trim(table%field(1, 4)), "'a'", 'apostrophes that are kept')
    call check%equal_text(trim(table%field(1, 5)), "'", 'a single apostrophe')
    call check%equal_text(trim(table%field(1, 6)), '-1', 'a number')
    text = 'a.b,c.d'//n
    do i = 1, 1000
      text = text//repeat('x', 5*mod(i, 7))//','//repeat('y', merge(20000, 1, i == 500))//n
    end do
    call parse_table(text, 't.csv', table, error)
    call check%that(table%rows == 1000 .and. table%longest == 20000, 'a table with one long field')
    call check%that(table%field(1, 499) == repeat('x', 10) .and. table%field(2, 500) == repeat('y', 20000) .and. &
                    table%field(1, 1000) == repeat('x', 30) .and. table%field(2, 1000) == 'y', &
                      'fields of a table with one long field')
    call refused(check, '', 't.csv: the table is empty; it needs a header of GROUP.KEY and a row for each run')
    call refused(check, 'a.b'//n, 't.csv: the table has a header but no run')
    call refused(check, 'a.b,c.d'//n//'1,2'//n//'3'//n, 't.csv:3: column 1: the header has 2 fields, this row fewer')
    call refused(check, 'a.b,c.d'//n//'1,2,3'//n, 't.csv:2: column 3: the header has 2 fields, this row more')
    call refused(check, 'a.b'//n//q//'1'//n, 't.csv:2: column 1: the quote '//q//' is not closed')
    call refused(check, 'a.b,c.d'//n//'1,2'//q//'3'//n, &
      't.csv:2: column 2: a quote inside a field that does not begin with one')
    call refused(check, 'a.b,c.d'//n//'1,'//q//'2'//q//'3'//n, 't.csv:2: column 2: text behind a closing quote')
    call refused(check, 'a.b,clearance'//n//'1,2'//n, 't.csv:1: column 2: '//q//'clearance'//q//' must have the form GROUP.KEY')
    call refused(check, 'a.b,A.B'//n//'1,2'//n, 't.csv:1: column 2: a.b is given twice')
  end subroutine test_tables

  !> The time for a table of 50,000 rows is at most 40 times that for one of 5,000, plus half a second.
  subroutine a_long_table_takes_time_as_its_length(check)
    class(checks_t), intent(inout) :: check
    type(study_table_t) :: table
    type(error_t), allocatable :: error
    character(len=:), allocatable :: text
    real(dp) :: times(0:2)
    integer :: i
    call cpu_time(times(0))
    do i = 1, 2
      text = 'a.b,c.d'//n//repeat('1.234567e-5, '//q//'2'//q//n, merge(5000, 50000, i == 1))
      call parse_table(text, 'long.csv', table, error)
      call cpu_time(times(i))
    end do
    call check%that(.not. allocated(error) .and. table%rows == 50000, 'a long table')
    call check%that(times(2) - times(1) < 40*(times(1) - times(0)) + 0.5_dp, 'time for a long table is proportional to its length')
  end subroutine a_long_table_takes_time_as_its_length

  subroutine refused(check, text, message)
    class(checks_t), intent(inout) :: check
    character(len=*), intent(in) :: text, message
    type(study_table_t) :: table
    type(error_t), allocatable :: error
    character(len=:), allocatable :: used
    used = text
    call parse_table(used, 't.csv', table, error)
    call check%that(allocated(error), 'error: '//message)
    if (allocated(error)) call check%equal_text(error%message, message, 'table')
  end subroutine refused

  subroutine test_row_text(check)
    class(checks_t), intent(inout) :: check
    type(row_text_t) :: row
    type(number_writer_t) :: numbers
    call numbers%prepare(10)
    call row%add_whole(0)
    call row%add_whole(-120)
    call row%add_text('a'//q//'b,c  ')
    call row%add_text('')
    call row%add_number(numbers, 1.5_dp)
    call row%end_row()
    call row%add_whole(huge(0))
    call check%equal_text(row%text(:row%used), '0,-120,'//q//'a'//q//q//'b,c'//q//',,1.500000000E+00'//n//'2147483647', 'a row')
    call row%clear()
    call row%add_text('=1+1')
    call row%add_text('+a')
    call row%add_text('-2,x')
    call row%add_text('@a')
    call row%add_text(achar(9)//'a')
    call row%add_text("''-a")
    call row%add_text('-1.5e-5  ')
    call row%add_text("'a=b'")
    call row%add_text("'")
    call check%equal_text(row%text(:row%used), "'=1+1,'+a,"//q//"'-2,x"//q//",'@a,'"//achar(9)//"a,'''-a,-1.5e-5,'a=b','", &
      'texts that begin like formulas')
  end subroutine test_row_text

  !> Rows in any order are sorted by run, incomplete rows and those of excluded runs are removed, and the counts agree.
  subroutine test_row_file(check)
    class(checks_t), intent(inout) :: check
    character(len=*), parameter :: path = 'build/test_rows.csv', header = 'run,x,y'//n
    character(len=1), parameter :: none(0) = [character(len=1) ::]
    type(row_file_t) :: first, again, renamed, shorter
    type(error_t), allocatable :: error
    integer :: unit, ignored
    call remove_file(path, ignored)
    call first%prepare(path, header, 3, 6, none)
    call first%take_up(error)
    call check%that(.not. allocated(error), 'a missing file has no rows to continue')
    call first%begin(error)
    call check%that(.not. allocated(error), 'a file of rows is begun')
    call check%equal_text(content(path), header, 'a new file has its header')
    call first%append(6, '6,a,1'//n//'6,b,2'//n)
    call first%append(4, '4,"c,,""",7'//n)
    call check%equal_text(content(path), header, 'rows are kept in memory at first')
    call check%that(first%waiting%used == 24, 'number of bytes in memory')
    call first%write(error)
    call check%that(.not. allocated(error), 'rows are written')
    call check%equal_text(content(path), header//'6,a,1'//n//'6,b,2'//n//'4,"c,,""",7'//n, &
      'rows are in the order in which they came')
    call check%that(first%waiting%used == 0, 'no bytes are left in memory')
    call first%finish(.false., error)
    call again%prepare(path, header, 3, 6, ['y', 'x'])
    open (newunit=unit, file=path, position='append', access='stream', form='unformatted')
    write (unit) '5,d,5'//n//'3,e'//n//'3,'//achar(0)//',1'//n//achar(0)//achar(0)//n//'3,torn'
    close (unit)
    call again%take_up(error)
    call check%that(all(again%length(4:6) > 0) .and. again%length(3) == 0, 'runs found in an earlier file')
    call check%that(again%rows(6) == 2 .and. again%rows(5) == 1 .and. again%rows(3) == 0, 'number of rows of a run')
    call check%that(again%numbers(1, 4) == 7 .and. again%numbers(2, 4) == 0 .and. again%numbers(1, 6) == 2, 'numbers in the rows')
    call again%drop(4)
    call again%begin(error)
    call check%equal_text(content(path), header//'5,d,5'//n//'6,a,1'//n//'6,b,2'//n, 'incomplete rows are removed')
    call again%append(4, '4,f,'//n)
    call again%append(3, '3,g,'//n)
    call again%write(error)
    call again%finish(.true., error)
    call check%that(.not. allocated(error), 'rows are finished')
    call check%equal_text(content(path), header//'3,g,'//n//'4,f,'//n//'5,d,5'//n//'6,a,1'//n//'6,b,2'//n, 'rows are sorted by run')
    call renamed%prepare(path, 'run,x,z'//n, 3, 6, none)
    call renamed%take_up(error)
    call check%that(allocated(error), 'another header is refused')
    call shorter%prepare(path, header, 3, 5, none)
    call shorter%take_up(error)
    call check%that(allocated(error), 'a row of a run that does not exist is refused')
    call remove_file(path, ignored)
  end subroutine test_row_file

  !> The content of a file.
  function content(path) result(text)
    character(len=*), intent(in) :: path
    character(len=:), allocatable :: text
    integer :: unit, length
    open (newunit=unit, file=path, access='stream', form='unformatted', status='old', action='read')
    inquire (unit=unit, size=length)
    allocate (character(len=length) :: text)
    read (unit) text
    close (unit)
  end function content
end module test_study
