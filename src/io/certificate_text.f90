!> Text forms of a certificate: NAME.certificate.csv, rows of the summary, and a part of the line for the user.
module certificate_text
  use kinds, only: dp
  use certificate, only: certificate_t, is_state
  use comparison_run, only: statistic_names, n_statistics, name_figure, n_figures, loss_figure
  use trace_columns, only: column_name
  use number_text, only: real_text, short_text
  use text_tools, only: integer_text, quoted
  implicit none
  private
  public :: certificate_table, certificate_summary, certificate_clause

  character(len=*), parameter :: newline = achar(10)

contains

  !> NAME.certificate.csv: for each column its range over the run, and for the certified part its largest error, its
  !> root-mean-square error, and the largest error relative to the range; and whether it is a coordinate or speed, by whose errors
  !> the certified part is found.
  function certificate_table(certificate) result(text)
    type(certificate_t), intent(in) :: certificate
    character(len=:), allocatable :: text
    integer :: i
    text = 'column,range,largest_error,rms_error,relative_error,is_state'//newline
    do i = 1, size(certificate%list%id)
      if (index(column_name(certificate%list, i), 'phase[') > 0) cycle   ! not a quantity with a unit
      text = text//column_name(certificate%list, i)//','//real_text(certificate%range(i))//','//real_text(certificate%error(i))// &
        ','//real_text(certificate%rms(i))//','
      if (certificate%range(i) > 0) text = text//real_text(certificate%error(i)/certificate%range(i))
      text = text//','//trim(merge('yes', 'no ', is_state(column_name(certificate%list, i))))//newline
    end do
  end function certificate_table

  !> Rows `quantity,value,unit` of the summary.
  function certificate_summary(certificate) result(text)
    type(certificate_t), intent(in) :: certificate
    character(len=:), allocatable :: text
    character(len=8), parameter :: units(n_statistics) = [character(len=8) :: 'N', '1', '1', 'J']
    character(len=:), allocatable :: name, unit
    integer :: i
    text = ''
    if (.not. certificate%is_made) then
      call add('certificate', quoted(certificate%reason, '"'), '')
      return
    end if
    call add('certified_until', real_text(certificate%until), 's')
    call add('certified_digits', real_text(certificate%digits), '1')
    call add('state_error', real_text(certificate%state_error), '1')
    call add('certified_impacts', integer_text(certificate%impacts), '1')
    call add('certified_impacts_matched', integer_text(certificate%impacts_matched), '1')
    call add('certified_with_other_method', trim(merge('yes', 'no ', certificate%has_other_method)), '')
    do i = 1, n_figures
      if (.not. certificate%has_figure(i)) cycle
      call name_figure(i, name, unit)
      if (i == loss_figure) call add(name, real_text(certificate%figure(i)), unit)
      call add(name//'_difference', real_text(certificate%figure_difference(i)), unit)
    end do
    if (certificate%is_whole) return
    call add('beyond_revolutions', integer_text(certificate%revolutions_beyond), '1')
    if (certificate%revolutions_beyond == 0) return
    do i = 1, n_statistics
      call add('beyond_'//trim(statistic_names(i)), real_text(certificate%statistic(i)), trim(units(i)))
      call add('beyond_'//trim(statistic_names(i))//'_difference', real_text(certificate%difference(i)), '1')
    end do

  contains

    subroutine add(quantity, value, unit)
      character(len=*), intent(in) :: quantity, value, unit
      text = text//quantity//','//value//','//unit//newline
    end subroutine add
  end function certificate_summary

  !> The part of the line for the user.
  function certificate_clause(certificate) result(text)
    type(certificate_t), intent(in) :: certificate
    character(len=:), allocatable :: text
    if (.not. certificate%is_made) then
      text = certificate%reason
      return
    end if
    text = short_text(0.1_dp*nint(10*certificate%digits))//' digits to '
    if (certificate%is_whole) then
      text = text//'the end'
      return
    end if
    text = text//short_text(certificate%until)//' s'
    if (certificate%revolutions_beyond == 0) return
    text = text//', then statistics of '//integer_text(certificate%revolutions_beyond)//' revolution'
    if (certificate%revolutions_beyond > 1) text = text//'s'
    text = text//' within '//short_text(two_digits(100*maxval(certificate%difference)))//' %'
  end function certificate_clause

  !> A number with two significant digits.
  pure real(dp) function two_digits(number)
    real(dp), intent(in) :: number   !! >= 0
    real(dp) :: unit
    two_digits = 0
    if (.not. number > 0) return
    unit = 10.0_dp**(floor(log10(number)) - 1)
    two_digits = unit*anint(number/unit)
  end function two_digits
end module certificate_text
