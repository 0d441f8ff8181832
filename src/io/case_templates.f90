!> Short cases that run as they are, one for each kind of question, as a first case to change: `gudgeon --template=KIND`.
module case_templates
  implicit none
  private
  public :: short_template, template_kinds

  !> The kinds of short templates.
  character(len=*), parameter :: template_kinds = 'dry, film, engine, compressor, slap, elastic, wear'

  character, parameter :: n = achar(10)
  character(len=*), parameter :: si = ' Values without a unit are in SI units.'//n

  !> A slow mechanism with a dry pin.
  character(len=*), parameter :: rig = &
    "&mechanism"//n// &
    "  crank_length = 0.050, crank_mass = 0.30, crank_inertia = 1.0e-4                   ! m, kg, kg m^2"//n// &
    "  rod_length = 0.120, rod_mass = 0.21, rod_inertia = 2.5e-4, rod_com = 0.045, 0.0   ! centre of mass from the crank pin"//n// &
    "  piston_mass = 0.14"//n// &
    "/"//n// &
    "&drive kind = 'constant_speed' /"//n// &
    "&initial crank_speed = 200 rpm /"//n

  !> A small engine for industry: 163 cm^3, full load.
  character(len=*), parameter :: engine = &
    "&mechanism"//n// &
    "  crank_length = 0.0225, crank_mass = 2.5, crank_inertia = 1.5e-3                   ! half the stroke [m], kg, kg m^2"//n// &
    "  rod_length = 0.084, rod_mass = 0.12, rod_inertia = 1.6e-4, rod_com = 0.025, 0.0   ! centre of mass from the crank pin"//n// &
    "  piston_mass = 0.20                                                                ! with rings and pin"//n// &
    "/"//n// &
    "&drive kind = 'constant_speed' /"//n// &
    "&initial crank_speed = 3600 rpm /"//n// &
    "&combustion"//n// &
    "  cycle = 'four_stroke', bore = 0.068, compression_ratio = 8.5, heat_capacity_ratio = 1.32"//n// &
    "  heat = 350.0                                                                      ! J in each cycle"//n// &
    "  wiebe_efficiency = 5.0, wiebe_form = 3.0, start_deg = 345.0, duration_deg = 50.0  ! firing dead centre at 360"//n// &
    "/"//n

  character(len=*), parameter :: dry_case = &
    "! A dry pin in a slow mechanism: it lies on its bearing, and knocks when the load changes its side."//si//rig// &
    "&joint"//n// &
    "  kind = 'clearance', clearance = 20 um, bearing_radius = 0.010, bearing_length = 0.020   ! radial clearance"//n// &
    "/"//n// &
    "&contact"//n// &
    "  law = 'lankarani_nikravesh', geometry = 'conformal'                               ! a pin in a bearing of its size"//n// &
    "  dissipation = 10 s/m              ! of contacts that last; where impacts matter: restitution = 0.8 in its place"//n// &
    "  youngs_modulus = 2*207 GPa, poissons_ratio = 2*0.3                                ! of pin and bearing"//n// &
    "/"//n// &
    "&friction law = 'ambrosio', coefficient = 0.10, v0 = 1 mm/s, v1 = 10 mm/s /   ! full friction from v1 on"//n// &
    "&integrator revolutions = 4.0 /"//n

  character(len=*), parameter :: film_case = &
    "! An oil film at the piston pin of a mechanism without gas."//si// &
    "&mechanism"//n// &
    "  crank_length = 0.0508, crank_mass = 0.80, crank_inertia = 0.006                   ! m, kg, kg m^2"//n// &
    "  rod_length = 0.2032, rod_mass = 1.36, rod_inertia = 0.010, rod_com = 0.0508, 0.0  ! centre of mass from the crank pin"//n// &
    "  piston_mass = 0.91"//n// &
    "/"//n// &
    "&drive kind = 'constant_speed' /"//n// &
    "&initial crank_speed = 2000 rpm /"//n// &
    "&joint"//n// &
    "  kind = 'clearance', clearance = 20 um, bearing_radius = 0.010, bearing_length = 0.015   ! radial clearance"//n// &
    "/"//n// &
    "&lubrication law = 'finite_bearing', viscosity = 11.7 cP /"//n// &
    "&integrator revolutions = 4.0 /"//n

  character(len=*), parameter :: engine_case = &
    "! A four-stroke engine of 163 cm^3 at 3600 rpm, with an oil film at its piston pin."//si//engine// &
    "&joint"//n// &
    "  kind = 'clearance', clearance = 8 um, bearing_radius = 0.009, bearing_length = 0.020   ! radial clearance"//n// &
    "/"//n// &
    "&lubrication"//n// &
    "  law = 'finite_bearing', oil = 'SAE 30', temperature = 120 degC                    ! of the film"//n// &
    "/"//n// &
    "&integrator revolutions = 8.0 /"//n

  character(len=*), parameter :: compressor_case = &
    "! An air compressor, 1 to 8 bar at 2850 rpm, with an oil film at its piston pin."//si// &
    "&mechanism"//n// &
    "  crank_length = 0.019, crank_mass = 1.2, crank_inertia = 4.0e-4                    ! half the stroke [m], kg, kg m^2"//n// &
    "  rod_length = 0.095, rod_mass = 0.11, rod_inertia = 1.6e-4, rod_com = 0.030, 0.0   ! centre of mass from the crank pin"//n// &
    "  piston_mass = 0.13"//n// &
    "/"//n// &
    "&drive kind = 'constant_speed' /"//n// &
    "&initial crank_speed = 2850 rpm /"//n// &
    "&combustion"//n// &
    "  cycle = 'compressor', bore = 0.051, dead_space = 0.04, polytropic_exponent = 1.3"//n// &
    "  suction_pressure = 1 bar, discharge_pressure = 8 bar                              ! absolute"//n// &
    "/"//n// &
    "&joint"//n// &
    "  kind = 'clearance', clearance = 6 um, bearing_radius = 0.006, bearing_length = 0.014   ! radial clearance"//n// &
    "/"//n// &
    "&lubrication law = 'finite_bearing', viscosity = 0.015 /   ! Pa s"//n// &
    "&integrator revolutions = 6.0 /"//n

  character(len=*), parameter :: slap_case = &
    "! Piston slap in a four-stroke engine of 163 cm^3: the piston moves across its bore and tilts."//si//engine// &
    "&guide"//n// &
    "  kind = 'clearance', bore_clearance = 40.0e-6                                      ! half of bore minus piston [m]"//n// &
    "  piston_radius = 0.034, skirt_top = 0.012, skirt_bottom = 0.028                    ! from the pin [m]"//n// &
    "  piston_inertia = 8.5e-5, piston_com = 0.004, 0.0005                               ! pin offset 0.5 mm"//n// &
    "  contact_law = 'exact', restitution = 0.5, stiffness = 5.0e7                       ! N/m at each corner of the skirt"//n// &
    "  law = 'ambrosio', coefficient = 0.08, v0 = 0.001, v1 = 0.010"//n// &
    "/"//n// &
    "&integrator revolutions = 4.0 /"//n

  character(len=*), parameter :: elastic_case = &
    "! An elastic connecting rod in a four-stroke engine of 163 cm^3."//si//engine// &
    "&elastic_rod"//n// &
    "  youngs_modulus = 70 GPa, section_area = 150 mm2, section_inertia = 3000 mm4       ! aluminium"//n// &
    "/"//n// &
    "&integrator revolutions = 4.0 /"//n

  character(len=*), parameter :: wear_case = &
    "! Wear of a dry pin and its bush in a slow mechanism."//si//rig// &
    "&joint"//n// &
    "  kind = 'clearance', clearance = 20 um, bearing_radius = 0.010, bearing_length = 0.020   ! radial clearance"//n// &
    "/"//n// &
    "&contact"//n// &
    "  law = 'exact', geometry = 'conformal', restitution = 0.8"//n// &
    "  youngs_modulus = 207.0e9, 100.0e9, poissons_ratio = 2*0.3                         ! steel in bronze [Pa]"//n// &
    "/"//n// &
    "&friction law = 'ambrosio', coefficient = 0.15, v0 = 0.001, v1 = 0.010 /   ! full friction from v1 [m/s] on"//n// &
    "&wear rate = 1.0e-15, 5.0e-15 /   ! of pin and bush: volume for force and path [m^2/N]"//n// &
    "&integrator revolutions = 2.0 /"//n

contains

  !> A short case; empty for a kind that is not one of `template_kinds`.
  pure function short_template(kind) result(text)
    character(len=*), intent(in) :: kind
    character(len=:), allocatable :: text
    select case (kind)
    case ('dry')
      text = dry_case
    case ('film')
      text = film_case
    case ('engine')
      text = engine_case
    case ('compressor')
      text = compressor_case
    case ('slap')
      text = slap_case
    case ('elastic')
      text = elastic_case
    case ('wear')
      text = wear_case
    case default
      text = ''
    end select
  end function short_template
end module case_templates
