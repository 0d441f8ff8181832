!> A case as data: every value that a case file can give, with the units of the case file (SI; angles in
!> degrees only where the name ends in _deg). An `is_present` of false means that the group was left out and its
!> model is absent from the scene.
module case_definition
  use kinds, only: dp
  implicit none
  private
  public :: case_t, mechanism_case_t, drive_case_t, initial_case_t, joint_case_t, contact_case_t, friction_case_t, &
    lubrication_case_t, combustion_case_t, integrator_case_t, output_case_t, word_length

  integer, parameter :: word_length = 32   !! longest name of a law, a variant, a method

  type :: mechanism_case_t
    real(dp) :: crank_length = 0, crank_mass = 0, crank_inertia = 0, crank_com(2) = 0
    real(dp) :: rod_length = 0, rod_mass = 0, rod_inertia = 0, rod_com(2) = 0
    real(dp) :: piston_mass = 0, gravity = 9.80665_dp
  end type mechanism_case_t

  type :: drive_case_t
    character(len=word_length) :: kind = 'free'
    real(dp) :: torque = 0, damping = 0
  end type drive_case_t

  type :: initial_case_t
    real(dp) :: crank_angle_deg = 0, crank_speed = 0
    real(dp) :: eccentricity(2) = 0, eccentricity_rate(2) = 0   !! of the pin in its bearing
  end type initial_case_t

  type :: joint_case_t
    character(len=word_length) :: kind = 'ideal'
    real(dp) :: clearance = 0, bearing_radius = 0, bearing_length = 0
  end type joint_case_t

  type :: contact_case_t
    logical :: is_present = .false.
    character(len=word_length) :: law = 'lankarani_nikravesh'
    real(dp) :: restitution = 0.9_dp, exponent = 1.5_dp
    real(dp) :: youngs_modulus(2) = 207e9_dp, poissons_ratio(2) = 0.3_dp, density(2) = 7850
    real(dp) :: stiffness = 0
    real(dp) :: least_impact_speed = 1e-5_dp   !! Lankarani-Nikravesh: slower impacts are damped as one of this speed
  end type contact_case_t

  type :: friction_case_t
    logical :: is_present = .false.
    character(len=word_length) :: law = 'ambrosio'
    real(dp) :: coefficient = 0, v0 = 0, v1 = 0
  end type friction_case_t

  type :: lubrication_case_t
    logical :: is_present = .false.
    character(len=word_length) :: law = 'pinkus_sternlicht', variant = ''
    real(dp) :: viscosity = 0, kinematic_viscosity = 0
    integer :: quadrature_points = 0
    real(dp) :: least_film_ratio = 1e-3_dp   !! oscillating film: it is taken no thinner than this part of the clearance
  end type lubrication_case_t

  type :: combustion_case_t
    logical :: is_present = .false.
    real(dp) :: bore = 0, compression_ratio = 0, heat_capacity_ratio = 0, heat = 0
    real(dp) :: wiebe_efficiency = 0, wiebe_form = 0, start_deg = 0, duration_deg = 0
    real(dp) :: intake_pressure = 101325, crankcase_pressure = 101325
  end type combustion_case_t

  type :: integrator_case_t
    character(len=word_length) :: method = 'auto', contact_entry = 'root'
    real(dp) :: revolutions = 0, end_time = 0   !! exactly one is given; the other is 0
    real(dp) :: relative_tolerance = 1e-6_dp, absolute_tolerance = 0, max_step = 0
    integer :: max_order = 12, max_steps = 0, max_evaluations = 1000000000, &
      max_evaluations_per_revolution = 100000000
    real(dp) :: max_penetration = 0
  end type integrator_case_t

  type :: output_case_t
    integer :: samples_per_revolution = 720
    real(dp) :: interval = 0, start_time = 0   !! interval > 0 wins over samples_per_revolution
    character(len=:), allocatable :: columns   !! 'standard' or column names without units, separated by commas
    integer :: digits = 10                     !! significant digits of the numbers in traces
    logical :: every_step = .false., ideal_twin = .false.
  end type output_case_t

  !> One case, complete and validated.
  type :: case_t
    character(len=:), allocatable :: name    !! file name without folder and .nml: the NAME of its results
    character(len=:), allocatable :: file    !! path as given by the user, for messages
    character(len=:), allocatable :: title
    type(mechanism_case_t) :: mechanism
    type(drive_case_t) :: drive
    type(initial_case_t) :: initial
    type(joint_case_t) :: joint
    type(contact_case_t) :: contact
    type(friction_case_t) :: friction
    type(lubrication_case_t) :: lubrication
    type(combustion_case_t) :: combustion
    type(integrator_case_t) :: integrator
    type(output_case_t) :: output
  end type case_t
end module case_definition
