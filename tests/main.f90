!> Runs every test and prints `N passed, N failed` as its last line.
program gudgeon_tests
  use, intrinsic :: iso_fortran_env, only: output_unit
  use checks, only: checks_t
  use test_case_file, only: run_test_case_file
  use test_command_line, only: run_test_command_line
  use test_result_file, only: run_test_result_file
  implicit none
  type(checks_t) :: check

  call run_test_case_file(check)
  call run_test_command_line(check)
  call run_test_result_file(check)

  write (output_unit, '(i0,a,i0,a)') check%passed, ' passed, ', check%failed, ' failed'
  if (check%failed > 0 .or. check%passed == 0) error stop 1
end program gudgeon_tests
