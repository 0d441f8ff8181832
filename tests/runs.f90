!> Tests of cases: their reading, scenes and whole runs, results and studies. See `suites` for the command line.
program runs
  use suites, only: suites_t
  use test_units, only: run_test_units
  use test_oil_names, only: run_test_oil_names
  use test_case_file, only: run_test_case_file
  use test_law_refusals, only: run_test_law_refusals
  use test_curve_files, only: run_test_curve_files
  use test_command_line, only: run_test_command_line
  use test_notes, only: run_test_notes
  use test_number_text, only: run_test_number_text
  use test_result_file, only: run_test_result_file
  use test_study, only: run_test_study
  use test_summary, only: run_test_summary
  use test_trace_files, only: run_test_trace_files
  use test_scenes, only: run_test_scenes
  use test_coordinates, only: run_test_coordinates
  use test_recorder, only: run_test_recorder
  use test_load_elements, only: run_test_load_elements
  use test_two_joints, only: run_test_two_joints
  use test_crank_pin, only: run_test_crank_pin
  use test_guide, only: run_test_guide
  use test_drive, only: run_test_drive
  use test_pauses, only: run_test_pauses
  use test_energy_kept, only: run_test_energy_kept
  use test_radau_runs, only: run_test_radau_runs
  use test_slow_contact, only: run_test_slow_contact
  use test_lost_force, only: run_test_lost_force
  use test_friction_runs, only: run_test_friction_runs
  use test_wear_runs, only: run_test_wear_runs
  use test_worn_bore_runs, only: run_test_worn_bore_runs
  use test_worn_places, only: run_test_worn_places
  use test_film_transition, only: run_test_film_transition
  use test_elastic_film, only: run_test_elastic_film
  use test_asperities_runs, only: run_test_asperities_runs
  use test_film_figures_runs, only: run_test_film_figures_runs
  use test_oil_runs, only: run_test_oil_runs
  use test_gas_machine_runs, only: run_test_gas_machine_runs
  use test_elastic_runs, only: run_test_elastic_runs
  use test_crank_angle, only: run_test_crank_angle
  use test_crank_turns, only: run_test_crank_turns
  use test_cycle_watch, only: run_test_cycle_watch
  use test_run_figures, only: run_test_run_figures
  use test_periodic, only: run_test_periodic
  use test_certificate, only: run_test_certificate
  use test_findings, only: run_test_findings
  use test_reference, only: run_test_reference
  implicit none
  type(suites_t) :: all

  call all%begin()
  call all%run('units', run_test_units)
  call all%run('oil_names', run_test_oil_names)
  call all%run('case_file', run_test_case_file)
  call all%run('law_refusals', run_test_law_refusals)
  call all%run('curve_files', run_test_curve_files)
  call all%run('command_line', run_test_command_line)
  call all%run('notes', run_test_notes)
  call all%run('number_text', run_test_number_text)
  call all%run('result_file', run_test_result_file)
  call all%run('study', run_test_study)
  call all%run('summary', run_test_summary)
  call all%run('trace_files', run_test_trace_files)
  call all%run('scenes', run_test_scenes)
  call all%run('coordinates', run_test_coordinates)
  call all%run('recorder', run_test_recorder)
  call all%run('load_elements', run_test_load_elements)
  call all%run('two_joints', run_test_two_joints)
  call all%run('crank_pin', run_test_crank_pin)
  call all%run('guide', run_test_guide)
  call all%run('drive', run_test_drive)
  call all%run('pauses', run_test_pauses)
  call all%run('energy_kept', run_test_energy_kept)
  call all%run('radau_runs', run_test_radau_runs)
  call all%run('slow_contact', run_test_slow_contact)
  call all%run('lost_force', run_test_lost_force)
  call all%run('friction_runs', run_test_friction_runs)
  call all%run('wear_runs', run_test_wear_runs)
  call all%run('worn_bore_runs', run_test_worn_bore_runs)
  call all%run('worn_places', run_test_worn_places)
  call all%run('film_transition', run_test_film_transition)
  call all%run('elastic_film', run_test_elastic_film)
  call all%run('asperities_runs', run_test_asperities_runs)
  call all%run('film_figures_runs', run_test_film_figures_runs)
  call all%run('oil_runs', run_test_oil_runs)
  call all%run('gas_machine_runs', run_test_gas_machine_runs)
  call all%run('elastic_runs', run_test_elastic_runs)
  call all%run('crank_angle', run_test_crank_angle)
  call all%run('crank_turns', run_test_crank_turns)
  call all%run('cycle_watch', run_test_cycle_watch)
  call all%run('run_figures', run_test_run_figures)
  call all%run('periodic', run_test_periodic)
  call all%run('certificate', run_test_certificate)
  call all%run('findings', run_test_findings)
  call all%run('reference', run_test_reference)
  call all%finish()
end program runs
