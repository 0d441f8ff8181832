!> Tests of single models: laws, films, chains, gases and integrators, without case files and scenes, so that a changed model
!> is tested within seconds. See `suites` for the command line.
program units
  use suites, only: suites_t
  use test_checks, only: run_test_checks
  use test_banded_lu, only: run_test_banded_lu
  use test_small_lu, only: run_test_small_lu
  use test_crank_train, only: run_test_crank_train
  use test_state_layout, only: run_test_state_layout
  use test_number_writer, only: run_test_number_writer
  use test_peak_search, only: run_test_peak_search
  use test_adams, only: run_test_adams
  use test_adams_order, only: run_test_adams_order
  use test_radau, only: run_test_radau
  use test_states, only: run_test_states
  use test_standard_problems, only: run_test_standard_problems
  use test_error_growth, only: run_test_error_growth
  use test_events, only: run_test_events
  use test_chain, only: run_test_chain
  use test_elastic_rod, only: run_test_elastic_rod
  use test_loose_piston, only: run_test_loose_piston
  use test_varying_drive, only: run_test_varying_drive
  use test_joint, only: run_test_joint
  use test_contact, only: run_test_contact
  use test_contact_geometries, only: run_test_contact_geometries
  use test_restitution, only: run_test_restitution
  use test_friction, only: run_test_friction
  use test_bristles, only: run_test_bristles
  use test_stick_slip, only: run_test_stick_slip
  use test_wear, only: run_test_wear
  use test_worn_bore, only: run_test_worn_bore
  use test_asperities, only: run_test_asperities
  use test_film_equations, only: run_test_film_equations
  use test_film_weights, only: run_test_film_weights
  use test_film_mobility, only: run_test_film_mobility
  use test_oil_viscosity, only: run_test_oil_viscosity
  use test_ring, only: run_test_ring
  use test_film_cells, only: run_test_film_cells
  use test_face_film, only: run_test_face_film
  use test_ring_film, only: run_test_ring_film
  use test_engine_films, only: run_test_engine_films
  use test_finite_bearing, only: run_test_finite_bearing
  use test_film_derivatives, only: run_test_film_derivatives
  use test_film_moment, only: run_test_film_moment
  use test_half_film_parts, only: run_test_half_film_parts
  use test_film_figures, only: run_test_film_figures
  use test_oscillating_film, only: run_test_oscillating_film
  use test_published_films, only: run_test_published_films
  use test_pinkus_sternlicht, only: run_test_pinkus_sternlicht
  use test_combustion, only: run_test_combustion
  use test_gas_machines, only: run_test_gas_machines
  use test_measured_curves, only: run_test_measured_curves
  implicit none
  type(suites_t) :: all

  call all%begin()
  call all%run('checks', run_test_checks)
  call all%run('banded_lu', run_test_banded_lu)
  call all%run('small_lu', run_test_small_lu)
  call all%run('state_layout', run_test_state_layout)
  call all%run('number_writer', run_test_number_writer)
  call all%run('peak_search', run_test_peak_search)
  call all%run('adams', run_test_adams)
  call all%run('adams_order', run_test_adams_order)
  call all%run('radau', run_test_radau)
  call all%run('states', run_test_states)
  call all%run('standard_problems', run_test_standard_problems)
  call all%run('error_growth', run_test_error_growth)
  call all%run('events', run_test_events)
  call all%run('chain', run_test_chain)
  call all%run('crank_train', run_test_crank_train)
  call all%run('elastic_rod', run_test_elastic_rod)
  call all%run('loose_piston', run_test_loose_piston)
  call all%run('varying_drive', run_test_varying_drive)
  call all%run('joint', run_test_joint)
  call all%run('contact', run_test_contact)
  call all%run('contact_geometries', run_test_contact_geometries)
  call all%run('restitution', run_test_restitution)
  call all%run('friction', run_test_friction)
  call all%run('bristles', run_test_bristles)
  call all%run('stick_slip', run_test_stick_slip)
  call all%run('wear', run_test_wear)
  call all%run('worn_bore', run_test_worn_bore)
  call all%run('asperities', run_test_asperities)
  call all%run('film_equations', run_test_film_equations)
  call all%run('film_weights', run_test_film_weights)
  call all%run('film_mobility', run_test_film_mobility)
  call all%run('oil_viscosity', run_test_oil_viscosity)
  call all%run('ring', run_test_ring)
  call all%run('film_cells', run_test_film_cells)
  call all%run('face_film', run_test_face_film)
  call all%run('ring_film', run_test_ring_film)
  call all%run('engine_films', run_test_engine_films)
  call all%run('finite_bearing', run_test_finite_bearing)
  call all%run('film_derivatives', run_test_film_derivatives)
  call all%run('film_moment', run_test_film_moment)
  call all%run('half_film_parts', run_test_half_film_parts)
  call all%run('film_figures', run_test_film_figures)
  call all%run('oscillating_film', run_test_oscillating_film)
  call all%run('published_films', run_test_published_films)
  call all%run('pinkus_sternlicht', run_test_pinkus_sternlicht)
  call all%run('combustion', run_test_combustion)
  call all%run('gas_machines', run_test_gas_machines)
  call all%run('measured_curves', run_test_measured_curves)
  call all%finish()
end program units
