!> The film with memory of a bearing as a case describes it: how it is marched, where oil is fed to it, and how its bore deforms.
module history_case
  use kinds, only: dp
  use model_parameters, only: has_parameters_t, parameter_list_t
  use bearing_size, only: bearing_t
  use measured_curve, only: measured_curve_t
  use film_cells, only: supply_grooves, supply_holes, supply_circumferential
  use film_history, only: film_history_t
  use constants, only: degree
  use ring_compliance, only: elastic_bore_t, new_ring
  implicit none
  private
  public :: march_case_t, supply_case_t, bore_case_t, shape_case_t, history_case_t

  integer, parameter, public :: most_positions = 8   !! largest number of grooves or holes

  type, extends(has_parameters_t) :: march_case_t
    character(len=:), allocatable :: drive
    integer :: cycle_deg = 0, around = 0, along = 0, substeps = 0, most_cycles = 0
    real(dp) :: cycle_tolerance = 0
  contains
    procedure :: parameters => march_parameters
  end type march_case_t

  type, extends(has_parameters_t) :: supply_case_t
    character(len=:), allocatable :: kind, position_deg, fixed_to
    real(dp), allocatable :: positions(:)      !! `position_deg` as numbers [degrees]; none: it is not a list of 1 to 8 angles
    real(dp) :: pressure = 0, width_deg = 0, length = 0, diameter = 0, groove_width = 0
    type(measured_curve_t) :: feed             !! pressure [Pa] over the crank angle [degrees]
  contains
    procedure :: parameters => supply_parameters
  end type supply_case_t

  type, extends(has_parameters_t) :: bore_case_t
    real(dp) :: outer_radius = 0, youngs_modulus = 0, poissons_ratio = 0
    integer :: modes = 0
    type(measured_curve_t) :: table            !! names the file of compliances
    type(elastic_bore_t) :: compliances        !! of that file
  contains
    procedure :: parameters => bore_parameters
  end type bore_case_t

  type, extends(has_parameters_t) :: shape_case_t
    type(measured_curve_t) :: table            !! deviation [m] over the angle [degrees]
    real(dp) :: direction_deg = 0, factor = 1, barrel = 0, tilt(2) = 0
  contains
    procedure :: parameters => shape_parameters
  end type shape_case_t

  type :: history_case_t
    type(march_case_t), allocatable :: march   !! not allocated: no film is marched
    type(supply_case_t), allocatable :: supply !! not allocated: the film has no supply
    type(bore_case_t), allocatable :: bore     !! not allocated: the bore is rigid
    type(shape_case_t), allocatable :: shape   !! not allocated: the bore is round and the pin in line
  contains
    procedure :: make
  end type history_case_t

contains

  !> The film of a bearing with an oil, ready to march.
  subroutine make(self, bearing, viscosity, pressure_viscosity, ambient_over_cavitation, has_memory, history)
    class(history_case_t), intent(in) :: self
    type(bearing_t), intent(in) :: bearing
    real(dp), intent(in) :: viscosity, pressure_viscosity, ambient_over_cavitation   !! [Pa s], [1/Pa], [Pa]
    logical, intent(in) :: has_memory
    type(film_history_t), intent(out) :: history
    history%bearing = bearing
    history%viscosity = viscosity
    history%pressure_viscosity = pressure_viscosity
    history%ambient_over_cavitation = ambient_over_cavitation
    history%has_memory = has_memory
    history%around = self%march%around
    history%along = self%march%along
    history%substeps = self%march%substeps
    history%most_cycles = self%march%most_cycles
    history%cycle_tolerance = self%march%cycle_tolerance
    if (allocated(self%bore)) then
      history%bore = self%bore%compliances
      if (self%bore%outer_radius > 0) history%bore = new_ring(bearing%radius, self%bore%outer_radius, self%bore%youngs_modulus, &
        self%bore%poissons_ratio, self%bore%modes)
    end if
    if (allocated(self%shape)) then
      history%shape%barrel = self%shape%barrel
      history%shape%tilt = self%shape%tilt
      if (allocated(self%shape%table%x)) then
        history%shape%angle = (self%shape%table%x + self%shape%direction_deg)*degree
        history%shape%deviation = self%shape%factor*self%shape%table%y
      end if
    end if
    if (.not. allocated(self%supply)) return
    history%supply_pressure = self%supply%pressure
    associate (supply => history%supply)
      select case (self%supply%kind)
      case ('grooves')
        supply%kind = supply_grooves
      case ('holes')
        supply%kind = supply_holes
      case default
        supply%kind = supply_circumferential
      end select
      supply%position_deg = self%supply%positions
      supply%width_deg = self%supply%width_deg
      supply%length = self%supply%length
      supply%diameter = self%supply%diameter
      supply%groove_width = self%supply%groove_width
      supply%fixed_to_pin = self%supply%fixed_to == 'pin'
    end associate
  end subroutine make

  subroutine march_parameters(self, list)
    class(march_case_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call list%word('drive', self%drive, 'load, orbit', 'load', &
      'load: the film carries the load of the run; orbit: the eccentricity is that of the run')
    call list%add('cycle_deg', self%cycle_deg, &
      'crank angle of the cycle, the last part of the run; with &bearing_load its period_deg by default [degrees]', &
      '>= 360 and <= 5760', '720')
    call list%add('around', self%around, 'cells round the bearing', '>= 24 and <= 1024', '96')
    call list%add('along', self%along, 'cells along half of it', '>= 2 and <= 128', '8')
    call list%add('substeps', self%substeps, 'steps between two rows', '>= 1 and <= 64', '1')
    call list%add('most_cycles', self%most_cycles, 'largest number of cycles', '>= 1 and <= 1000', '10')
    call list%add('cycle_tolerance', self%cycle_tolerance, &
      'relative change of the oil from cycle to cycle at which the film counts as settled', &
      range='> 0 and <= 0.1', default='1.0e-3', usual='1e-5 to 1e-2')
  end subroutine march_parameters

  subroutine supply_parameters(self, list)
    class(supply_case_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call list%word('kind', self%kind, 'grooves, holes, circumferential_groove', 'grooves', &
      'axial grooves or holes in the middle of the bearing, or a groove all round')
    call list%add('pressure', self%pressure, 'pressure above ambient', 'Pa', '>= 0 and <= 1e8', default='0.0', usual='1e3 to 1e7')
    call self%feed%parameters(list, 'pressure_table', &
      'CSV file with columns crank_angle[deg],pressure[Pa] over cycle_deg, above ambient; instead of pressure', &
      default='')
    call list%text('position_deg', self%position_deg, &
      'grooves, holes: 1 to 8 angles of the middles, from x towards y of the bearing [degrees]', '', many=.true., &
      example='90.0, 270.0')
    call list%add('width_deg', self%width_deg, 'grooves: arc', 'degrees', '> 0 and < 360', default='0.0', example='30.0', &
      usual='1 to 180')
    call list%add('length', self%length, 'grooves: axial length', 'm', '> 0', default='0.0', example='0.009', usual='1e-4 to 1')
    call list%add('diameter', self%diameter, 'holes: diameter', 'm', '> 0', default='0.0', usual='1e-4 to 0.1')
    call list%add('groove_width', self%groove_width, 'circumferential_groove: axial width', 'm', '> 0', default='0.0', &
      usual='1e-4 to 0.1')
    call list%word('fixed_to', self%fixed_to, 'bearing, pin', 'bearing', &
      'grooves and holes are in the bearing or turn with the pin')
  end subroutine supply_parameters

  subroutine shape_parameters(self, list)
    class(shape_case_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call self%table%parameters(list, 'table', 'CSV file with columns angle[deg],deviation[m] of the bore: radial, > 0 '// &
      'outwards; angles from x towards y of the bearing; linear between the rows. Or a NAME.wear.csv: its bore_depth of this '// &
      'joint', default='')
    call list%add('direction_deg', self%direction_deg, 'turns the table', 'degrees', '>= -360 and <= 360', default='0.0', &
      usual='0 to 360')
    call list%add('factor', self%factor, 'multiplies the deviations', default='1.0', usual='0.1 to 10')
    call list%add('barrel', self%barrel, 'growth of the gap from the middle to both ends, with the square of the distance', 'm', &
      '>= 0', default='0.0', example='1.0e-6', usual='1e-7 to 1e-4')
    call list%add('tilt', self%tilt, 'slope of the axis of the pin along that of the bearing, towards x and y', 'rad', &
      default='0.0', usual='1e-6 to 1e-3')
  end subroutine shape_parameters

  subroutine bore_parameters(self, list)
    class(bore_case_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call list%add('outer_radius', self%outer_radius, &
      'outer radius of the ring, at least 1.02 bearing_radius; or a compliance_table', 'm', '> 0', &
      default='0.0', example='0.018', usual='1e-3 to 2')
    call list%add('youngs_modulus', self%youngs_modulus, 'Young''s modulus of the ring', 'Pa', '> 0', default='207.0e9', &
      usual='1e9 to 1e12')
    call list%add('poissons_ratio', self%poissons_ratio, 'Poisson''s ratio of the ring', range='>= 0 and <= 0.5', default='0.3', &
      usual='0.1 to 0.5')
    call list%add('modes', self%modes, 'highest harmonic of its shapes: 0 and 2 to modes are used', '>= 2 and <= 32', '8')
    call self%table%parameters(list, 'compliance_table', &
      'CSV file with columns load,shape,compliance[m/Pa] instead of a ring, shapes 0, 2c, 2s, 3c, ...', default='')
  end subroutine bore_parameters
end module history_case
