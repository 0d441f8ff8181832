!> Describes in words why and where a run ended early.
module stop_reason
  use kinds, only: dp
  use constants, only: degree
  use number_text, only: short_text
  use ode_method, only: ode_settings_t, step_too_small, tolerance_too_small, start_outside, left_domain
  use ode_solver, only: step_limit_reached, integration_interrupted, chattering, evaluation_limit_reached
  use scene_problem, only: scene_t, evaluation_t
  use joint_places, only: in_order, spot_title
  use film_heat, only: hottest
  use chain_motion, only: tilting_t
  implicit none
  private
  public :: reason, place, interrupted_text, revolution_budget_spent, crank_turned_back, turns_not_made, &
    crank_creeps

  character(len=*), parameter :: interrupted_text = 'interrupted'

  !> Status codes in addition to those of `ode_solver` and `ode_method`.
  integer, parameter :: revolution_budget_spent = 21
  integer, parameter :: crank_turned_back = 22         !! or stopped, before the turns that end the run were complete
  integer, parameter :: turns_not_made = 23            !! not complete at the latest end of the run
  integer, parameter :: crank_creeps = 24              !! the crank takes too long for one turn

  real(dp), parameter :: tight_tolerance = 1e-12_dp    !! at tighter tolerances the rounding of the forces matters

contains

  !> Text that says why an integration with these settings ended at (t, y).
  function reason(status, scene, settings, t, y) result(text)
    integer, intent(in) :: status
    type(scene_t), intent(in) :: scene
    type(ode_settings_t), intent(in) :: settings
    real(dp), intent(in) :: t, y(:)
    character(len=:), allocatable :: text
    select case (status)
    case (step_too_small)
      text = small_step_reason(scene, settings, t, y)
    case (tolerance_too_small)
      text = 'tolerance below the rounding of the state'
    case (left_domain, start_outside)
      text = hot_film_reason(scene, y)
      if (text /= '') return
      text = 'the state left the range of the model'//leaving_parts(scene, y)
      if (scene%is_singular(y)) text = ill_posed_text(scene, y)
    case (step_limit_reached)
      text = 'too many steps (&integrator max_steps)'
    case (evaluation_limit_reached)
      text = 'limit of evaluations reached (&integrator max_evaluations)'
    case (revolution_budget_spent)
      text = 'limit of evaluations in one revolution reached (&integrator max_evaluations_per_revolution)'
    case (crank_turned_back)
      text = 'the crank stopped or turned back after '//turns_text(scene, t, y)
    case (turns_not_made)
      text = 'the crank has made only '//turns_text(scene, t, y)//' until the time limit (&integrator end_time)'
    case (crank_creeps)
      text = 'the crank creeps: one revolution takes longer than 100 at its starting speed, after '//turns_text(scene, t, y)
    case (integration_interrupted)
      text = interrupted_text
    case (chattering)
      text = 'contact events without progress in time (chatter)'
    case default
      text = 'stopped'
    end select
  end function reason

  !> What may have left the range of its model, in parentheses; empty: nothing of this scene.
  function leaving_parts(scene, y) result(text)
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: y(:)
    character(len=:), allocatable :: text
    text = leaving_body(scene, y)
    if (film_at_wall(scene) /= '') text = text//', or '//film_at_wall(scene)//' went into the bore, through its asperities'
    if (spring_states(scene) > 0) text = text//', or the springs of its faces balance at no rates'
    if (scene%chain%has_elastic_rod()) text = text//', or the elastic rod bent or stretched beyond the validity of its equations'
    if (index(text, ', or ') == 1) text = text(6:)
    if (text /= '') text = ' ('//text//')'
  end function leaving_parts

  !> What has a film at the bore; empty: nothing.
  pure function film_at_wall(scene) result(text)
    type(scene_t), intent(in) :: scene
    character(len=:), allocatable :: text
    text = ''
    if (.not. allocated(scene%guide)) return
    if (scene%guide%is_loose .and. scene%guide%touching == 0) text = 'the skirt'
    if (scene%guide%n_states == spring_states(scene)) return
    if (text /= '') text = text//' or '
    text = text//'a piston ring'
  end function film_at_wall

  !> Number of states of the springs of a skirt with elastic faces.
  pure integer function spring_states(scene)
    type(scene_t), intent(in) :: scene
    spring_states = 0
    if (.not. allocated(scene%guide)) return
    if (scene%guide%filmed > 0) spring_states = scene%guide%slots(scene%guide%filmed)%element%n_states
  end function spring_states

  !> Text that says that a film has left the range of temperatures, or an empty one.
  function hot_film_reason(scene, y) result(text)
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: y(:)
    character(len=:), allocatable :: text
    real(dp), parameter :: close = 1   !! to the limit [K]
    integer :: i
    text = ''
    do i = 1, size(scene%joints)
      if (.not. allocated(scene%joints(i)%heat)) cycle
      if (scene%joints(i)%heat%temperature(y) > hottest - close) text = 'the film of the '//joint_name(scene, i)//' reached '// &
        short_text(hottest, 3)//' K: no steady state; more side_flow or conductance'
    end do
  end function hot_film_reason

  !> Number of turns that the crank has made, as a text, in a scene that counts them.
  function turns_text(scene, t, y) result(text)
    class(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t, y(:)
    character(len=:), allocatable :: text
    text = short_text(scene%turns%made(scene%crank_angle(t, y)), 4)//' of '//short_text(scene%turns%wanted, 4)// &
      ' revolutions ('//trim(scene%turns%key)//')'
  end function turns_text

  function ill_posed_text(scene, y) result(text)
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: y(:)
    character(len=:), allocatable :: text
    character(len=:), allocatable :: at
    integer :: i
    at = ''
    do i = 1, size(scene%joints)
      if (has_plain_names(scene) .or. .not. scene%joints(i)%is_singular(y)) cycle
      if (at /= '') at = at//' and'
      at = at//' at the '//joint_name(scene, i)
    end do
    text = 'ill-posed: the film'//at//' has almost no thickness and an unbounded force'
  end function ill_posed_text

  !> The pin with clearance, or the piston in a dry bore, that is nearest to the limit of its position, relative to that limit, as a
  !> text; empty without such a body.
  function leaving_body(scene, y) result(text)
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: y(:)
    character(len=:), allocatable :: text
    type(tilting_t) :: tilting
    real(dp) :: part, largest
    integer :: i
    text = ''
    largest = -1
    do i = 1, size(scene%joints)
      associate (at => scene%joints(i)%at%position)
        part = norm2(y(at:at + 1))/scene%joints(i)%reach(scene%joints(i)%phase)
      end associate
      if (part > largest) then
        text = 'the pin'
        if (.not. has_plain_names(scene)) text = 'the '//joint_name(scene, i)
        text = text//' left its bearing or its film'
      end if
      largest = max(largest, part)
    end do
    if (.not. allocated(scene%guide)) return
    if (scene%guide%touching == 0) return
    call scene%guide%read_state(y, tilting)
    if (scene%guide%reached(tilting) > largest) text = 'the piston left its bore'
  end function leaving_body

  !> Whether no place but the first has a joint with clearance, so that texts need not name it.
  pure logical function has_plain_names(scene)
    type(scene_t), intent(in) :: scene
    has_plain_names = all(scene%joints%spot == in_order(1))
  end function has_plain_names

  !> The name of the pin of a joint, for messages.
  pure function joint_name(scene, i) result(text)
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: i
    character(len=:), allocatable :: text
    text = spot_title(scene%joints(i)%spot)
  end function joint_name

  !> Text that says why no step size was small enough.
  function small_step_reason(scene, settings, t, y) result(text)
    type(scene_t), intent(in) :: scene
    type(ode_settings_t), intent(in) :: settings
    real(dp), intent(in) :: t, y(:)
    character(len=:), allocatable :: text
    real(dp), parameter :: appreciable = 0.01_dp
    text = hot_film_reason(scene, y)
    if (text /= '') return
    if (scene%is_singular(y)) then
      text = ill_posed_text(scene, y)
    else if (settings%tolerance <= tight_tolerance) then
      text = 'tolerance below the rounding of the forces'
    else if (change_in_rounding(scene, settings, t, y) > appreciable) then
      text = 'too stiff: in the smallest representable time step the state changes by more than the tolerance'
    else
      text = 'the step size became too small'
    end if
  end function small_step_reason

  !> Change of the state in the shortest step that the time resolves, relative to the tolerance.
  real(dp) function change_in_rounding(scene, settings, t, y)
    type(scene_t), intent(in) :: scene
    type(ode_settings_t), intent(in) :: settings
    real(dp), intent(in) :: t, y(:)
    real(dp) :: rates(size(y)), weight, step
    logical :: in_domain
    integer :: i
    change_in_rounding = 0
    call scene%derivatives(t, y, rates, in_domain)
    if (.not. in_domain) return
    step = 4*epsilon(t)*max(abs(t), 1e-9_dp*settings%span)
    do i = 1, size(y)
      weight = settings%relative(i)*abs(y(i)) + settings%absolute(i)
      if (weight > 0) change_in_rounding = max(change_in_rounding, step*abs(rates(i))/weight)
    end do
  end function change_in_rounding

  !> Time, crank angle and the phase of each joint at the present point of a run.
  function place(scene, t, y) result(text)
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t, y(:)
    character(len=:), allocatable :: text
    character(len=*), parameter :: phase_names(0:2) = [character(len=13) :: 'free flight', 'film', 'contact']
    integer, parameter :: digits = 9
    type(evaluation_t) :: now
    logical :: in_domain
    integer :: i
    call scene%evaluate(t, y, now, in_domain)
    text = 't = '//short_text(t, digits)//' s, crank angle '//short_text(now%motion%crank_angle/degree, digits)//' deg'
    do i = 1, size(scene%joints)
      text = text//trim(merge(', phase', ',      ', i == 1))//' '//trim(phase_names(scene%joints(i)%phase))
      if (.not. has_plain_names(scene)) text = text//' at the '//joint_name(scene, i)
    end do
  end function place
end module stop_reason
