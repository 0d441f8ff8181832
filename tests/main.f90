!> Runs every test and prints `N passed, N failed` as its last line.
program gudgeon_tests
  use, intrinsic :: iso_fortran_env, only: output_unit
  use checks, only: checks_t
  use test_adams, only: run_test_adams
  use test_adams_order, only: run_test_adams_order
  use test_case_file, only: run_test_case_file
  use test_checkpoint, only: run_test_checkpoint
  use test_combustion, only: run_test_combustion
  use test_command_line, only: run_test_command_line
  use test_contact, only: run_test_contact
  use test_cycle_watch, only: run_test_cycle_watch
  use test_coordinates, only: run_test_coordinates
  use test_error_growth, only: run_test_error_growth
  use test_event_proof, only: run_test_event_proof
  use test_events, only: run_test_events
  use test_findings, only: run_test_findings
  use test_friction, only: run_test_friction
  use test_mechanism, only: run_test_mechanism
  use test_number_text, only: run_test_number_text
  use test_number_writer, only: run_test_number_writer
  use test_oscillating_film, only: run_test_oscillating_film
  use test_pinkus_sternlicht, only: run_test_pinkus_sternlicht
  use test_radau, only: run_test_radau
  use test_reference, only: run_test_reference
  use test_result_file, only: run_test_result_file
  use test_resume, only: run_test_resume
  use test_scenes, only: run_test_scenes
  use test_slow_contact, only: run_test_slow_contact
  use test_standard_problems, only: run_test_standard_problems
  use test_study, only: run_test_study
  use test_summary, only: run_test_summary
  use test_trace_files, only: run_test_trace_files
  implicit none
  type(checks_t) :: check

  call run_test_adams(check)
  call run_test_adams_order(check)
  call run_test_case_file(check)
  call run_test_checkpoint(check)
  call run_test_combustion(check)
  call run_test_command_line(check)
  call run_test_contact(check)
  call run_test_cycle_watch(check)
  call run_test_coordinates(check)
  call run_test_error_growth(check)
  call run_test_event_proof(check)
  call run_test_events(check)
  call run_test_findings(check)
  call run_test_friction(check)
  call run_test_mechanism(check)
  call run_test_number_text(check)
  call run_test_number_writer(check)
  call run_test_oscillating_film(check)
  call run_test_pinkus_sternlicht(check)
  call run_test_radau(check)
  call run_test_reference(check)
  call run_test_result_file(check)
  call run_test_resume(check)
  call run_test_scenes(check)
  call run_test_slow_contact(check)
  call run_test_standard_problems(check)
  call run_test_study(check)
  call run_test_summary(check)
  call run_test_trace_files(check)

  write (output_unit, '(i0,a,i0,a)') check%passed, ' passed, ', check%failed, ' failed'
  if (check%failed > 0 .or. check%passed == 0) error stop 1
end program gudgeon_tests
