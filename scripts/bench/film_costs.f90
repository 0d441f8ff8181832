!> The cost of the film of finite length: the time of a force from its table, compared with that of a sine and a cosine in the same
!> program; of its table, computed and read from a file; and of simulation I with it, compared with the closed form of Pinkus and
!> Sternlicht. Run by scripts/bench/film_costs.sh from the top of the checkout, with a folder for tables as its argument. Prints a
!> table in Markdown with the shortest of several times; a table is computed once.
program film_costs
  use, intrinsic :: iso_fortran_env, only: int64
  use kinds, only: dp
  use error_handling, only: error_t
  use case_definition, only: case_t
  use case_file, only: read_case
  use film_law, only: film_motion_t
  use film_files, only: provide_tables
  use measured_times, only: time_of_pairs, time_of_integration, no_difference
  use joint_places, only: piston_pin
  implicit none

  integer, parameter :: n_motions = 64, calls = 6400, blocks = 101, runs = 25, loads = 9
  character(len=*), parameter :: finite = 'cases/film/sim_I_finite.nml', long = 'cases/sim_I.nml'
  character(len=300) :: folder
  real(dp) :: pair(2), yardstick
  integer :: i

  call get_command_argument(1, folder)
  if (folder == '') error stop 'film_costs: give a folder for tables'
  print '(a)', '| what | measured | in pairs of sine and cosine, or over the closed form | wanted |'
  print '(a)', '|---|---|---|---|'
  pair = [minval([(time_of_pairs(calls, .false.), i=1, blocks)]), minval([(time_of_pairs(calls, .true.), i=1, blocks)])]
  print '(2(a,f0.1),a)', '| sine and cosine of an angle; each waiting for the one before | ', pair(1), ' ns; ', pair(2), ' ns | | |'
  call print_table('gumbel', 2)
  call print_table('reynolds', 2)
  call print_force('force from the table', finite, 'lubrication.cavitation=reynolds', 'at most 10')
  call print_force('force of the short bearing', finite, 'lubrication.variant=short', '')
  call print_force('force of the closed form of Pinkus and Sternlicht', long, 'lubrication.variant=closed_form', '')
  yardstick = time_of_run(long)
  print '(a,f0.2,a)', '| simulation I by `auto` at 1e-6, no output: closed form | ', yardstick, ' ms | 1 | |'
  associate (ms => time_of_run(finite))
    print '(2(a,f0.2),a)', '| the same with the film of finite length | ', ms, ' ms | ', ms/yardstick, ' | at most 3 |'
  end associate

contains

  !> Read a case; the table of a film of finite length is stored in the folder of tables.
  subroutine read_film(file, setting, case)
    character(len=*), intent(in) :: file, setting
    type(case_t), intent(out) :: case
    type(error_t), allocatable :: error
    character(len=400) :: settings(5)
    settings = [character(len=400) :: 'integrator.method=auto', 'output.ideal_twin=F', setting, 'lubrication.viscosity=0.0117', '']
    if (file == finite) settings(5) = "lubrication.table_file='"//trim(folder)//'/'//setting//".table'"
    call read_case(file, settings(:merge(5, 4, file == finite)), case, error)
    if (allocated(error)) error stop 'film_costs: run it from the top of the checkout'
  end subroutine read_film

  !> Provide the table of the film of a case and prepare the film.
  subroutine prepare(case)
    type(case_t), intent(inout) :: case
    type(error_t), allocatable :: error
    call provide_tables(case, .false., .false., error)
    if (allocated(error)) error stop 'film_costs: no table'
    call case%joints(piston_pin)%film%prepare(case%joints(piston_pin)%bearing(case%mechanism%rod_length), &
      case%integrator%relative_tolerance)
  end subroutine prepare

  !> Print the times in which the table is computed and then read.
  subroutine print_table(cavitation, wanted)
    character(len=*), intent(in) :: cavitation
    integer, intent(in) :: wanted   !! [s]
    type(case_t) :: case
    integer(int64) :: before, after, rate
    real(dp) :: seconds(0:loads)
    integer :: i
    do i = 0, loads
      call read_film(finite, 'lubrication.cavitation='//cavitation, case)
      call system_clock(before, rate)
      call prepare(case)
      call system_clock(after)
      seconds(i) = real(after - before, dp)/real(rate, dp)
    end do
    print '(3a,f0.2,a,i0,a)', '| table of 65 x 65 values from 128 nodes, ', cavitation, ' | ', seconds(0), ' s | | ', wanted, ' s |'
    print '(a,f0.4,a)', '| the same read from its file | ', minval(seconds(1:)), ' s | | 0.05 s |'
  end subroutine print_table

  !> Print the time of a force, independent of the others and in turn.
  subroutine print_force(what, file, setting, wanted)
    character(len=*), intent(in) :: what, file, setting, wanted
    type(case_t) :: case
    real(dp) :: ns(2)
    call read_film(file, setting, case)
    call prepare(case)
    ns = [time_of_force(case, .false.), time_of_force(case, .true.)]
    print '(2a,4(a,f0.1),3a)', '| ', what, ' | ', ns(1), ' ns; ', ns(2), ' ns | ', ns(1)/pair(1), '; ', ns(2)/pair(2), ' | ', &
      wanted, ' |'
  end subroutine print_force

  !> Shortest time of a force [ns], at eccentricity ratios from 0.1 to 0.9 and velocities in every direction.
  real(dp) function time_of_force(case, in_turn) result(ns)
    type(case_t), intent(in) :: case
    logical, intent(in) :: in_turn
    type(film_motion_t) :: motions(n_motions), motion
    integer(int64) :: before, after, rate
    real(dp) :: force(2), moment, total, turn
    integer :: i, j
    do j = 1, n_motions
      turn = 40*real(j, dp)/n_motions
      motions(j)%eccentricity = case%joints(piston_pin)%clearance*(0.1_dp + 0.8_dp*j/n_motions)*[cos(turn), sin(turn)]
      motions(j)%eccentricity_rate = 2e-3_dp*[cos(3*turn), sin(5*turn)]
      motions(j)%pin_speed = 60*cos(2*turn)
      motions(j)%turning_speed = motions(j)%pin_speed
    end do
    ns = huge(ns)
    total = 0
    do i = 1, blocks
      call system_clock(before, rate)
      do j = 1, calls
        motion = motions(modulo(j, n_motions) + 1)
        if (in_turn) motion%eccentricity(1) = motion%eccentricity(1) + no_difference*total
        call case%joints(piston_pin)%film%film_force(motion, force, moment)
        total = force(1) + force(2) + moment
      end do
      call system_clock(after)
      ns = min(ns, 1e9_dp*real(after - before, dp)/real(rate, dp)/calls)
    end do
    if (total > huge(total)) print *, total
  end function time_of_force

  !> Shortest time of an integration of simulation I [ms].
  real(dp) function time_of_run(file) result(ms)
    character(len=*), intent(in) :: file
    type(case_t) :: case
    integer :: i
    call read_film(file, trim(merge('lubrication.cavitation=reynolds', 'lubrication.variant=closed_form', file == finite)), case)
    call prepare(case)
    ms = minval([(time_of_integration(case, .false.), i=1, runs)])
  end function time_of_run
end program film_costs
