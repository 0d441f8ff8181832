!> Reads the compliances of a bore: the header load,shape,compliance[m/Pa], and a row for each pair of shapes.
module compliance_file
  use kinds, only: dp
  use error_handling, only: error_t
  use ring_compliance, only: elastic_bore_t, new_compliance, most_modes
  use text_tools, only: printable, integer_text, next_row
  use value_reader, only: read_real
  implicit none
  private
  public :: parse_compliances

  character(len=*), parameter :: header = 'load,shape,compliance[m/Pa]'
  integer, parameter :: most_rows = (2*most_modes)**2, name_length = 4

contains

  !> The bore of a table. If the text is not such a table, `message` says what is wrong and `line` where; else it is empty.
  subroutine parse_compliances(text, bore, message, line)
    character(len=*), intent(in) :: text
    type(elastic_bore_t), intent(out) :: bore
    character(len=:), allocatable, intent(out) :: message
    integer, intent(out) :: line
    type(error_t), allocatable :: error
    character(len=name_length) :: loads(most_rows), shapes(most_rows)
    real(dp) :: values(most_rows)
    character(len=:), allocatable :: row, wanted
    integer :: at, n, first, second
    logical :: has_header
    message = ''
    line = 0
    at = 1
    n = 0
    has_header = .false.
    do while (message == '')
      call next_row(text, at, line, row)
      if (row == '') exit
      if (.not. has_header) then
        if (row /= header) message = printable(row, 60)//': the header must be '//header
        has_header = .true.
        cycle
      end if
      first = index(row, ',')
      second = index(row, ',', back=.true.)
      n = n + 1
      if (n > most_rows .or. second <= first) then
        message = printable(row, 60)//': needs a load, a shape and a compliance, separated by commas'
        exit
      end if
      loads(n) = adjustl(row(:first - 1))
      shapes(n) = adjustl(row(first + 1:second - 1))
      call read_real(trim(adjustl(row(second + 1:))), values(n), wanted, may_be_tiny=.true.)
      if (allocated(wanted)) message = 'compliance = '//printable(row(second + 1:), 40)//': '//wanted
    end do
    line = max(1, line)
    if (message /= '') return
    if (n == 0) message = 'needs the header '//header//' and at least one row'
    if (message /= '') return
    call new_compliance(loads(:n), shapes(:n), values(:n), bore, error)
    if (allocated(error)) message = error%message
  end subroutine parse_compliances
end module compliance_file
