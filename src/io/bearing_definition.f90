!> The data of a bearing case: one bearing, its oil and its supply, and a table of what it is given over a cycle, without a
!> mechanism. Its file has the groups of cases that a bearing needs.
module bearing_definition
  use kinds, only: dp
  use model_parameters, only: has_parameters_t, parameter_list_t
  use history_case, only: history_case_t, march_case_t, supply_case_t, bore_case_t, shape_case_t
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

  type, extends(has_parameters_t) :: digits_t
    integer :: digits = 0
    character(len=:), allocatable :: film_times   !! times of fields, as the case gives them
    real(dp), allocatable :: snapshot_times(:)    !! as numbers [s]
  contains
    procedure :: parameters => digits_parameters
  end type digits_t

  type :: bearing_case_t
    type(title_t) :: title
    type(joint_t) :: joint
    type(oil_t) :: oil
    type(history_case_t) :: history
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
    type(bore_case_t) :: bore
    type(shape_case_t) :: shape
    type(march_case_t) :: march
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
    call schema%group('shape', 'Shape of the bore, barrel, tilt of the pin. Without this group it is round and in line', .true.)
    call shape%parameters(schema)
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

  subroutine digits_parameters(self, list)
    class(digits_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call list%add('digits', self%digits, 'significant digits of the numbers', '>= 9 and <= 17', '10')
    call list%text('film_times', self%film_times, &
      'times [s] of the fields of pressure and film fraction in NAME.film.csv: t1, t2, ... or from:to:count', '')
  end subroutine digits_parameters
end module bearing_definition
