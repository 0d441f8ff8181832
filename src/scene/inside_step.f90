!> Evaluates a scene inside the last step of its integration, for output.
module inside_step
  use gudgeon_kinds, only: dp
  use ode_method, only: ode_method_t
  use gudgeon_scene, only: scene_t, evaluation_t
  implicit none
  private
  public :: look_inside

contains

  !> State at a time inside the last step, and the evaluation of the scene there. Where the method can improve its interpolant, the
  !> forces are otherwise less accurate than at the ends of steps, in a stiff film by orders of magnitude. `inside` is false if a
  !> model is not defined there.
  subroutine look_inside(scene, method, t, y, now, inside, evaluations)
    type(scene_t), intent(in) :: scene
    class(ode_method_t), intent(inout) :: method
    real(dp), intent(in) :: t
    real(dp), intent(out) :: y(scene%n)
    type(evaluation_t), intent(out) :: now
    logical, intent(out) :: inside
    integer, intent(inout) :: evaluations   !! number of evaluations, to which those made here are added
    real(dp) :: better(scene%n), rates(scene%n)
    logical :: is_better
    call method%interpolate(t, y)
    is_better = .false.
    if (method%may_improve(t)) then
      call scene%derivatives(t, y, rates, inside)
      evaluations = evaluations + 1
      better = y
      if (inside) call method%improve(t, rates, better, is_better)
    end if
    if (is_better) then
      call scene%evaluate(t, better, now, inside)
      evaluations = evaluations + 1
      if (inside) y = better
      if (inside) return
    end if
    call scene%evaluate(t, y, now, inside)
    evaluations = evaluations + 1
  end subroutine look_inside
end module inside_step
