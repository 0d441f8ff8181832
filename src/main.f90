!> gudgeon: simulation of the slider-crank mechanism with clearance in its joints. Reads the command line and runs the cases.
program gudgeon
  use error_handling, only: error_t, fail, status_ok, status_integration
  use command_line, only: command_line_t, parse_command_line, program_arguments, help_text
  use case_file, only: template
  use case_templates, only: short_template
  use case_runner, only: run_cases
  use plot_command, only: plot_is_wanted, become_plot
  use study_runner, only: run_study_file
  use study_definition, only: study_schema_of
  use case_schema, only: key_table_t, case_schema_of
  use case_text, only: template_text
  use json_schema, only: json_schema_text
  use shell_pages, only: completion_text, manual_text
  use reference_pages, only: keys_reference, results_reference, oils_reference
  use portuguese, only: in_language
  use run_progress, only: progress_wanted, tell, say
  use text_tools, only: printable, case_name
  use posix_files, only: fill_standard_descriptors, signal_set_t, hold_interrupts, interrupted, ignore_write_signals
  use posix_processes, only: end_program
  use version_number, only: program_version
  implicit none
  type(command_line_t) :: options
  type(error_t), allocatable :: error
  type(signal_set_t) :: before   ! the signals that are held when it begins
  integer :: status

  status = status_ok
  call fill_standard_descriptors()
  if (plot_is_wanted()) then
    call become_plot(error)
  else
    call ignore_write_signals()
    call parse_command_line(program_arguments(), options, error)
  end if
  if (allocated(error)) then
    call tell(error%message)
    status = error%status
  else if (options%help) then
    call say(help_text(), status)
  else if (options%version) then
    call say('gudgeon '//program_version, status)
  else if (options%template .or. options%manual .or. options%reference//options%completion /= '') then
    call say_page(options, status)
  else if (options%sweep) then
    call run_studies(options, status)
  else
    call hold_interrupts(before)
    call run_cases(options, status)
  end if
  call end_program(status)

contains

  !> Print a template, a page of the manual, or what a shell shows.
  subroutine say_page(options, status)
    type(command_line_t), intent(inout) :: options
    integer, intent(inout) :: status
    type(key_table_t) :: table
    if (options%template .and. options%sweep) then
      call study_schema_of(table)
      call say(template_text('A parameter study of gudgeon with every key there is. Keys marked required have no default.', &
        table), status)
    else if (options%kind /= '') then
      call say(short_template(options%kind), status)
    else if (options%template) then
      call say(template(), status)
    else if (options%manual) then
      call say(manual_text(), status)
    else if (options%completion /= '') then
      call say(completion_text(options%completion), status)
    else if (options%reference == 'oils') then
      call say(oils_reference(), status)
    else if (options%reference == 'results') then
      call say(results_reference(), status)
    else
      if (options%reference == 'study') then
        call study_schema_of(table)
        call say(keys_reference(table, ''), status)
      else
        call case_schema_of(table)
        if (options%reference == 'schema') then
          call say(json_schema_text(table), status)
          return
        end if
        if (options%reference == 'case') options%reference = ''
        call say(keys_reference(table, options%reference), status)
      end if
    end if
  end subroutine say_page

  !> Run all studies, one after the other; the largest exit status is returned.
  subroutine run_studies(options, status)
    type(command_line_t), intent(in) :: options
    integer, intent(out) :: status
    character(len=:), allocatable :: line
    type(error_t), allocatable :: error
    logical :: show_progress
    integer :: i
    call hold_interrupts(before)
    status = status_ok
    show_progress = progress_wanted(options%progress) .and. .not. options%quiet
    do i = 1, size(options%cases)
      if (interrupted()) then
        line = ''
        call fail(error, printable(trim(options%cases(i)), 200)//': interrupted before it began', status_integration)
      else
        call run_study_file(trim(options%cases(i)), options, show_progress, before, line, error)
      end if
      if (line /= '' .and. .not. options%quiet) call say(in_language(line, options%language, &
        trim(options%cases(i))//achar(10)//case_name(trim(options%cases(i)))//achar(10)//options%out//'/'// &
        case_name(trim(options%cases(i)))), status)
      if (.not. allocated(error)) cycle
      call tell(error%message)
      status = max(status, error%status)
    end do
  end subroutine run_studies
end program gudgeon
