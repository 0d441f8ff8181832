!> Results of a summary as columns of a study.
module study_results
  use error_handling, only: error_t, fail, status_case_file
  use text_tools, only: nearest_word
  use joint_places, only: places, n_places
  use case_definition, only: case_t
  use trace_row, only: column_list_t, of_run, of_cycle
  use trace_columns, only: all_columns
  use cycle_answers, only: quantity_t, cycle_quantities
  use column_statistics, only: statistic_t, of_result
  implicit none
  private
  public :: name_results

contains

  !> Check that runs of the case may have the results that are wanted, and give their columns names with units. Error: there is no
  !> such result.
  subroutine name_results(wanted, case, error)
    type(statistic_t), intent(inout) :: wanted(:)
    type(case_t), intent(in) :: case
    type(error_t), allocatable, intent(out) :: error
    type(quantity_t), allocatable :: known(:)
    character(len=:), allocatable :: near
    character(len=14) :: unit
    integer :: i, k
    if (all(wanted%kind /= of_result)) return
    call find_results(case, known)
    do i = 1, size(wanted)
      if (wanted(i)%kind /= of_result) cycle
      k = findloc(known%name == wanted(i)%name, .true., 1)
      if (k == 0) then
        near = nearest_word(trim(wanted(i)%name), known%name)
        if (near /= '') near = '; did you mean '//near//'?'
        call fail(error, ''''//trim(wanted(i)%name)// &
          ''': must be a statistic and a column, or a number of the summary of this case'//near, status_case_file)
        return
      end if
      wanted(i)%column = trim(known(k)%name)
      unit = known(k)%unit
      if (unit == '1') unit = '-'   ! as in the names of columns
      wanted(i)%name = trim(known(k)%name)//'['//trim(unit)//']'
    end do
  end subroutine name_results

  !> The results that runs of a case may have: those that are kept of columns, and the answers of a cycle.
  subroutine find_results(case, known)
    type(case_t), intent(in) :: case
    type(quantity_t), allocatable, intent(out) :: known(:)
    type(column_list_t) :: list
    integer :: i, place
    allocate (known(0))
    call all_columns(case, .false., list)
    do i = 1, size(list%kept)
      associate (kept => list%kept(i))
        if (kept%told /= of_cycle) call add(trim(kept%place)//kept%name, kept%unit)
        if (kept%told /= of_run) call add(trim(kept%place)//'cycle_'//kept%name, kept%unit)
        if (kept%told /= of_run .and. kept%has_angle) call add(trim(kept%place)//'cycle_'//trim(kept%name)//'_angle', 'deg')
      end associate
    end do
    do i = 1, size(cycle_quantities)
      if (cycle_quantities(i)%unit == '') cycle
      call add(cycle_quantities(i)%name, cycle_quantities(i)%unit)
      do place = 1, n_places
        if (places(place)%prefix /= '' .and. case%joints(place)%has_bearing()) &
          call add(trim(places(place)%prefix)//cycle_quantities(i)%name, cycle_quantities(i)%unit)
      end do
    end do

  contains

    subroutine add(name, unit)
      character(len=*), intent(in) :: name, unit
      known = [known, quantity_t(name, unit)]
    end subroutine add
  end subroutine find_results
end module study_results
