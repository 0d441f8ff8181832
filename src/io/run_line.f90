!> What the user is told about a run that has ended: the physics in one line and one for each further bearing, its cost, and the
!> notes on its results.
module run_line
  use kinds, only: dp
  use constants, only: two_pi
  use history_record, only: history_record_t
  use simulation, only: run_report_t
  use run_figures, only: pin_figures_t, floating_figures_t
  use period_watch, only: period_watch_t
  use joint_places, only: places, n_places, in_order, name_prefix, spot_title
  use case_definition, only: case_t
  use joint_case, only: joint_case_t
  use result_notes, only: notes_on_results, relative_residual, most_change
  use number_text, only: short_text, quantity_text
  use text_tools, only: integer_text, counted, printable, replaced
  implicit none
  private
  public :: lines_for_user

  character(len=*), parameter :: newline = achar(10)
  integer, parameter :: digits = 3

contains

  !> The lines for the user. Why a run ended early is in the message of its error.
  function lines_for_user(case, report, wall_time, path, remark) result(text)
    type(case_t), intent(in) :: case
    type(run_report_t), intent(in) :: report
    real(dp), intent(in) :: wall_time      !! [s]
    character(len=*), intent(in) :: path   !! path of the results without suffix
    character(len=*), intent(in) :: remark !! text about the certificate, or empty
    character(len=:), allocatable :: text, bearing, others, notes
    integer :: i
    associate (s => report%statistics, f => report%figures)
      text = 'ended early'
      if (report%status == 'done') text = report%status
      text = printable(case%name, 200)//': '//text//'; '//counted(short_text(abs(f%crank_travel)/two_pi, digits), &
        'revolution')//' in '//quantity_text(f%time, 's')
      if (report%periods%is_on .and. report%status == 'done') text = text//', '//period_text(report%periods)
      others = ''
      do i = 1, n_places
        associate (place => in_order(i))
          if (i > 1 .and. .not. case%joints(place)%has_bearing() .or. case%has_numbers(place)) cycle
          bearing = pin_text(case%joints(place), f%pin(place), case%integrator%relative_tolerance, report, place)
          if (.not. report%periods%is_on .and. is_driven(case)) bearing = bearing//settling_text(case%joints(place), f%pin(place))
          if (i == 1) text = text//'; '//bearing
          if (i > 1) others = others//newline//'  '//trim(places(place)%title)//': '//bearing
        end associate
      end do
      text = text//bearings_text(report)
      if (f%floating%is_present) text = text//'; '//turn_text(f%floating)
      if (case%has_skirt_corners()) text = text//'; piston skirt: '//counted(integer_text(sum(f%corner%contacts)), &
        'contact')//', force up to '//quantity_text(maxval(f%corner%max_force), 'N')
      text = text//skirt_text(report)
      if (allocated(report%histories)) text = text//histories_text(report%histories, allocated(case%load))
      if (report%exponent%is_known) text = text//'; Lyapunov exponent '//short_text(report%exponent%mean, digits)//' per revolution'
      if (remark /= '') text = text//'; '//remark
      text = text//others//newline//'  '//printable(path, 1000)//'.csv; '//integer_text(s%accepted)//' steps, '// &
        integer_text(s%evaluations)//' evaluations, '//short_text(wall_time, digits)//' s'
      if (f%max_energy > 0) text = text//'; relative energy residual '//short_text(relative_residual(report), 2)
      if (any(f%pin%heat%is_known)) text = text//'; relative heat residual '//short_text(f%heat_residual(), 2)
    end associate
    notes = notes_on_results(case, report)
    if (notes /= '') text = text//newline//'  note: '//replaced(notes, newline, newline//'  note: ')
  end function lines_for_user

  !> Text about numbered bearings: the thinnest film of the last cycle, and the losses; empty without such a cycle or bearings.
  function bearings_text(report) result(text)
    type(run_report_t), intent(in) :: report
    character(len=:), allocatable :: text, thinnest
    real(dp) :: thickness, power
    logical :: is_known
    text = ''
    call report%value_of('cycle_bearings_power', power, is_known)
    if (.not. is_known) return
    thinnest = trim(report%text_of('cycle_thinnest_bearing'))
    call report%value_of(thinnest//'_cycle_min_film_thickness', thickness, is_known)
    text = '; thinnest film '//quantity_text(thickness, 'm')//' at '//replaced(thinnest, '_', ' ')
    text = text//', bearings '//quantity_text(power, 'W')
  end function bearings_text

  !> Text about a lubricated skirt, in the last cycle, or of a run without one; empty: there is none.
  function skirt_text(report) result(text)
    type(run_report_t), intent(in) :: report
    character(len=:), allocatable :: text
    real(dp) :: film, speed
    logical :: is_known
    text = ''
    call last_value('min_skirt_film_thickness', film)
    if (is_known) call last_value('max_slap_speed', speed)
    if (is_known) text = '; film at the skirt from '//quantity_text(film, 'm')//', across the bore up to '// &
      quantity_text(speed, 'm/s')

  contains

    subroutine last_value(name, value)
      character(len=*), intent(in) :: name
      real(dp), intent(out) :: value
      call report%value_of('cycle_'//name, value, is_known)
      if (.not. is_known) call report%value_of(name, value, is_known)
    end subroutine last_value
  end function skirt_text

  !> Text about the turn of a floating pin.
  function turn_text(pin) result(text)
    type(floating_figures_t), intent(in) :: pin
    character(len=:), allocatable :: text
    text = 'the pin turns '//quantity_text(pin%turn, 'rad')
    if (pin%revolutions > 0) text = 'the pin drifts '//quantity_text(pin%drift, 'rad')//' a revolution and swings '// &
      quantity_text(pin%swing, 'rad')
  end function turn_text

  !> Text about the films with memory, each beside the film of the run.
  function histories_text(histories, is_alone) result(text)
    type(history_record_t), intent(in) :: histories(:)
    logical, intent(in) :: is_alone   !! the only bearing, without a mechanism
    character(len=:), allocatable :: text
    integer :: i
    text = ''
    do i = 1, size(histories)
      associate (found => histories(i)%history)
        if (.not. allocated(found%rows)) cycle
        if (size(found%rows) == 0) cycle
        text = text//'; film with memory'
        if (.not. is_alone) text = text//' at the '//spot_title(histories(i)%spot)
        text = text//': thinnest '//quantity_text(found%summary%min_thickness, 'm')//' ('// &
          quantity_text(minval(histories(i)%quick_thickness), 'm')//' in the run), pressure up to '// &
          quantity_text(found%summary%max_pressure, 'Pa')
      end associate
    end do
  end function histories_text

  !> Text about the period of the motion.
  function period_text(periods) result(text)
    type(period_watch_t), intent(in) :: periods
    character(len=:), allocatable :: text
    text = 'not periodic within '//counted(integer_text(periods%most_revolutions), 'revolution')
    if (periods%period == 0) return
    text = 'repeats every revolution'
    if (periods%period > 1) text = 'repeats every '//integer_text(periods%period)//' revolutions'
    text = text//', recognised after '//integer_text(periods%found_after)
  end function period_text

  !> Whether the crank is driven, so that the motion settles; otherwise it comes to rest.
  pure logical function is_driven(case)
    type(case_t), intent(in) :: case
    is_driven = case%drive%kind == 'constant_speed' .or. abs(case%drive%torque) > 0 .or. case%drive%table%is_wanted() .or. &
      allocated(case%combustion) .or. allocated(case%measured)
  end function is_driven

  !> Text about a film that has not settled; empty if it has.
  function settling_text(joint, pin) result(text)
    type(joint_case_t), intent(in) :: joint
    type(pin_figures_t), intent(in) :: pin
    character(len=:), allocatable :: text
    text = ''
    if (allocated(joint%film) .and. abs(pin%film_change) > most_change) text = &
      ', not settled: the film thickness still changes by '//short_text(100*abs(pin%film_change), 2)// &
      ' % from cycle to cycle (--set run.until=periodic)'
  end function settling_text

  !> Text about the contacts of a pin to which the theory of their law does not apply; empty if there are none.
  function beyond_text(pin) result(text)
    type(pin_figures_t), intent(in) :: pin
    character(len=:), allocatable :: text
    text = ''
    if (pin%impacts_beyond_validity > 0) text = integer_text(pin%impacts_beyond_validity)//' faster'
    if (pin%impacts_beyond_validity > 0 .and. pin%contacts_beyond_validity > 0) text = text//' and '
    if (pin%contacts_beyond_validity > 0) text = text//integer_text(pin%contacts_beyond_validity)//' deeper'
    if (text /= '') text = ' ('//text//' than the theory holds)'
  end function beyond_text

  !> A value of the last whole cycle in brackets, where it differs from that of the whole run by more than 5 %, as after a start far
  !> from the settled motion; empty otherwise.
  function cycle_text(report, name, unit, of_run) result(text)
    type(run_report_t), intent(in) :: report
    character(len=*), intent(in) :: name, unit   !! of the result of the cycle
    real(dp), intent(in) :: of_run
    character(len=:), allocatable :: text
    real(dp), parameter :: remarkable = 0.05_dp
    real(dp) :: value
    logical :: is_known
    call report%value_of(name, value, is_known)
    text = ''
    if (is_known .and. abs(value - of_run) > remarkable*abs(of_run)) text = ' ('//size_text(value, unit)//' in the last cycle)'
  end function cycle_text

  !> A size with its unit; the thickness of a film in um, so that bearings can be compared.
  function size_text(size, unit) result(text)
    real(dp), intent(in) :: size             !! in `unit`
    character(len=*), intent(in) :: unit     !! m: a thickness
    character(len=:), allocatable :: text
    text = quantity_text(size, unit)
    if (unit == 'm' .and. size >= 1e-9_dp .and. size < 1e-3_dp) text = short_text(1e6_dp*size, digits)//' um'
  end function size_text

  !> Text about one pin. The error of a table of the film is told if it is larger than the relative tolerance of the run.
  function pin_text(joint, pin, tolerance, report, place) result(text)
    type(joint_case_t), intent(in) :: joint
    type(pin_figures_t), intent(in) :: pin
    real(dp), intent(in) :: tolerance
    type(run_report_t), intent(in) :: report
    integer, intent(in) :: place   !! of the pin
    character(len=:), allocatable :: text
    text = ''
    if (joint%has_bearing()) then
      if (joint%can_touch()) text = counted(integer_text(pin%contacts), 'contact')//beyond_text(pin)//', '
      if (joint%can_touch() .and. pin%contacts == 0) text = 'no contact, '
      if (pin%min_film_thickness < 0) then
        text = text//'penetration up to '//quantity_text(-pin%min_film_thickness, 'm')//', '
      else if (allocated(joint%film) .and. pin%min_film_thickness < huge(1.0_dp)) then   ! there was a state in the model
        text = text//'film of at least '//size_text(pin%min_film_thickness, 'm')// &
          cycle_text(report, name_prefix(place)//'cycle_min_film_thickness', 'm', pin%min_film_thickness)//', '
        if (joint%film%table_of /= '' .and. joint%film%table_error > tolerance) &
          text = text//'its table good to '//short_text(100*joint%film%table_error, 2)//' %, '
      end if
    end if
    text = text//'pin force up to '//quantity_text(pin%max_force, 'N')// &
      cycle_text(report, name_prefix(place)//'cycle_max_force', 'N', pin%max_force)
  end function pin_text
end module run_line
