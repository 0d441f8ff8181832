!> Reads and checks the files of measured curves that a case names, and puts the curves into the case.
module case_curves
  use kinds, only: dp
  use error_handling, only: error_t, fail, status_case_file
  use checksums, only: checksum_t
  use posix_files, only: absolute_path
  use film_law, only: film_law_t
  use film_files, only: film_table_fault
  use measured_curve, only: measured_curve_t
  use measured_pressure, only: measured_pressure_periods
  use number_text, only: short_text
  use text_tools, only: printable, integer_text, path_beside, next_line
  use text_file, only: read_text_file
  use case_definition, only: case_t
  use compliance_file, only: parse_compliances
  use history_case, only: history_case_t, bore_case_t
  use joint_places, only: places, n_places
  use case_values, only: case_values_t
  use curve_file, only: parse_curve, quantity_t, crank_angle, pressure, turning_speed, torque, load, height, relief, &
    place_angle, deviation
  implicit none
  private
  public :: provide_curves, period_fault

  character(len=*), parameter :: byte_order_mark = char(239)//char(187)//char(191)   !! of UTF-8: no part of a text
  integer, parameter :: largest_file = 100   !! MB
  real(dp), parameter :: widest_gap = 30     !! largest interval between two points of a pressure curve [degrees]
  real(dp), parameter :: gap_ratio = 4  !! an interval that is this much wider than both its neighbours is an error: points are
                                        !! missing
  real(dp), parameter :: same_pressure = 0.01_dp  !! largest difference between the pressures at the beginning and end of a period,
                                                  !! relative to the largest pressure

contains

  !> Read the curves that a case names, unless they have been read before. In the values each file is then named by its absolute
  !> path, and a digest of its content is added, so that the values contain everything on which a run depends.
  subroutine provide_curves(values, into)
    type(case_values_t), intent(inout) :: values
    type(case_t), intent(inout) :: into
    integer :: i
    if (into%drive%table%is_wanted()) call provide(values, into%file, 'drive', 'torque_table', turning_speed, torque, &
      into%drive%table)
    do i = 1, n_places
      call provide_history(values, into%file, i, into%joints(i)%history)
      if (allocated(into%joints(i)%film)) call check_film_table(values, into%file, i, into%joints(i)%film)
    end do
    if (allocated(into%load)) then
      if (into%load%curve%is_wanted() .and. mod(into%load%period_deg, 360) == 0) call provide(values, into%file, 'bearing_load', &
        'table', crank_angle, load, into%load%curve, into%load%period_deg)   ! another period is refused by the rules
    end if
    if (allocated(into%guide)) then
      if (into%guide%profile%is_wanted()) call provide(values, into%file, 'guide', 'profile_table', height, relief, &
        into%guide%profile)
    end if
    if (.not. allocated(into%measured)) return
    associate (gas => into%measured)
      if (gas%is_external() .or. all(gas%period_deg /= measured_pressure_periods)) return   ! without table, or refused by the rules
      call provide(values, into%file, 'cylinder_pressure', 'table', crank_angle, pressure, gas%curve, gas%period_deg, &
        gas%pressure_offset)
    end associate
  end subroutine provide_curves

  !> Read the tables of a film with memory: the pressure of its supply over the crank angle, the compliances and the shape of its
  !> bore, which may be that of a file of wear.
  subroutine provide_history(values, case_file, place, history)
    type(case_values_t), intent(inout) :: values
    character(len=*), intent(in) :: case_file
    integer, intent(in) :: place   !! index in `places`
    type(history_case_t), intent(inout) :: history
    if (allocated(history%supply)) then
      if (history%supply%feed%is_wanted()) call provide(values, case_file, values%law_group('supply', place), &
        'pressure_table', crank_angle, pressure, history%supply%feed)
    end if
    if (allocated(history%shape)) then
      if (history%shape%table%is_wanted()) call provide(values, case_file, values%law_group('shape', place), 'table', &
        place_angle, deviation, history%shape%table, joint=trim(places(place)%name))
    end if
    if (.not. allocated(history%bore)) return
    if (history%bore%table%is_wanted()) call provide_compliances(values, case_file, values%law_group('bore', place), &
      history%bore)
  end subroutine provide_history

  !> Check that the file that shall keep the table of a film is one, if it is there.
  subroutine check_film_table(values, case_file, place, film)
    type(case_values_t), intent(inout) :: values
    character(len=*), intent(in) :: case_file
    integer, intent(in) :: place   !! index in `places`
    class(film_law_t), intent(in) :: film
    character(len=*), parameter :: key = 'table_file'
    character(len=:), allocatable :: fault
    if (.not. allocated(film%table_file)) return
    if (film%table_file == '') return
    fault = film_table_fault(path_beside(case_file, film%table_file))
    if (fault /= '') call values%refuse(values%law_group('lubrication', place), key, fault)
  end subroutine check_film_table

  subroutine provide_compliances(values, case_file, group, bore)
    type(case_values_t), intent(inout) :: values
    character(len=*), intent(in) :: case_file, group
    type(bore_case_t), intent(inout) :: bore
    character(len=*), parameter :: key = 'compliance_table'
    type(error_t), allocatable :: error
    character(len=:), allocatable :: text, message
    integer :: line
    call read_new(values, case_file, group, key, bore%table, text)
    if (allocated(text)) then
      call parse_compliances(text, bore%compliances, message, line)
      if (message /= '') then
        call fail(error, printable(bore%table%path, 200)//':'//integer_text(line)//': '//message, status_case_file)
        call values%refuse_file(group, key, error)
        return
      end if
    end if
    call finish_table(values, group, key, bore%table)
  end subroutine provide_compliances

  !> Read one curve. A curve with a period is a pressure or a load; a load may have two components; deviations may be worn depths.
  subroutine provide(values, case_file, group, key, x_is, y_is, curve, period, offset, joint)
    type(case_values_t), intent(inout) :: values
    character(len=*), intent(in) :: case_file, group, key
    type(quantity_t), intent(in) :: x_is, y_is
    type(measured_curve_t), intent(inout) :: curve
    integer, intent(in), optional :: period   !! [degrees]
    real(dp), intent(in), optional :: offset   !! added to a pressure when it acts [Pa]
    character(len=*), intent(in), optional :: joint   !! whose rows of a file of wear are read
    character(len=:), allocatable :: text, message
    type(error_t), allocatable :: error
    integer, allocatable :: lines(:)
    integer :: line
    call read_new(values, case_file, group, key, curve, text)
    if (allocated(text)) then
      if (y_is%name == load%name) then
        call parse_curve(text, x_is, y_is, curve%x, curve%y, lines, message, line, curve%z)
        if (message == '') call close_load(curve, period, lines, message, line)
      else
        if (present(joint)) call select_worn_bore(text, joint)
        call parse_curve(text, x_is, y_is, curve%x, curve%y, lines, message, line)
        if (message /= '' .and. y_is%name == pressure%name) message = message// &
          '; gudgeon.read_pressure of the Python package makes such a table of a rig''s file; this one begins '//beginning(text)
        if (message == '' .and. present(period)) call close_period(curve, period, offset, lines, message, line)
        if (message == '' .and. y_is%name == deviation%name) call close_turn(curve, lines, message, line)
      end if
      if (message /= '') then
        call fail(error, printable(curve%path, 200)//':'//integer_text(line)//': '//message, status_case_file)
        deallocate (curve%path)
        call values%refuse_file(group, key, error)
        return
      end if
    end if
    call finish_table(values, group, key, curve)
  end subroutine provide

  !> The first lines of a file, as a message shows them.
  function beginning(text) result(shown)
    character(len=*), intent(in) :: text
    character(len=:), allocatable :: shown
    integer, parameter :: most_lines = 3, most_letters = 40   !! shown, and of each
    integer :: first, length, i
    shown = ''
    first = 1
    do i = 1, most_lines
      if (first > len(text)) exit
      length = scan(text(first:)//new_line('a'), new_line('a')//achar(13)) - 1
      if (i > 1) shown = shown//', '
      shown = shown//''''//printable(text(first:first + length - 1), most_letters)//''''
      first = first + length + index(text(first + length:)//new_line('a'), new_line('a'))
    end do
  end function beginning

  !> Read the text of a table, unless it has been read before or cannot be read, which is noted.
  subroutine read_new(values, case_file, group, key, table, text)
    type(case_values_t), intent(inout) :: values
    character(len=*), intent(in) :: case_file, group, key
    type(measured_curve_t), intent(inout) :: table
    character(len=:), allocatable, intent(out) :: text
    character(len=:), allocatable :: path
    type(error_t), allocatable :: error
    type(checksum_t) :: sum
    if (table%file == '') then
      call values%refuse(group, key, trim(merge('must be the name of a file', 'required                  ', &
        values%is_given(group, key))))
      return
    end if
    path = path_beside(case_file, table%file)
    if (allocated(table%path)) then
      if (table%path == path) return
      deallocate (table%path)
    end if
    call read_text_file(path, largest_file, 'table', text, error)
    if (allocated(error)) then
      deallocate (text)
      call values%refuse_file(group, key, error)
      return
    end if
    call sum%add(text)
    table%found = sum%hexadecimal()
    if (index(text, byte_order_mark) == 1) text = text(len(byte_order_mark) + 1:)
    table%path = absolute_path(path)
  end subroutine read_new

  !> Check the digest of a table that has been read, and put its absolute path and digest into the values.
  subroutine finish_table(values, group, key, table)
    type(case_values_t), intent(inout) :: values
    character(len=*), intent(in) :: group, key
    type(measured_curve_t), intent(in) :: table
    integer :: place
    if (.not. allocated(table%path)) return
    if (table%digest /= '' .and. table%digest /= table%found) then
      call values%refuse(group, key//'_digest', printable(table%path, 200)//' has other content: its digest is '//table%found)
      return
    end if
    place = values%place_of(group, key)
    values%values(place)%text = table%path
    place = values%place_of(group, key//'_digest')
    values%values(place)%text = table%found
  end subroutine finish_table

  !> Check a measured pressure over one period and remove a last point that repeats the first one. If it is wrong, `message` says
  !> what is wrong and `line` where.
  subroutine close_period(curve, period, offset, lines, message, line)
    type(measured_curve_t), intent(inout) :: curve
    integer, intent(in) :: period   !! [degrees]
    real(dp), intent(in) :: offset  !! [Pa]
    integer, intent(in) :: lines(:)
    character(len=:), allocatable, intent(out) :: message
    integer, intent(out) :: line
    integer :: n, at
    call period_fault(curve%x, curve%y + offset, period, message, at)
    line = lines(at)
    if (message /= '') return
    n = size(curve%x)
    if (curve%x(n) - curve%x(1) < period - same_angle(period)) return
    curve%y(1) = 0.5_dp*(curve%y(1) + curve%y(n))
    curve%x = curve%x(:n - 1)
    curve%y = curve%y(:n - 1)
  end subroutine close_period

  !> Check the load of a bearing over one period and remove a last row that repeats the first one. If it is wrong, `message` says
  !> what is wrong and `line` where.
  subroutine close_load(curve, period, lines, message, line)
    type(measured_curve_t), intent(inout) :: curve
    integer, intent(in) :: period   !! [degrees]
    integer, intent(in) :: lines(:)
    character(len=:), allocatable, intent(out) :: message
    integer, intent(out) :: line
    real(dp), parameter :: largest = 1e12_dp, closest = 1e-6_dp, rounding = 1e-9_dp   ! [N], [degrees], relative
    real(dp) :: sizes(size(curve%x)), span
    integer :: i, n
    n = size(curve%x)
    sizes = hypot(curve%y, curve%z)
    span = curve%x(n) - curve%x(1)
    message = ''
    line = lines(n)
    do i = 1, n
      if (sizes(i) > largest) message = 'load = '//short_text(sizes(i))//' N: must be at most 1e12 N'
      if (i > 1) then
        if (curve%x(i) - curve%x(i - 1) < closest) message = 'crank angle: must be at least 1e-6 degrees after that of the row '// &
          'before'
      end if
      if (message /= '') line = lines(i)
      if (message /= '') return
    end do
    if (span > period + same_angle(period)) then
      message = 'the table spans '//short_text(span)//' degrees, more than its period of '//integer_text(period)
    else if (span > period - same_angle(period)) then
      if (abs(curve%y(n) - curve%y(1)) > rounding*maxval(sizes) .or. abs(curve%z(n) - curve%z(1)) > rounding*maxval(sizes)) then
        message = 'the load must be that of the first row, a period before'
      else if (n == 2) then
        message = 'needs a second row within the period'
      end if
      curve%x = curve%x(:n - 1)
      curve%y = curve%y(:n - 1)
      curve%z = curve%z(:n - 1)
    end if
  end subroutine close_load

  !> Make of the text of a file of wear a table of the deviations of one bore, each row in its line; other texts stay.
  pure subroutine select_worn_bore(text, joint)
    character(len=:), allocatable, intent(inout) :: text
    character(len=*), intent(in) :: joint   !! a main bearing or big end may have its number behind it
    character(len=*), parameter :: newline = achar(10)
    character(len=:), allocatable :: line, table
    integer :: at, comma(4), i
    if (index(text, 'joint,angle[deg],pin_depth[m],bore_depth[m],') /= 1) return
    table = 'angle[deg],deviation[m]'//newline
    at = index(text, newline) + 1
    do while (at <= len(text))
      call next_line(text, at, line)
      comma = 0
      do i = 1, size(comma)
        comma(i) = comma(max(1, i - 1)) + index(line(comma(max(1, i - 1)) + 1:), ',')
      end do
      if (index(line, joint//',') == 1 .or. index(line, joint//'_') == 1) &
        table = table//line(comma(1) + 1:comma(2))//line(comma(3) + 1:comma(4) - 1)
      table = table//newline
    end do
    text = table
  end subroutine select_worn_bore

  !> Check the deviations of a bore over one turn and remove a last row that repeats the first one. If they are wrong, `message`
  !> says what is wrong and `line` where.
  subroutine close_turn(curve, lines, message, line)
    type(measured_curve_t), intent(inout) :: curve
    integer, intent(in) :: lines(:)
    character(len=:), allocatable, intent(out) :: message
    integer, intent(out) :: line
    integer, parameter :: turn = 360   ! [degrees]
    integer :: n
    n = size(curve%x)
    message = ''
    line = lines(n)
    if (curve%x(n) - curve%x(1) > turn + same_angle(turn)) then
      message = 'the table spans '//short_text(curve%x(n) - curve%x(1))//' degrees, more than one turn'
    else if (curve%x(n) - curve%x(1) > turn - same_angle(turn)) then
      if (abs(curve%y(n) - curve%y(1)) > 0) message = 'the deviation must be that of the first row, a turn before'
      n = n - 1
    end if
    if (message == '' .and. n < 3) message = 'needs a header and at least three rows within one turn'
    curve%x = curve%x(:n)
    curve%y = curve%y(:n)
  end subroutine close_turn

  !> Find a fault in a pressure curve over one period, and the point at which it occurs. The message is empty if there is none.
  pure subroutine period_fault(angle, pressure, period, message, at)
    real(dp), intent(in) :: angle(:), pressure(:)   !! [degrees], increasing; [Pa]
    integer, intent(in) :: period                   !! [degrees]
    character(len=:), allocatable, intent(out) :: message
    integer, intent(out) :: at
    real(dp) :: widths(0:size(angle) + 1), span
    integer :: n
    n = size(angle)
    span = angle(n) - angle(1)
    message = ''
    do at = 1, n
      if (pressure(at) > 0) cycle
      message = 'pressure = '//short_text(pressure(at))//' Pa: must be > 0: absolute, not above the atmosphere''s'
      return
    end do
    at = n
    if (span > period + same_angle(period)) then
      message = 'the table spans '//short_text(span)//' degrees, more than its period of '//integer_text(period)
      return
    else if (span > period - same_angle(period)) then
      if (abs(pressure(n) - pressure(1)) > same_pressure*maxval(pressure)) then
        message = 'pressure = '//short_text(pressure(n))//' Pa: must be that of the first row, a period before, to 1 %'
        return
      end if
      n = n - 1
    end if
    widths(1:n) = [angle(2:n), angle(1) + period] - angle(:n)
    widths(0) = widths(n)
    widths(n + 1) = widths(1)
    do at = 1, n
      if (widths(at) > widest_gap) then
        message = 'no row from '//short_text(angle(at))//' to '//short_text(angle(at) + widths(at))//' degrees: the table must '// &
          'cover the period of '//integer_text(period)//' without gaps of more than 30'
      else if (widths(at) > gap_ratio*max(widths(at - 1), widths(at + 1))) then
        message = 'rows are missing from '//short_text(angle(at))//' to '//short_text(angle(at) + widths(at))// &
          ' degrees, more than 4 times as far as those on both sides'
      end if
      if (message /= '') return
    end do
    at = n
  end subroutine period_fault

  !> Whether two angles are equal within rounding [degrees].
  pure real(dp) function same_angle(period)
    integer, intent(in) :: period
    same_angle = 1e-9_dp*period
  end function same_angle
end module case_curves
