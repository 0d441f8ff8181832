!> Runs all tests, or the suites named on the command line, and prints `N passed, N failed` as its last line. N is the number of
!> different assertions, not the number of times that they are made.
!>
!>     fpm test                          every suite
!>     fpm test -- contact friction      the suites test_contact and test_friction
program gudgeon_tests
  use, intrinsic :: iso_fortran_env, only: output_unit, error_unit
  use checks, only: checks_t
  use test_checks, only: run_test_checks
  use test_adams, only: run_test_adams
  use test_adams_order, only: run_test_adams_order
  use test_bristles, only: run_test_bristles
  use test_asperities, only: run_test_asperities
  use test_worn_bore, only: run_test_worn_bore
  use test_wear, only: run_test_wear
  use test_worn_places, only: run_test_worn_places
  use test_film_equations, only: run_test_film_equations
  use test_film_transition, only: run_test_film_transition
  use test_oil_viscosity, only: run_test_oil_viscosity
  use test_units, only: run_test_units
  use test_elastic_film, only: run_test_elastic_film
  use test_case_file, only: run_test_case_file
  use test_certificate, only: run_test_certificate
  use test_chain, only: run_test_chain
  use test_combustion, only: run_test_combustion
  use test_gas_machines, only: run_test_gas_machines
  use test_measured_curves, only: run_test_measured_curves
  use test_command_line, only: run_test_command_line
  use test_contact, only: run_test_contact
  use test_crank_angle, only: run_test_crank_angle
  use test_crank_pin, only: run_test_crank_pin
  use test_contact_geometries, only: run_test_contact_geometries
  use test_crank_turns, only: run_test_crank_turns
  use test_cycle_watch, only: run_test_cycle_watch
  use test_coordinates, only: run_test_coordinates
  use test_elastic_rod, only: run_test_elastic_rod
  use test_elastic_runs, only: run_test_elastic_runs
  use test_drive, only: run_test_drive
  use test_energy_kept, only: run_test_energy_kept
  use test_error_growth, only: run_test_error_growth
  use test_banded_lu, only: run_test_banded_lu
  use test_ring, only: run_test_ring
  use test_film_cells, only: run_test_film_cells
  use test_engine_films, only: run_test_engine_films
  use test_events, only: run_test_events
  use test_findings, only: run_test_findings
  use test_finite_bearing, only: run_test_finite_bearing
  use test_film_derivatives, only: run_test_film_derivatives
  use test_film_moment, only: run_test_film_moment
  use test_half_film_parts, only: run_test_half_film_parts
  use test_film_figures, only: run_test_film_figures
  use test_friction, only: run_test_friction
  use test_friction_runs, only: run_test_friction_runs
  use test_guide, only: run_test_guide
  use test_joint, only: run_test_joint
  use test_load_elements, only: run_test_load_elements
  use test_loose_piston, only: run_test_loose_piston
  use test_lost_force, only: run_test_lost_force
  use test_notes, only: run_test_notes
  use test_number_text, only: run_test_number_text
  use test_number_writer, only: run_test_number_writer
  use test_oscillating_film, only: run_test_oscillating_film
  use test_pauses, only: run_test_pauses
  use test_periodic, only: run_test_periodic
  use test_pinkus_sternlicht, only: run_test_pinkus_sternlicht
  use test_published_films, only: run_test_published_films
  use test_radau, only: run_test_radau
  use test_recorder, only: run_test_recorder
  use test_reference, only: run_test_reference
  use test_restitution, only: run_test_restitution
  use test_result_file, only: run_test_result_file
  use test_run_figures, only: run_test_run_figures
  use test_scenes, only: run_test_scenes
  use test_small_lu, only: run_test_small_lu
  use test_slow_contact, only: run_test_slow_contact
  use test_standard_problems, only: run_test_standard_problems
  use test_state_layout, only: run_test_state_layout
  use test_states, only: run_test_states
  use test_stick_slip, only: run_test_stick_slip
  use test_study, only: run_test_study
  use test_summary, only: run_test_summary
  use test_trace_files, only: run_test_trace_files
  use test_two_joints, only: run_test_two_joints
  implicit none
  type(checks_t) :: check
  character(len=80), allocatable :: wanted(:)   !! names of suites; empty: all suites
  logical, allocatable :: found(:)              !! which of them exist
  integer :: i

  allocate (wanted(command_argument_count()), found(command_argument_count()))
  found = .false.
  do i = 1, size(wanted)
    call get_command_argument(i, wanted(i))
  end do

  call run('checks', run_test_checks)
  call run('adams', run_test_adams)
  call run('adams_order', run_test_adams_order)
  call run('bristles', run_test_bristles)
  call run('asperities', run_test_asperities)
  call run('worn_bore', run_test_worn_bore)
  call run('wear', run_test_wear)
  call run('worn_places', run_test_worn_places)
  call run('film_equations', run_test_film_equations)
  call run('film_transition', run_test_film_transition)
  call run('oil_viscosity', run_test_oil_viscosity)
  call run('units', run_test_units)
  call run('elastic_film', run_test_elastic_film)
  call run('case_file', run_test_case_file)
  call run('certificate', run_test_certificate)
  call run('chain', run_test_chain)
  call run('combustion', run_test_combustion)
  call run('gas_machines', run_test_gas_machines)
  call run('measured_curves', run_test_measured_curves)
  call run('command_line', run_test_command_line)
  call run('contact', run_test_contact)
  call run('crank_angle', run_test_crank_angle)
  call run('crank_pin', run_test_crank_pin)
  call run('contact_geometries', run_test_contact_geometries)
  call run('restitution', run_test_restitution)
  call run('crank_turns', run_test_crank_turns)
  call run('cycle_watch', run_test_cycle_watch)
  call run('coordinates', run_test_coordinates)
  call run('elastic_rod', run_test_elastic_rod)
  call run('elastic_runs', run_test_elastic_runs)
  call run('drive', run_test_drive)
  call run('energy_kept', run_test_energy_kept)
  call run('error_growth', run_test_error_growth)
  call run('banded_lu', run_test_banded_lu)
  call run('ring', run_test_ring)
  call run('film_cells', run_test_film_cells)
  call run('engine_films', run_test_engine_films)
  call run('events', run_test_events)
  call run('findings', run_test_findings)
  call run('finite_bearing', run_test_finite_bearing)
  call run('film_derivatives', run_test_film_derivatives)
  call run('film_moment', run_test_film_moment)
  call run('half_film_parts', run_test_half_film_parts)
  call run('film_figures', run_test_film_figures)
  call run('friction', run_test_friction)
  call run('friction_runs', run_test_friction_runs)
  call run('guide', run_test_guide)
  call run('joint', run_test_joint)
  call run('load_elements', run_test_load_elements)
  call run('loose_piston', run_test_loose_piston)
  call run('lost_force', run_test_lost_force)
  call run('notes', run_test_notes)
  call run('number_text', run_test_number_text)
  call run('number_writer', run_test_number_writer)
  call run('oscillating_film', run_test_oscillating_film)
  call run('pauses', run_test_pauses)
  call run('periodic', run_test_periodic)
  call run('published_films', run_test_published_films)
  call run('pinkus_sternlicht', run_test_pinkus_sternlicht)
  call run('radau', run_test_radau)
  call run('recorder', run_test_recorder)
  call run('reference', run_test_reference)
  call run('result_file', run_test_result_file)
  call run('run_figures', run_test_run_figures)
  call run('scenes', run_test_scenes)
  call run('small_lu', run_test_small_lu)
  call run('slow_contact', run_test_slow_contact)
  call run('standard_problems', run_test_standard_problems)
  call run('state_layout', run_test_state_layout)
  call run('states', run_test_states)
  call run('stick_slip', run_test_stick_slip)
  call run('study', run_test_study)
  call run('summary', run_test_summary)
  call run('trace_files', run_test_trace_files)
  call run('two_joints', run_test_two_joints)

  call check%say_unprinted()
  write (output_unit, '(i0,a,i0,a)') check%passed(), ' passed, ', check%failed(), ' failed'
  do i = 1, size(wanted)
    if (.not. found(i)) write (error_unit, '(3a)') 'there is no suite ', trim(wanted(i)), ': see tests/main.f90'
  end do
  if (check%failed() > 0 .or. check%passed() == 0 .or. .not. all(found)) error stop 1

contains

  !> Run a suite if it is selected.
  subroutine run(name, suite)
    character(len=*), intent(in) :: name
    interface
      subroutine suite(check)
        import :: checks_t
        class(checks_t), intent(inout) :: check
      end subroutine suite
    end interface
    where (wanted == name) found = .true.
    if (size(wanted) > 0 .and. .not. any(wanted == name)) return
    call check%begin_suite(name)
    call suite(check)
  end subroutine run
end program gudgeon_tests
