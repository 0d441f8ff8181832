!> The parts of parameter studies: grids, tables, rows, checksums.
module test_study
  use kinds, only: dp
  use checks, only: checks_t
  use error_handling, only: error_t
  use checksums, only: checksum_t
  use number_text, only: number_writer_t
  use posix_files, only: remove_file
  use study_definition, only: study_t
  use study_file, only: read_study
  use study_design, only: study_design_t, new_design
  use study_table, only: study_table_t, parse_table
  use row_text, only: row_text_t
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
    call test_grid(check)
    call test_tables(check)
    call a_long_table_takes_time_as_its_length(check)
    call test_row_text(check)
  end subroutine run_test_study

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
end module test_study
