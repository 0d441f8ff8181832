!> The data of a bearing case: one bearing, its oil and its supply, and a table of what it is given over a cycle, without a
!> mechanism. Its file has the groups of cases that a bearing needs.
module bearing_definition
  use kinds, only: dp
  use model_parameters, only: has_parameters_t, parameter_list_t
  use case_schema, only: schema_t, key_table_t
  implicit none
  private
  public :: bearing_case_t, bearing_schema_of


  type, extends(has_parameters_t) :: title_t
    character(len=:), allocatable :: text
  contains
    procedure :: parameters => title_parameters
  end type title_t

  type, extends(has_parameters_t) :: joint_t
    character(len=:), allocatable :: kind
    real(dp) :: clearance = 0, bearing_radius = 0, bearing_length = 0
  contains
    procedure :: parameters => joint_parameters
  end type joint_t

  type, extends(has_parameters_t) :: oil_t
    character(len=:), allocatable :: law, cavitation
    real(dp) :: viscosity = 0, pressure_viscosity = 0, ambient_over_cavitation = 0
  contains
    procedure :: parameters => oil_parameters
  end type oil_t

  type, extends(has_parameters_t) :: supply_case_t
    character(len=:), allocatable :: kind, position_deg, fixed_to
    real(dp) :: pressure = 0, width_deg = 0, length = 0, diameter = 0, groove_width = 0
  contains
    procedure :: parameters => supply_parameters
  end type supply_case_t

  type, extends(has_parameters_t) :: bore_t
    real(dp) :: outer_radius = 0, youngs_modulus = 0, poissons_ratio = 0
    integer :: modes = 0
  contains
    procedure :: parameters => bore_parameters
  end type bore_t

  type, extends(has_parameters_t) :: march_t
    character(len=:), allocatable :: drive, table
    integer :: around = 0, along = 0, substeps = 0, most_cycles = 0
    real(dp) :: cycle_tolerance = 0
  contains
    procedure :: parameters => march_parameters
  end type march_t

  type, extends(has_parameters_t) :: digits_t
    integer :: digits = 0
  contains
    procedure :: parameters => digits_parameters
  end type digits_t

  type :: bearing_case_t
    type(title_t) :: title
    type(joint_t) :: joint
    type(oil_t) :: oil
    type(supply_case_t), allocatable :: supply   !! not allocated: the film has no supply
    type(bore_t), allocatable :: bore            !! not allocated: the bore is rigid
    type(march_t) :: march
    type(digits_t) :: output
  end type bearing_case_t

contains

  !> Groups and keys of a bearing case.
  subroutine bearing_schema_of(table)
    type(key_table_t), intent(out) :: table
    type(schema_t) :: schema
    type(title_t) :: title
    type(joint_t) :: joint
    type(oil_t) :: oil
    type(supply_case_t) :: supply
    type(bore_t) :: bore
    type(march_t) :: march
    type(digits_t) :: output
    call schema%begin()
    call schema%group('case', 'All values are in SI units; angles are in degrees only where the key ends in _deg', .false.)
    call title%parameters(schema)
    call schema%group('joint', 'The bearing and its pin', .false.)
    call joint%parameters(schema)
    call schema%group('lubrication', 'The oil', .false.)
    call oil%parameters(schema)
    call schema%group('supply', 'Where oil is fed to the film. Without this group there is no supply', .true.)
    call supply%parameters(schema)
    call schema%group('bore', 'Elastic ring round the bearing. Without this group the bore is rigid', .true.)
    call bore%parameters(schema)
    call schema%group('film_history', 'March of the film with memory over a cycle', .false.)
    call march%parameters(schema)
    call schema%group('output', 'Numbers of the results', .false.)
    call output%parameters(schema)
    call schema%get_table(table)
  end subroutine bearing_schema_of

  subroutine title_parameters(self, list)
    class(title_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call list%text('title', self%text, 'title of the case', '')
  end subroutine title_parameters

  subroutine joint_parameters(self, list)
    class(joint_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call list%word('kind', self%kind, 'clearance', 'clearance', 'a film needs clearance')
    call list%add('clearance', self%clearance, 'radial clearance: bearing radius minus pin radius', 'm', '> 0', example='30.0e-6')
    call list%add('bearing_radius', self%bearing_radius, 'radius of the bearing', 'm', '> 0', example='0.025')
    call list%add('bearing_length', self%bearing_length, 'axial length of the bearing', 'm', '> 0', example='0.03')
  end subroutine joint_parameters

  subroutine oil_parameters(self, list)
    class(oil_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call list%word('law', self%law, 'finite_bearing', 'finite_bearing', 'bearing of finite length')
    call list%word('cavitation', self%cavitation, 'mass_conserving, reynolds', 'mass_conserving', &
      'mass_conserving: the oil of each place is balanced; reynolds: a film without memory, for comparison')
    call list%add('viscosity', self%viscosity, 'dynamic viscosity at ambient pressure', 'Pa s', '> 0', example='0.012')
    call list%add('pressure_viscosity', self%pressure_viscosity, 'relative growth of the viscosity with the pressure (Barus)', &
      '1/Pa', '>= 0', default='0.0')
    call list%add('ambient_over_cavitation', self%ambient_over_cavitation, &
      'ambient pressure above that of cavitation; > 0: the ends of the bearing are under oil', 'Pa', '>= 0 and <= 1e7', &
      default='0.0')
  end subroutine oil_parameters

  subroutine supply_parameters(self, list)
    class(supply_case_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call list%word('kind', self%kind, 'grooves, holes, circumferential_groove', 'grooves', &
      'axial grooves or holes in the middle of the bearing, or a groove all round')
    call list%add('pressure', self%pressure, 'pressure above ambient; a column supply_pressure[Pa] of the table has priority', &
      'Pa', '>= 0 and <= 1e8', default='0.0')
    call list%text('position_deg', self%position_deg, &
      'grooves, holes: 1 to 8 angles of the middles, from x towards y of the bearing [degrees]', '', many=.true., &
      example='90.0, 270.0')
    call list%add('width_deg', self%width_deg, 'grooves: arc', 'degrees', '> 0 and < 360', default='0.0', example='30.0')
    call list%add('length', self%length, 'grooves: axial length', 'm', '> 0', default='0.0', example='0.015')
    call list%add('diameter', self%diameter, 'holes: diameter', 'm', '> 0', default='0.0')
    call list%add('groove_width', self%groove_width, 'circumferential_groove: axial width', 'm', '> 0', default='0.0')
    call list%word('fixed_to', self%fixed_to, 'bearing, pin', 'bearing', &
      'grooves and holes are in the bearing or turn with the pin')
  end subroutine supply_parameters

  subroutine bore_parameters(self, list)
    class(bore_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call list%add('outer_radius', self%outer_radius, 'outer radius of the ring, at least 1.02 bearing_radius', 'm', '> 0', &
      example='0.04')
    call list%add('youngs_modulus', self%youngs_modulus, 'Young''s modulus of the ring', 'Pa', '> 0', default='207.0e9')
    call list%add('poissons_ratio', self%poissons_ratio, 'Poisson''s ratio of the ring', range='>= 0 and <= 0.5', default='0.3')
    call list%add('modes', self%modes, 'highest harmonic of its shapes: 0 and 2 to modes are used', '>= 2 and <= 32', '8')
  end subroutine bore_parameters

  subroutine march_parameters(self, list)
    class(march_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call list%word('drive', self%drive, 'load, orbit', 'load', &
      'load: the film carries the load of the table; orbit: the table gives the eccentricity')
    call list%text('table', self%table, 'CSV file of the cycle, path relative to the case file; one row: a steady state', &
      example='bearing.table.csv')
    call list%add('around', self%around, 'cells round the bearing', '>= 24 and <= 1024', '96')
    call list%add('along', self%along, 'cells along half of it', '>= 2 and <= 128', '8')
    call list%add('substeps', self%substeps, 'steps between two rows of the table', '>= 1 and <= 64', '1')
    call list%add('most_cycles', self%most_cycles, 'largest number of cycles', '>= 1 and <= 1000', '10')
    call list%add('cycle_tolerance', self%cycle_tolerance, 'relative change of the oil from cycle to cycle that ends the march', &
      range='> 0 and <= 0.1', default='1.0e-3')
  end subroutine march_parameters

  subroutine digits_parameters(self, list)
    class(digits_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call list%add('digits', self%digits, 'significant digits of the numbers', '>= 9 and <= 17', '10')
  end subroutine digits_parameters
end module bearing_definition
