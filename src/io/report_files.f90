!> The files of a run beside its trace, its events and its summary: fields of films, films with memory, worn surfaces.
module report_files
  use error_handling, only: error_t
  use case_definition, only: case_t
  use film_files, only: write_film_file, write_skirt_file
  use history_files, only: write_histories
  use simulation, only: run_report_t
  use wear_file, only: write_wear_file
  implicit none
  private
  public :: result_suffixes, write_report_files, ending_of_results

  !> Suffixes of all files of results, the summaries first.
  character(len=*), parameter :: result_suffixes(*) = [character(len=32) :: '.summary.csv', '.ideal.summary.csv', '.csv', &
    '.events.csv', '.film.csv', '.skirt.csv', '.wear.csv', '.certificate.csv', '.ideal.csv', '.ideal.events.csv', &
    '.film_history.csv', '.piston_pin.film_history.csv', '.crank_pin.film_history.csv']

  !> Suffixes of the results of studies, beside which a case has its own.
  character(len=*), parameter :: study_suffixes(3) = [character(len=32) :: '.runs.csv', '.cycles.csv', '.strobe.csv']

contains

  !> The ending that a case of this name has in common with a result of a case or study whose name is shorter: the trace of c.events
  !> would be the list of contacts of c. Empty if there is none.
  pure function ending_of_results(name) result(ending)
    character(len=*), intent(in) :: name
    character(len=:), allocatable :: ending
    character(len=*), parameter :: all_suffixes(*) = [result_suffixes, study_suffixes]
    integer :: i, k, length
    ending = ''
    do i = 1, size(all_suffixes)
      do k = 1, size(result_suffixes)
        length = len_trim(all_suffixes(i)) - len_trim(result_suffixes(k))
        if (length < 1 .or. length >= len(name)) cycle
        if (all_suffixes(i)(length + 1:) /= result_suffixes(k)) cycle
        if (name(len(name) - length + 1:) == all_suffixes(i)(:length)) ending = all_suffixes(i)(:length)
      end do
    end do
  end function ending_of_results

  !> Write them. With a film with memory the fields are its own. Error: a file cannot be written (status_output).
  subroutine write_report_files(base, case, report, error)
    character(len=*), intent(in) :: base   !! path of the results without suffix
    type(case_t), intent(in) :: case
    type(run_report_t), intent(in) :: report
    type(error_t), allocatable, intent(out) :: error
    if (allocated(report%histories)) then
      call write_histories(base, case, report%histories, error)
    else if (allocated(report%films)) then
      if (size(report%films) > 0 .or. size(report%skirt) == 0) call write_film_file(base//'.film.csv', report%films, error)
    end if
    if (allocated(error)) return
    if (allocated(report%skirt)) then
      if (size(report%skirt) > 0) call write_skirt_file(base//'.skirt.csv', report%skirt, error)
    end if
    if (allocated(error) .or. .not. allocated(report%wear)) return
    if (size(report%wear) > 0) call write_wear_file(base//'.wear.csv', report%wear, case%output%digits, error)
  end subroutine write_report_files
end module report_files
