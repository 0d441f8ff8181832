!> Differences of neighbouring scenes from a first one, in one or two directions, for the largest Lyapunov exponent.
module state_differences
  use kinds, only: dp
  use scene_problem, only: scene_t
  use clearance_joint, only: most_joints
  implicit none
  private
  public :: differences_t, new_differences, most_directions, first_size

  integer, parameter :: most_directions = 2            !! followed in the first revolutions
  real(dp), parameter :: first_size = 1e-5_dp          !! initial size of a difference, relative to the natural sizes of the state

  !> Differences of the other scenes from the first one, each of the size 1 relative to the natural sizes, and orthogonal.
  type :: differences_t
    integer, allocatable :: at(:)                     !! indices of the compared components in the state
    real(dp), allocatable :: scale(:)                 !! their natural sizes
    real(dp), allocatable :: state(:, :)              !! (component, direction)
    real(dp), allocatable :: impact_speed(:, :)       !! of contacts that both scenes have (joint, direction) [m/s]
    real(dp) :: last_speed(most_joints) = -1          !! impact speeds of the first scene at the last measurement [m/s]
    integer :: lasts(most_joints) = 0                 !! measurements since they have changed
    integer :: most_lasts = huge(0)                   !! number of them after which a contact has come to stay
    real(dp), allocatable :: before(:, :)             !! `state` at the beginning of the period
    real(dp) :: made(most_directions, most_directions) = 0   !! by the period from `before`: `state` times this matrix
  contains
    procedure :: measure
    procedure :: straighten
    procedure :: begin_period
    procedure :: choose_one
  end type differences_t

contains

  !> The components of the state that are compared, their natural sizes, and the initial directions.
  type(differences_t) function new_differences(scene) result(differences)
    type(scene_t), intent(in) :: scene
    real(dp) :: scales(scene%n), unused(most_directions, most_directions)
    logical :: growing(scene%n)
    integer :: n, d
    call scene%layout%natural_scales(scales, growing)
    differences%at = scene%compared_states()
    differences%scale = scales(differences%at)
    n = size(differences%at)
    allocate (differences%state(n, min(n, most_directions)), differences%impact_speed(most_joints, min(n, most_directions)))
    differences%impact_speed = 0
    do d = 1, size(differences%state, 2)
      differences%state(:, d) = first_direction(n, d)*differences%scale
    end do
    call differences%straighten(unused)
  end function new_differences

  !> An initial direction that is not a special direction of the system: fractional parts of multiples of the golden ratio.
  pure function first_direction(n, which) result(direction)
    integer, intent(in) :: n, which
    real(dp) :: direction(n)
    integer :: i
    direction = [(modulo((i + n*(which - 1))*0.6180339887498949_dp, 1.0_dp) - 0.45_dp, i=1, n)]
  end function first_direction

  !> Measure the difference of a scene from the first one, relative to `first_size`. The impact speed of a contact that has come to
  !> stay is a constant of the motion: its difference, which would never shrink, is left out.
  subroutine measure(self, direction, scene, y, other_scene, other_y)
    class(differences_t), intent(inout) :: self
    integer, intent(in) :: direction
    type(scene_t), intent(in) :: scene, other_scene
    real(dp), intent(in) :: y(:), other_y(:)
    integer :: i
    self%state(:, direction) = (other_y(self%at) - y(self%at))/first_size
    self%impact_speed(:, direction) = 0
    do i = 1, scene%n_joints
      if (direction == 1) then
        self%lasts(i) = self%lasts(i) + 1
        if (abs(scene%joints(i)%impact_speed - self%last_speed(i)) > 0) self%lasts(i) = 0
        self%last_speed(i) = scene%joints(i)%impact_speed
      end if
      if (other_scene%joints(i)%phase /= scene%joints(i)%phase .or. self%lasts(i) >= self%most_lasts) cycle
      self%impact_speed(i, direction) = (other_scene%joints(i)%impact_speed - scene%joints(i)%impact_speed)/first_size
    end do
  end subroutine measure

  !> Make the differences orthogonal and of the size 1 (Gram and Schmidt). The differences before are those after times `factors`. A
  !> difference of size 0 is replaced by its initial direction.
  subroutine straighten(self, factors)
    class(differences_t), intent(inout) :: self
    real(dp), intent(out) :: factors(most_directions, most_directions)
    integer :: d, e
    factors = 0
    do d = 1, size(self%state, 2)
      do e = 1, d - 1
        factors(e, d) = sum(self%state(:, d)*self%state(:, e)/self%scale**2)
        self%state(:, d) = self%state(:, d) - factors(e, d)*self%state(:, e)
        self%impact_speed(:, d) = self%impact_speed(:, d) - factors(e, d)*self%impact_speed(:, e)
      end do
      factors(d, d) = size_of(self%state(:, d), self%scale)
      if (factors(d, d) > 0) then
        self%state(:, d) = self%state(:, d)/factors(d, d)
        self%impact_speed(:, d) = self%impact_speed(:, d)/factors(d, d)
      else
        self%state(:, d) = first_direction(size(self%at), d)*self%scale
        self%state(:, d) = self%state(:, d)/size_of(self%state(:, d), self%scale)
        self%impact_speed(:, d) = 0
      end if
    end do
    self%made = matmul(factors, self%made)
  end subroutine straighten

  !> Begin a period.
  subroutine begin_period(self)
    class(differences_t), intent(inout) :: self
    integer :: d
    self%before = self%state
    self%made = 0
    do d = 1, most_directions
      self%made(d, d) = 1
    end do
  end subroutine begin_period

  !> End a period: keep one direction, the eigenvector of what the period has made of the two, for the eigenvalue of the larger
  !> modulus; if the eigenvalues are complex, the first direction.
  subroutine choose_one(self)
    class(differences_t), intent(inout) :: self
    real(dp) :: turned(2, 2), matrix(2, 2), root, larger, sum_of(2)
    integer :: d, e
    if (size(self%state, 2) == 2) then
      do d = 1, 2
        do e = 1, 2
          turned(e, d) = sum(self%before(:, e)*self%state(:, d)/self%scale**2)
        end do
      end do
      matrix = matmul(turned, self%made)
      root = 0.25_dp*(matrix(1, 1) - matrix(2, 2))**2 + matrix(1, 2)*matrix(2, 1)
      if (root > 0) then
        larger = 0.5_dp*(matrix(1, 1) + matrix(2, 2))
        larger = larger + sign(sqrt(root), larger)
        sum_of = [matrix(1, 2), larger - matrix(1, 1)]
        if (abs(larger - matrix(2, 2)) > abs(sum_of(2))) sum_of = [larger - matrix(2, 2), matrix(2, 1)]
        sum_of = matmul(self%made, sum_of)
        if (norm2(sum_of) > 0) then
          self%state(:, 1) = matmul(self%state, sum_of/norm2(sum_of))
          self%impact_speed(:, 1) = matmul(self%impact_speed, sum_of/norm2(sum_of))
        end if
      end if
    end if
    self%made = 0
    self%state = self%state(:, :1)
    self%impact_speed = self%impact_speed(:, :1)
  end subroutine choose_one

  !> Size of a difference relative to the natural sizes.
  pure real(dp) function size_of(difference, scale)
    real(dp), intent(in) :: difference(:), scale(:)
    size_of = norm2(difference/scale)
  end function size_of
end module state_differences
