!> Builds the scene of a case.
module scene_builder
  use kinds, only: dp
  use constants, only: two_pi, degree
  use error_handling, only: error_t
  use case_definition, only: case_t
  use ode_method, only: ode_settings_t
  use chain_motion, only: body_crank, body_big_end, body_piston
  use bearing_load, only: bearing_load_t
  use joint_places, only: in_order, piston_pin, small_end, place_of
  use chain_bodies, only: crank_t, rod_t, piston_t, drive_t, new_bodies
  use joint_events, only: may_touch, may_pass_static
  use load_elements, only: add_elements
  use guide_case, only: guide_case_t
  use guide_elements, only: build_guide
  use train_builder, only: build_train, build_other_gas, axis_gravity
  use film_heat, only: film_heat_t
  use cylinder_charge, only: charge_t
  use ideal_linkage, only: linkage_t
  use clearance_joint, only: clearance_joint_t
  use scene_problem, only: scene_t
  use monotone_cubic, only: new_monotone_cubic
  use crank_turns, only: new_crank_turns
  implicit none
  private
  public :: build_scene, assemble_scene, simulated_time, latest_end, longest_turn, sample_interval, settings_for

  !> Larger tolerances are replaced by this one: they would save nothing (data/manual/choices.md), and the accumulated errors of
  !> the steps would exceed the allowed error of results.
  real(dp), parameter :: loosest_tolerance = 1e-3_dp

  real(dp), parameter :: gas_margin = 0.1_dp   !! tolerance of the gas cycle, relative to that of the run

  !> Errors of the crank speed and of the work persist, and with them errors of the energy: they accumulate over thousands of steps,
  !> whereas errors of the pin decay in its film or its contacts. These components are therefore held to a smaller fraction of the
  !> tolerance, but not below rounding (gain and cost: data/manual/choices.md).
  real(dp), parameter :: lasting_share = 0.01_dp   !! for crank speed and work
  real(dp), parameter :: angle_share = 0.1_dp      !! for the crank angle, whose errors persist too but influence the energy less
  real(dp), parameter :: finest_tolerance = 1e-13_dp

  !> Components that grow without bound are held to at least this fraction of their value, which is their rounding error.
  real(dp), parameter :: rounding_share = 1e-14_dp

  real(dp), parameter :: first_angle = 0.1_dp   !! largest turn of the crank in the first step [rad]
  real(dp), parameter :: slow_down_factor = 100   !! allows for a crank that slows down
  real(dp), parameter :: longest_chatter = 1e-8_dp   !! [s]; needed where the crank hardly turns and gives no time scale

contains

  !> Build the scene of a case; with `ideal_joint` its ideal twin of rigid bodies without clearance. The reader of the case has
  !> checked it. Error: the gas cycle cannot be integrated.
  subroutine build_scene(case, ideal_joint, scene, error, without_tables)
    type(case_t), intent(in) :: case
    logical, intent(in) :: ideal_joint
    type(scene_t), allocatable, intent(out) :: scene
    type(error_t), allocatable, intent(out) :: error
    logical, intent(in), optional :: without_tables   !! the films compute no tables: the scene is not to be integrated
    logical :: makes_tables
    integer :: i

    makes_tables = .true.
    if (present(without_tables)) makes_tables = .not. without_tables
    call assemble_scene(case, ideal_joint, makes_tables, scene)
    call choose_entry(case, scene)
    if (.not. allocated(scene%given_load)) call build_bodies(case, ideal_joint, scene)
    if (scene%chain%has_elastic_rod()) call scene%chain%elastic%rod%prepare(scene%chain%bodies%rod)
    scene%start_angle = case%initial%crank_angle_deg*degree
    scene%start_speed = case%initial%crank_speed
    scene%span = simulated_time(case)
    call prepare_gas(case, scene, error)
    if (allocated(error)) return
    call scene%claim()
    if (scene%chain%drive%free_crank .and. case%run%is_until_periodic()) then
      allocate (scene%turns, source=new_crank_turns(real(case%run%most_revolutions, dp), scene%start_angle, scene%start_speed))
      scene%turns%key = '&run most_revolutions'
    else if (scene%chain%drive%free_crank .and. case%integrator%crank_revolutions > 0) then
      allocate (scene%turns, source=new_crank_turns(case%integrator%crank_revolutions, scene%start_angle, scene%start_speed))
    end if
    do i = 1, scene%n_joints
      if (.not. scene%joints(i)%has_worn_bore()) cycle
      allocate (scene%wear_cycle)
      scene%wear_cycle%turns = scene%joints(i)%wear%cycles_per_update
      scene%wear_cycle%begin = scene%start_angle
    end do
    call scene%prepare_start()
  end subroutine build_scene

  !> Build crank, rod and piston.
  subroutine build_bodies(case, ideal_joint, scene)
    type(case_t), intent(in) :: case
    logical, intent(in) :: ideal_joint
    type(scene_t), intent(inout) :: scene
    type(piston_t) :: piston
    real(dp) :: gravity(2)   ! along the axis of the cylinder towards the crank, rotated towards -y [m/s^2]
    associate (m => case%mechanism)
      piston = piston_t(m%piston_mass, axis_offset=m%axis_offset)
      if (case%has_floating_pin() .and. ideal_joint) piston%mass = piston%mass + case%pin%mass   ! it goes along the cylinder
      if (case%has_loose_guide() .and. .not. ideal_joint) &
        piston = piston_t(m%piston_mass, .true., case%guide%piston_inertia, case%guide%piston_com, m%axis_offset)
      gravity = axis_gravity(case)
      scene%chain%bodies = new_bodies(crank_t(m%crank_length, m%crank_mass, &
        m%crank_inertia + case%drive%flywheel_inertia, m%crank_com), &
        rod_t(m%rod_length, m%rod_mass, m%rod_inertia, m%rod_com), piston, gravity)
    end associate
  end subroutine build_bodies

  !> Let the journal and the bearing of a bearing by itself turn with the bodies that its load names, and prepare the load.
  subroutine give_load(load, scene)
    type(bearing_load_t), intent(in) :: load
    type(scene_t), intent(inout) :: scene
    allocate (scene%given_load, source=load)
    call scene%given_load%prepare()
    associate (joint => scene%joints(1))
      joint%site%pin_body = body_named(load%journal)
      joint%site%bearing = body_named(load%bearing)
      joint%bearing_turns = load%bearing /= 'fixed'
    end associate

  contains

    !> A body that turns as one of this name; the piston does not turn.
    pure integer function body_named(name) result(body)
      character(len=*), intent(in) :: name
      body = body_piston
      if (name == 'crank') body = body_crank
      if (name == 'rod') body = body_big_end
    end function body_named
  end subroutine give_load

  !> Assemble the parts of a scene from the case: joints with clearance, with their laws prepared, guide, elastic members and gas.
  !> With `makes_tables` missing tables of films are computed.
  subroutine assemble_scene(case, ideal_joint, makes_tables, scene)
    type(case_t), intent(in) :: case
    logical, intent(in) :: ideal_joint, makes_tables
    type(scene_t), allocatable, intent(out) :: scene
    integer, allocatable :: of_clearance(:)   ! places
    integer, allocatable :: carried(:)        ! spots
    integer :: n
    allocate (scene)
    scene%chain%drive = drive_t(case%drive%kind == 'free', case%drive%torque, case%drive%damping, 0.0_dp, 0.0_dp)
    call vary_drive(case, scene)
    of_clearance = pack(in_order, case%joints(in_order)%has_clearance() .and. .not. ideal_joint)
    allocate (carried(0))
    do n = 1, size(in_order)
      if (case%joints(in_order(n))%is_carried() .and. .not. ideal_joint) carried = [carried, case%spots(in_order(n))]
    end do
    scene%n_joints = size(of_clearance)
    allocate (scene%joints(size(of_clearance) + size(carried)), scene%carried(size(carried)))
    do n = 1, size(scene%joints)
      if (n <= scene%n_joints) then
        call build_joint(case, of_clearance(n), makes_tables, scene%joints(n))
      else
        associate (spot => carried(n - scene%n_joints), bearing => scene%carried(n - scene%n_joints))
          call build_joint(case, place_of(spot), makes_tables, scene%joints(n))
          scene%joints(n)%spot = spot
          bearing%joint = n
          bearing%load_share = case%joints(place_of(spot))%load_share
        end associate
      end if
    end do
    if (scene%n_joints > 0) scene%chain%is_loose = case%loose_pins()
    if (case%has_floating_pin() .and. .not. ideal_joint) call float_pin(case, scene)
    if (allocated(case%load) .and. .not. ideal_joint) call give_load(case%load, scene)
    if (allocated(case%guide) .and. .not. (ideal_joint .and. case%has_loose_guide()) .or. allocated(case%rings%rings)) &
      call add_guide(case, ideal_joint, scene)
    if (case%is_elastic() .and. .not. ideal_joint) then
      allocate (scene%chain%elastic)
      if (allocated(case%elastic_rod)) allocate (scene%chain%elastic%rod, source=case%elastic_rod)
      if (allocated(case%crankshaft)) allocate (scene%chain%elastic%crankshaft, source=case%crankshaft)
    end if
    if (case%has_train()) call build_train(case, ideal_joint, scene%chain%train)
    if (.not. (allocated(case%combustion) .or. allocated(case%measured))) return
    allocate (scene%gas)
    if (allocated(case%charge)) then
      allocate (scene%gas%charge)
      call scene%gas%charge%set_case(case%charge, case%walls, case%valves, &
        case%integrator%relative_tolerance)
    end if
    if (allocated(scene%chain%train) .and. allocated(case%cylinders)) &
      scene%gas%has_force = case%cylinders(scene%chain%train%full_number)%gas
  end subroutine assemble_scene

  !> Add the guide of the piston, with its rings.
  subroutine add_guide(case, ideal_joint, scene)
    type(case_t), intent(in) :: case
    logical, intent(in) :: ideal_joint
    type(scene_t), intent(inout) :: scene
    type(guide_case_t) :: wanted
    integer :: n
    if (allocated(case%guide)) wanted = case%guide
    if (ideal_joint .or. .not. allocated(case%guide)) call wanted%lose_clearance()
    wanted%film = case%skirt_film
    wanted%rings = case%rings
    if (allocated(case%combustion)) wanted%bore = case%combustion%bore
    if (allocated(case%measured)) wanted%bore = case%measured%bore
    allocate (scene%guide)
    call build_guide(wanted, scene%guide)
    scene%guide%start = [case%initial%piston_offset, case%initial%piston_tilt]
    scene%guide%start_rate = [case%initial%piston_offset_rate, case%initial%piston_tilt_rate]
    do n = 1, size(scene%joints)
      if (scene%joints(n)%site%bearing == body_piston) scene%joints(n)%bearing_turns = scene%guide%is_loose
    end do
  end subroutine add_guide

  !> Let the piston pin turn in both of its joints.
  subroutine float_pin(case, scene)
    type(case_t), intent(in) :: case
    type(scene_t), intent(inout) :: scene
    integer :: i
    allocate (scene%chain%floating)
    scene%chain%floating%mass = case%pin%mass
    scene%chain%floating%inertia = case%pin%inertia
    scene%chain%floating%start_speed = case%initial%pin_speed
    do i = 1, scene%n_joints
      if (any(scene%joints(i)%place == [piston_pin, small_end])) call scene%joints(i)%let_pin_float()
    end do
  end subroutine float_pin

  !> Set a torque that depends on the speed, or a prescribed speed with a run-up.
  subroutine vary_drive(case, scene)
    type(case_t), intent(in) :: case
    type(scene_t), intent(inout) :: scene
    associate (drive => case%drive)
      scene%runs_up = drive%kind == 'constant_speed' .and. drive%ramp_time > 0
      if (.not. (scene%runs_up .or. scene%chain%drive%free_crank .and. drive%table%is_wanted())) return
      allocate (scene%chain%varying)
      if (scene%runs_up) then
        scene%chain%varying%ramp_time = drive%ramp_time
        scene%chain%varying%first_speed = drive%ramp_from
        scene%chain%varying%last_speed = case%initial%crank_speed
      else
        allocate (scene%chain%varying%torque, source=new_monotone_cubic(drive%table%x, drive%table%y))
      end if
    end associate
  end subroutine vary_drive

  !> Prepare the gas for the starting angle.
  subroutine prepare_gas(case, scene, error)
    type(case_t), intent(in) :: case
    type(scene_t), intent(inout) :: scene
    type(error_t), allocatable, intent(out) :: error
    real(dp) :: tolerance
    logical :: has_force
    type(charge_t), allocatable :: charge
    type(linkage_t) :: linkage
    if (.not. allocated(scene%gas)) return
    has_force = scene%gas%has_force   ! a law begins the gas anew
    call move_alloc(scene%gas%charge, charge)
    tolerance = gas_margin*case%integrator%relative_tolerance
    linkage = case%mechanism%linkage()
    associate (sense => sign(1.0_dp, scene%start_speed))
      if (allocated(case%measured)) then
        call case%measured%prepare(linkage, sense, tolerance, scene%gas, error)
      else
        call case%combustion%prepare(linkage, sense, tolerance, scene%gas, error)
      end if
    end associate
    if (allocated(error)) return
    scene%gas%has_force = has_force
    if (allocated(charge)) call case%combustion%fill(linkage, sign(1.0_dp, scene%start_speed), scene%gas, charge)
    call move_alloc(charge, scene%gas%charge)
    call scene%gas%start(scene%start_angle, merge(case%drive%ramp_from, scene%start_speed, scene%runs_up))
    if (.not. allocated(scene%chain%train)) return
    associate (train => scene%chain%train)
      call build_other_gas(case, tolerance, scene%gas, train, scene%other_gas, error)
      if (allocated(error)) return
      call scene%other_gas%start(scene%gas, scene%start_angle + train%cylinders%shift, &
        merge(case%drive%ramp_from, scene%start_speed, scene%runs_up))
    end associate
  end subroutine prepare_gas

  !> How contacts begin, and which steps may be refused.
  subroutine choose_entry(case, scene)
    type(case_t), intent(in) :: case
    type(scene_t), intent(inout) :: scene
    integer :: i
    scene%enters_at_step_end = .false.
    scene%refuses_steps = .false.
    do i = 1, size(scene%joints)
      associate (joint => scene%joints(i))
        joint%max_penetration = case%integrator%max_penetration
        if (may_touch(joint) .and. case%integrator%contact_entry == 'step_rejection') scene%enters_at_step_end = .true.
        scene%refuses_steps = scene%refuses_steps .or. scene%enters_at_step_end .or. may_pass_static(joint)
      end associate
    end do
  end subroutine choose_entry

  !> Build a joint with the elements for the laws that the case names.
  subroutine build_joint(case, place, makes_tables, joint)
    type(case_t), intent(in) :: case
    integer, intent(in) :: place   !! index in `places`
    logical, intent(in) :: makes_tables
    type(clearance_joint_t), intent(out) :: joint
    type(film_heat_t) :: heat
    integer :: i
    joint%start_eccentricity = case%initial%eccentricity(:, place)
    joint%start_rate = case%initial%eccentricity_rate(:, place)
    call joint%set_place(place)
    associate (wanted => case%joints(place))
      joint%bearing = wanted%bearing(case%mechanism%rod_length)
      joint%pin_radius = joint%bearing%pin_radius()
      call add_elements(wanted, case%integrator%relative_tolerance, makes_tables, joint)
      if (allocated(wanted%wear)) allocate (joint%wear, source=wanted%wear)
      if (allocated(wanted%heat)) then
        call heat%prepare(wanted%heat, wanted%oil)
        call joint%heat_up(heat)
      end if
      joint%reports_film = (wanted%reports_film .or. wanted%is_carried() .and. case%output%answers) .and. allocated(wanted%film)
      do i = 1, joint%n_elements
        joint%slots(i)%element%is_reported = joint%reports_film
      end do
    end associate
  end subroutine build_joint

  !> Duration of the simulation [s] as far as it follows from the case: revolutions are counted at the starting speed; for turns of
  !> the crank this is a first estimate.
  pure real(dp) function simulated_time(case)
    type(case_t), intent(in) :: case
    real(dp) :: revolutions
    simulated_time = case%integrator%end_time
    revolutions = max(case%integrator%revolutions, case%integrator%crank_revolutions)   ! only one of them is given
    if (case%run%is_until_periodic()) revolutions = case%run%most_revolutions
    if (revolutions > 0 .and. abs(case%initial%crank_speed) > 0) simulated_time = revolutions*two_pi/abs(case%initial%crank_speed)
  end function simulated_time

  !> Latest end of the run [s]. If it is to end after a number of turns of a free crank, this is end_time or, if that is not given,
  !> `slow_down_factor` times the duration of these turns at the starting speed.
  pure real(dp) function latest_end(case)
    type(case_t), intent(in) :: case
    latest_end = simulated_time(case)
    if (case%drive%kind == 'constant_speed') return
    if (case%run%is_until_periodic()) then
      latest_end = slow_down_factor*latest_end
    else if (case%integrator%crank_revolutions > 0) then
      latest_end = slow_down_factor*latest_end
      if (case%integrator%end_time > 0) latest_end = case%integrator%end_time
    end if
  end function latest_end

  !> Longest time for one turn of a free crank that is to make a number of turns [s]; after it the crank counts as having stopped.
  !> It is the duration of `slow_down_factor` turns at the starting speed. There is no such limit if end_time is given with
  !> crank_revolutions.
  pure real(dp) function longest_turn(case)
    type(case_t), intent(in) :: case
    longest_turn = huge(longest_turn)
    if (case%drive%kind == 'constant_speed' .or. .not. abs(case%initial%crank_speed) > 0) return
    if (.not. case%run%is_until_periodic()) then
      if (.not. case%integrator%crank_revolutions > 0 .or. case%integrator%end_time > 0) return
    end if
    longest_turn = slow_down_factor*two_pi/abs(case%initial%crank_speed)
  end function longest_turn

  !> Time between samples [s].
  pure real(dp) function sample_interval(case)
    type(case_t), intent(in) :: case
    sample_interval = case%output%interval
    if (.not. sample_interval > 0) &
      sample_interval = two_pi/(abs(case%initial%crank_speed)*case%output%samples_per_revolution)
  end function sample_interval

  !> Settings of the integrator for a scene. The tolerance of component i is relative_tolerance*|y_i| (unless it grows without
  !> bound) + a*scale_i, where a is absolute_tolerance or, if that is 0, relative_tolerance; it is smaller for crank, work and
  !> pins that asperities carry. A hundred events within 1e-6 of a revolution, at most 1e-8 s, count as chatter.
  pure function settings_for(case, scene) result(settings)
    type(case_t), intent(in) :: case
    type(scene_t), intent(in) :: scene
    type(ode_settings_t) :: settings
    real(dp) :: scales(scene%n), factor, tolerance, steps(2)
    logical :: growing(scene%n)
    integer :: i, k

    settings%span = simulated_time(case)
    tolerance = min(case%integrator%relative_tolerance, loosest_tolerance)
    settings%tolerance = tolerance
    call scene%layout%natural_scales(scales, growing)
    factor = case%integrator%absolute_tolerance
    if (.not. factor > 0) factor = tolerance
    settings%relative = merge(0.0_dp, tolerance, growing)
    settings%absolute = factor*scales
    call tighten(settings, scene%work_at, lasting_share)
    if (scene%crank_moves) then
      call tighten(settings, scene%crank%rate, lasting_share)
      call tighten(settings, scene%crank%position, angle_share)
    end if
    do i = 1, size(scene%carried)   ! the velocity follows from the loads: a pin between asperities is placed within their height
      associate (place => scene%carried(i)%place, joint => scene%joints(scene%carried(i)%joint))
        if (.not. joint%slots(1)%element%change_length > 0) cycle
        do k = place%first, place%last
          call tighten(settings, k, joint%slots(1)%element%change_length/joint%bearing%clearance)
        end do
      end associate
    end do
    where (growing .and. scales > 0) settings%relative = rounding_share
    settings%first_step = first_angle/scene%speed_scale()
    steps = [case%integrator%max_step, 0.0_dp]   ! limits; 0: there is none
    if (allocated(scene%gas)) steps(2) = scene%gas%longest_turn()/scene%speed_scale()
    if (any(steps > 0)) settings%max_step = minval(steps, steps > 0)
    settings%max_order = case%integrator%max_order
    settings%max_evaluations = case%integrator%max_evaluations
    settings%chatter_time = min(1e-6_dp*two_pi/scene%speed_scale(), longest_chatter)
  end function settings_for

  !> Reduce the tolerance of one component to a fraction, but not below its rounding error.
  pure subroutine tighten(settings, i, share)
    type(ode_settings_t), intent(inout) :: settings
    integer, intent(in) :: i
    real(dp), intent(in) :: share
    real(dp) :: factor
    factor = min(1.0_dp, max(share, finest_tolerance/settings%tolerance))
    settings%relative(i) = factor*settings%relative(i)
    settings%absolute(i) = factor*settings%absolute(i)
  end subroutine tighten
end module scene_builder
