!> A case: every value that a case file can give, group by group, in the units of the case file (SI; angles in degrees only where
!> the name ends in _deg). The component of a model whose group is not in the file is not allocated, and the scene does not contain
!> that model.
!>
!> `visit_case` is the only list of the groups. Each group, and each law that a group can name, declares its parameters to the
!> visitor. The list is in the submodule `case_groups`, so that a change of a law does not require the modules that use a case to be
!> compiled again.
module case_definition
  use kinds, only: dp
  use run_state, only: run_state_t
  use model_parameters, only: has_parameters_t, parameter_list_t, any_angle, any_speed
  use run_length, only: run_length_t
  use ideal_linkage, only: linkage_t
  use chain_motion, only: n_pins
  use joint_places, only: places, n_places, in_order, name_prefix, pin_title, crank_pin, piston_pin, small_end, main_bearing, &
    spot_of
  use joint_case, only: joint_case_t
  use pin_case, only: pin_case_t, pin_floating, pin_of_piston
  use guide_case, only: guide_case_t
  use ring_case, only: ring_pack_t
  use skirt_film_case, only: skirt_film_case_t
  use elastic_rod, only: elastic_rod_t
  use elastic_crankshaft, only: elastic_crankshaft_t
  use train_case, only: cylinder_case_t, shaft_case_t, damper_case_t, number_throws, most_cylinders
  use gas_law, only: gas_law_t
  use measured_curve, only: measured_curve_t
  use measured_pressure, only: measured_pressure_t
  use cylinder_charge, only: charge_case_t
  use flow_valve, only: flow_valve_t
  use wall_law, only: wall_law_t
  use bearing_load, only: bearing_load_t
  implicit none
  private
  public :: case_t, output_case_t, visit_case

  type, extends(has_parameters_t) :: mechanism_case_t
    real(dp) :: crank_length = 0, crank_mass = 0, crank_inertia = 0, crank_com(2) = 0
    real(dp) :: rod_length = 0, rod_mass = 0, rod_inertia = 0, rod_com(2) = 0
    real(dp) :: piston_mass = 0, axis_offset = 0, gravity = 0, gravity_angle_deg = 0
  contains
    procedure :: parameters => mechanism_parameters
    procedure :: linkage => linkage_of
  end type mechanism_case_t

  type, extends(has_parameters_t) :: drive_case_t
    character(len=:), allocatable :: kind
    real(dp) :: torque = 0, damping = 0, flywheel_inertia = 0
    type(measured_curve_t) :: table              !! speed [rad/s], torque [N m]
    real(dp) :: ramp_time = 0, ramp_from = 0     !! run-up time [s] and initial speed [rad/s] of a prescribed speed
  contains
    procedure :: parameters => drive_parameters
  end type drive_case_t

  type, extends(has_parameters_t) :: initial_case_t
    character(len=:), allocatable :: from      !! file of a state from which the run starts; empty: none
    logical :: goes_on = .true.                !! it goes on with the totals of that state
    type(run_state_t), allocatable :: state    !! that state; not allocated: the run starts with the following values
    real(dp) :: crank_angle_deg = 0, crank_speed = 0
    real(dp) :: eccentricity(2, n_places) = 0, eccentricity_rate(2, n_places) = 0   !! of the pin in its bearing, by place
    real(dp) :: pin_speed = 0                  !! angular speed of a floating pin [rad/s]
    real(dp) :: piston_offset = 0, piston_offset_rate = 0, piston_tilt = 0, piston_tilt_rate = 0  !! of a piston with clearance in
                                                                                                  !! its bore
  contains
    procedure :: parameters => initial_parameters
  end type initial_case_t

  type, extends(has_parameters_t) :: integrator_case_t
    character(len=:), allocatable :: method, contact_entry
    real(dp) :: revolutions = 0, crank_revolutions = 0, end_time = 0  !! length of the run, in one of three ways (or in the last
                                                                      !! two); 0: not given
    real(dp) :: relative_tolerance = 0, absolute_tolerance = 0, max_step = 0
    integer :: max_order = 0, max_steps = 0, max_evaluations = 0, max_evaluations_per_revolution = 0
    real(dp) :: max_penetration = 0
  contains
    procedure :: parameters => integrator_parameters
  end type integrator_case_t

  type, extends(has_parameters_t) :: output_case_t
    character(len=:), allocatable :: sampling  !! 'time' or 'crank_angle'
    integer :: samples_per_revolution = 0
    real(dp) :: angle_origin_deg = 0
    real(dp) :: interval = 0, start_time = 0   !! interval is used instead of samples_per_revolution if it is > 0
    character(len=:), allocatable :: columns   !! 'standard' or column names without units, separated by commas
    character(len=:), allocatable :: film_times  !! times at which pressure fields are written, as the case gives them; may be empty
    real(dp), allocatable :: snapshot_times(:)   !! the same as numbers, increasing [s]; not allocated if there are none
    integer :: digits = 0                      !! significant digits of the numbers in traces
    logical :: every_step = .false., ideal_twin = .false.
    logical :: answers = .true.
    character(len=:), allocatable :: window    !! 'all' or 'last_period'
  contains
    procedure :: parameters => output_parameters
  end type output_case_t

  !> One case, complete and validated.
  type :: case_t
    character(len=:), allocatable :: name    !! file name without folder and .nml: the NAME of its results
    character(len=:), allocatable :: file    !! path as given by the user, for messages
    character(len=:), allocatable :: title
    character(len=:), allocatable :: cache   !! folder that keeps film tables; empty: none; not allocated: that of the user
    character(len=:), allocatable :: notes   !! on values that are not of usual sizes, one line each; not allocated: none
    type(mechanism_case_t) :: mechanism
    type(bearing_load_t), allocatable :: load   !! a bearing under this load instead of the mechanism
    type(drive_case_t) :: drive
    type(initial_case_t) :: initial
    type(joint_case_t) :: joints(n_places)   !! by place
    type(pin_case_t), allocatable :: pin       !! not allocated: the piston pin is fixed in the rod
    type(guide_case_t), allocatable :: guide   !! not allocated: the guide is ideal
    type(skirt_film_case_t) :: skirt_film    !! of a lubricated guide
    type(ring_pack_t) :: rings               !! of the piston
    type(elastic_rod_t), allocatable :: elastic_rod          !! not allocated: the rod is rigid
    type(elastic_crankshaft_t), allocatable :: crankshaft    !! not allocated: the crankshaft is rigid, or has stations
    type(shaft_case_t), allocatable :: shaft                 !! a crankshaft of several stations
    type(damper_case_t), allocatable :: dampers(:)           !! on it
    type(cylinder_case_t), allocatable :: cylinders(:)       !! not allocated: there is one
    class(gas_law_t), allocatable :: combustion
    type(measured_pressure_t), allocatable :: measured   !! used instead of combustion
    type(charge_case_t), allocatable :: charge           !! not allocated: the gas has no mass and temperature
    type(flow_valve_t), allocatable :: valves(:)         !! of a compressor; not allocated: ideal ones
    class(wall_law_t), allocatable :: walls              !! not allocated: no heat to the walls
    type(run_length_t) :: run
    type(integrator_case_t) :: integrator
    type(output_case_t) :: output
  contains
    procedure :: has_contact
    procedure :: forced_revolutions
    procedure :: has_play
    procedure :: has_floating_pin
    procedure :: may_have_joint
    procedure :: loose_pins
    procedure :: has_wear
    procedure :: has_loose_guide
    procedure :: has_skirt_corners
    procedure :: has_clearance => has_clearance_anywhere
    procedure :: is_elastic
    procedure :: become_ideal
    procedure :: has_train
    procedure :: delays
    procedure :: n_bearings
    procedure :: has_numbers
    procedure :: spots
  end type case_t

  interface
    !> Declare every group, key and law of a case to a visitor, in the order of the template and of the resolved case.
    module subroutine visit_case(case, list)
      type(case_t), intent(inout) :: case
      class(parameter_list_t), intent(inout) :: list
    end subroutine visit_case
  end interface

contains

  !> Number of revolutions after which the gas pressure, or the given load of a bearing, repeats; else 1.
  pure integer function forced_revolutions(self) result(revolutions)
    class(case_t), intent(in) :: self
    revolutions = 1
    if (allocated(self%combustion)) revolutions = self%combustion%revolutions()
    if (allocated(self%measured)) revolutions = self%measured%revolutions()
    if (allocated(self%load)) revolutions = self%load%revolutions()
  end function forced_revolutions

  !> Whether a joint has a contact law, or the piston has clearance in its bore.
  pure logical function has_contact(self)
    class(case_t), intent(in) :: self
    has_contact = any(self%joints%can_touch()) .or. self%has_skirt_corners()
  end function has_contact

  !> Whether at least one joint has clearance.
  pure logical function has_play(self)
    class(case_t), intent(in) :: self
    has_play = any(self%joints%has_clearance())
  end function has_play

  !> Whether the wear of a joint is counted.
  pure logical function has_wear(self)
    class(case_t), intent(in) :: self
    integer :: i
    has_wear = any([(allocated(self%joints(i)%wear), i=1, n_places)])
  end function has_wear

  !> Whether the piston pin turns in both of its bearings.
  pure logical function has_floating_pin(self)
    class(case_t), intent(in) :: self
    has_floating_pin = .false.
    if (allocated(self%pin)) has_floating_pin = self%pin%kind == pin_floating
  end function has_floating_pin

  !> Whether there is a bearing at a place: one end of the piston pin has none unless the pin floats.
  pure logical function may_have_joint(self, place)
    class(case_t), intent(in) :: self
    integer, intent(in) :: place   !! index in `places`
    logical :: in_piston
    may_have_joint = .true.
    if (all(place /= [piston_pin, small_end]) .or. self%has_floating_pin()) return
    in_piston = .false.
    if (allocated(self%pin)) in_piston = self%pin%kind == pin_of_piston
    may_have_joint = place == merge(small_end, piston_pin, in_piston)
  end function may_have_joint

  !> The pins of the chain at which joints have clearance.
  pure function loose_pins(self) result(is_loose)
    class(case_t), intent(in) :: self
    logical :: is_loose(n_pins)
    integer :: pin
    is_loose = [(any(places%pin == pin .and. self%joints%has_clearance()), pin=1, n_pins)]
  end function loose_pins

  !> Whether the piston has clearance in its bore.
  pure logical function has_loose_guide(self)
    class(case_t), intent(in) :: self
    has_loose_guide = .false.
    if (allocated(self%guide)) has_loose_guide = self%guide%has_clearance()
  end function has_loose_guide

  !> Whether dry corners of the skirt meet the bore.
  pure logical function has_skirt_corners(self)
    class(case_t), intent(in) :: self
    has_skirt_corners = .false.
    if (allocated(self%guide)) has_skirt_corners = self%guide%has_corners()
  end function has_skirt_corners

  !> Whether a pin or the piston in its bore has clearance. The ideal twin has none.
  pure logical function has_clearance_anywhere(self)
    class(case_t), intent(in) :: self
    has_clearance_anywhere = self%has_play() .or. self%has_loose_guide()
  end function has_clearance_anywhere

  !> Whether the rod or the crankshaft is elastic.
  pure logical function is_elastic(self)
    class(case_t), intent(in) :: self
    is_elastic = allocated(self%elastic_rod) .or. allocated(self%crankshaft)
  end function is_elastic

  !> Become the case of the summary of the ideal twin: with ideal joints, and without notes on the case.
  subroutine become_ideal(self)
    class(case_t), intent(inout) :: self
    integer :: i
    do i = 1, n_places
      self%joints(i)%kind = 'ideal'
    end do
    if (allocated(self%notes)) deallocate (self%notes)
  end subroutine become_ideal

  !> Whether there are several cylinders, or a crankshaft of several stations.
  pure logical function has_train(self)
    class(case_t), intent(in) :: self
    has_train = allocated(self%shaft)
    if (allocated(self%cylinders)) has_train = has_train .or. size(self%cylinders) > 1
  end function has_train

  !> Number of the bearings at a place of which each may be computed: main bearings along the shaft, or big ends of the cylinders;
  !> 0: the place has no numbers.
  pure integer function n_bearings(self, place)
    class(case_t), intent(in) :: self
    integer, intent(in) :: place   !! index in `places`
    integer :: throw(most_cylinders)
    logical :: has_crank(most_cylinders)
    n_bearings = 0
    if (.not. allocated(self%cylinders)) return
    if (place == crank_pin) n_bearings = size(self%cylinders)
    if (place /= main_bearing) return
    call number_throws(self%cylinders, throw(:size(self%cylinders)), has_crank(:size(self%cylinders)))
    n_bearings = maxval(throw(:size(self%cylinders))) + 1
  end function n_bearings

  !> Whether the bearings at a place are numbered: all main bearings, and big ends on request.
  pure logical function has_numbers(self, place)
    class(case_t), intent(in) :: self
    integer, intent(in) :: place   !! index in `places`
    has_numbers = self%joints(place)%is_carried() .and. self%n_bearings(place) > 0
    if (has_numbers) has_numbers = place == main_bearing .or. self%joints(place)%numbers /= ''
  end function has_numbers

  !> The bearings at a place (see `joint_places`): itself, or those that have the wanted numbers.
  pure function spots(self, place) result(at)
    class(case_t), intent(in) :: self
    integer, intent(in) :: place   !! index in `places`
    integer, allocatable :: at(:)
    integer :: n, i
    at = [place]
    if (.not. self%has_numbers(place)) return
    n = self%n_bearings(place)
    at = pack([(spot_of(place, i), i=1, n)], [(self%joints(place)%wants_number(i), i=1, n)])
  end function spots

  !> Angles of the shaft by which the cylinders come later than a mark to the same point of the cycle [degrees].
  pure function delays(self)
    class(case_t), intent(in) :: self
    real(dp) :: delays(size(self%cylinders))
    delays = -sign(1.0_dp, self%initial%crank_speed)*(self%cylinders%phase_deg - self%cylinders%bank_deg)
  end function delays

  subroutine mechanism_parameters(self, list)
    class(mechanism_case_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call list%add('crank_length', self%crank_length, 'distance from the crank axis to the crank pin', 'm', '> 0', &
      example='0.0508', usual='2e-3 to 2')
    call list%add('crank_mass', self%crank_mass, 'mass of the crank', 'kg', '>= 0', example='0.80', usual='1e-3 to 1e5')
    call list%add('crank_inertia', self%crank_inertia, 'moment of inertia of the crank about its centre of mass', 'kg m^2', &
      '>= 0', example='0.006', usual='1e-8 to 1e6')
    call list%add('crank_com', self%crank_com, &
      'centre of mass of the crank from the crank axis, along and across the crank', 'm', default='0.0', usual='0 to 2')
    call list%add('rod_length', self%rod_length, 'distance from the crank pin to the piston pin', 'm', '> 0', example='0.2032', &
      usual='5e-3 to 1000')
    call list%add('rod_mass', self%rod_mass, 'mass of the connecting rod', 'kg', '>= 0', example='1.36', usual='1e-4 to 1e4')
    call list%add('rod_inertia', self%rod_inertia, 'moment of inertia of the rod about its centre of mass', 'kg m^2', '>= 0', &
      example='0.010', usual='1e-9 to 1e5')
    call list%add('rod_com', self%rod_com, &
      'centre of mass of the rod from the crank pin, along and across the rod', 'm', default='0.0', example='0.0508, 0.0', &
      usual='0 to 10')
    call list%add('piston_mass', self%piston_mass, 'mass of the piston', 'kg', '> 0', example='0.91', usual='1e-4 to 1e4')
    call list%add('axis_offset', self%axis_offset, 'offset of the cylinder axis from the crank axis, along y; > 0 where '// &
      'crank_speed is > 0: the rod is straighter on the way down', 'm', default='0.0', usual='0 to 0.5')
    call list%add('gravity', self%gravity, &
      'acceleration of gravity; acts from the cylinder towards the crank unless gravity_angle_deg turns it', 'm/s^2', &
      default='9.80665', usual='0.1 to 30')
    call list%add('gravity_angle_deg', self%gravity_angle_deg, &
      'direction of gravity: 0 from piston to crank along the cylinder; 90 across it, along -y', 'degrees', &
      any_angle, default='0.0', usual='0 to 360')
  end subroutine mechanism_parameters

  !> The lengths from which strokes and dead centres follow.
  pure type(linkage_t) function linkage_of(self)
    class(mechanism_case_t), intent(in) :: self
    linkage_of = linkage_t(self%crank_length, self%rod_length, self%axis_offset)
  end function linkage_of

  subroutine drive_parameters(self, list)
    class(drive_case_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call list%word('kind', self%kind, 'free, constant_speed', 'free', &
      'free: the forces accelerate the crank; constant_speed: the crank is held at crank_speed')
    call list%add('torque', self%torque, &
      'constant moment on a free crank, positive in the sense of the crank angle', 'N m', default='0.0', usual='0 to 1e6')
    call list%add('damping', self%damping, &
      'damping moment per crank speed; with constant_speed it only adds to the column crank_moment', &
      'N m s/rad', '>= 0', default='0.0', usual='0 to 1e3')
    call list%add('flywheel_inertia', self%flywheel_inertia, &
      'moment of inertia of a flywheel fixed to the crank, added to crank_inertia', 'kg m^2', '>= 0', default='0.0', &
      usual='1e-7 to 1e6')
    call self%table%parameters(list, 'torque_table', &
      'CSV file with columns speed[rad/s],torque[N.m], path relative to the case file; added to torque; '// &
      'beyond its first and last speed the torque is that at the nearer end', &
      default='')
    call list%add('ramp_time', self%ramp_time, 'time in which the held speed rises to crank_speed; 0: crank_speed from the start', &
      's', '> 0', default='0.0', usual='1e-4 to 1e3')
    call list%add('ramp_from', self%ramp_from, 'held speed at the start of the ramp (ramp_time)', 'rad/s', any_speed, &
      default='0.0', usual='0 to 2100')
  end subroutine drive_parameters

  subroutine initial_parameters(self, list)
    class(initial_case_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    character(len=:), allocatable :: name
    integer :: i
    call list%add('crank_angle_deg', self%crank_angle_deg, 'crank angle from the cylinder axis', 'degrees', &
      any_angle, '0.0', usual='0 to 720')
    call list%add('crank_speed', self%crank_speed, &
      'crank speed; with drive kind constant_speed it is held', 'rad/s', any_speed, example='250.0', usual='0 to 2100')
    do i = 1, n_places
      name = name_prefix(in_order(i))//'eccentricity'
      call list%add(name, self%eccentricity(:, in_order(i)), 'centre of the '//pin_title(in_order(i))// &
        ' from the centre of its bearing (x, y); in contact if longer than the clearance', 'm', default='0.0', usual='0 to 1e-2')
      if (in_order(i) == main_bearing) cycle   ! its rate follows from the load
      call list%add(name//'_rate', self%eccentricity_rate(:, in_order(i)), 'rate of '//name, 'm/s', any_speed, default='0.0', &
        usual='0 to 100')
    end do
    call list%add('pin_speed', self%pin_speed, 'angular speed of a floating pin, positive from x to y', 'rad/s', any_speed, &
      default='0.0', usual='0 to 2100')
    call list%add('piston_offset', self%piston_offset, &
      'centre of mass of the piston from the cylinder axis along y (guide with clearance)', 'm', default='0.0', usual='0 to 1e-2')
    call list%add('piston_offset_rate', self%piston_offset_rate, 'rate of piston_offset', 'm/s', any_speed, default='0.0', &
      usual='0 to 100')
    call list%add('piston_tilt', self%piston_tilt, 'tilt of the piston in its bore, positive from x to y', 'rad', default='0.0', &
      usual='0 to 0.2')
    call list%add('piston_tilt_rate', self%piston_tilt_rate, 'rate of piston_tilt', 'rad/s', any_speed, default='0.0', &
      usual='0 to 200')
    call list%text('from', self%from, &
      'start from the state in this file, a NAME.state.nml, path relative to the case file; crank_speed remains the held '// &
      'speed and the natural size of speeds, the other values are those of the file', '', is_path=.true.)
    call list%add('goes_on', self%goes_on, &
      '.true.: time, energies, wear and extremes go on from those of that file; .false.: they begin at 0 with its motion', '.true.')
  end subroutine initial_parameters

  subroutine integrator_parameters(self, list)
    class(integrator_case_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call list%word('method', self%method, 'auto, adams, radau', 'auto', &
      'adams: Shampine and Gordon; radau: implicit, for stiff films; auto: Radau in stiff phases, else Adams')
    call list%add('revolutions', self%revolutions, &
      'end of the run: time of this many revolutions at crank_speed; a crank that slows down makes fewer', range='> 0', &
      default='0.0', example='4.0', family='end', usual='1e-3 to 1e5')
    call list%add('crank_revolutions', self%crank_revolutions, &
      'end of the run: revolutions that the crank itself has made; exit status 4 if it stops or turns back', range='> 0', &
      default='0.0', family='end', beside='end_time', usual='1e-3 to 1e5')
    call list%add('end_time', self%end_time, &
      'end of the run; with crank_revolutions an upper limit (default: when one takes as long as 100 at crank_speed)', 's', '> 0', &
      default='0.0', family='end', usual='1e-6 to 1e4')
    call list%add('relative_tolerance', self%relative_tolerance, &
      'relative error allowed in each step; values above 1e-3 act as 1e-3', range='> 0 and <= 0.1', default='1.0e-6', &
      usual='1e-13 to 1e-3')
    call list%add('absolute_tolerance', self%absolute_tolerance, &
      'absolute error allowed in each step; 0: relative_tolerance times natural scales', range='> 0 and <= 0.1', default='0.0', &
      usual='1e-16 to 1e-3')
    call list%add('max_step', self%max_step, 'largest step; 0: no limit', 's', '> 0', default='0.0', usual='1e-9 to 1')
    call list%add('max_order', self%max_order, 'highest order of the method', '>= 1 and <= 12', '12')
    call list%word('contact_entry', self%contact_entry, 'root, step_rejection', 'root', &
      'how the beginning of a contact is found: root of the film thickness, or rejection of deep steps')
    call list%add('max_penetration', self%max_penetration, &
      'largest penetration at the beginning of a contact; required by step_rejection', 'm', '> 0', default='0.0', &
      usual='1e-12 to 1e-4')
    call list%add('max_steps', self%max_steps, 'largest number of steps; 0: no limit', '> 0', '0')
    call list%add('max_evaluations', self%max_evaluations, &
      'largest number of evaluations of the right-hand side; a run that needs more ends with exit status 4', &
      '> 0 and <= 2000000000', '1000000000')
    call list%add('max_evaluations_per_revolution', self%max_evaluations_per_revolution, &
      'the same limit for one revolution; 0: no limit', '> 0 and <= 2000000000', '100000000')
  end subroutine integrator_parameters

  subroutine output_parameters(self, list)
    class(output_case_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call list%word('sampling', self%sampling, 'time, crank_angle', 'time', &
      'time: rows at equal times; crank_angle: rows at equal crank angles')
    call list%add('samples_per_revolution', self%samples_per_revolution, &
      'number of rows for each revolution', '>= 1 and <= 1000000', '720')
    call list%add('angle_origin_deg', self%angle_origin_deg, &
      'one of the crank angles at which sampling = ''crank_angle'' writes rows', 'degrees', any_angle, '0.0', &
      usual='0 to 720')
    call list%add('interval', self%interval, 'time between rows; 0: given by samples_per_revolution', 's', '> 0', default='0.0', &
      usual='1e-9 to 1')
    call list%add('start_time', self%start_time, 'time of the first row', 's', '>= 0', default='0.0', usual='0 to 1e4')
    call list%text('columns', self%columns, &
      'columns of the trace: ''standard'', names without units, or both, separated by commas', 'standard', many=.true.)
    call list%add('digits', self%digits, 'significant digits of the numbers in a trace; 17 keep every bit', '>= 9 and <= 17', '10')
    call list%text('film_times', self%film_times, &
      'times [s] of pressure fields in NAME.film.csv, of a skirt in NAME.skirt.csv: t1, t2, ... or from:to:count', '')
    call list%add('every_step', self%every_step, &
      'write rows at the steps of the integrator instead of those at equal times', '.false.')
    call list%add('answers', self%answers, 'extremes, losses and work of the last whole cycle in the summary', '.true.')
    call list%add('ideal_twin', self%ideal_twin, 'also run the same mechanism with ideal joints and rigid bodies', '.false.')
    call list%word('window', self%window, 'all, last_period', 'all', &
      'all: the whole run; last_period: only the last period of a run until = ''periodic''')
  end subroutine output_parameters
end module case_definition
