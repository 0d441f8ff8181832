!> Equations of motion of a chain from its bodies one by one.
!>
!> Each body has velocities v of its own, few and simple (of a point and a turning speed, and of modes where it is elastic), with
!> its own mass matrix M. They follow from the rates z' of the chain's coordinates by a velocity map J, and so do its accelerations:
!>
!>     v = J z',    v' = J z'' + b
!>
!> By virtual work every body adds J^T M J to the mass matrix of the chain and J^T (Q - M b) to its forces, Q being what acts on the
!> body and what its own motion asks for (centripetal terms). The mass matrix is symmetric and positive definite: no constraints
!> are left, since the coordinates are independent.
module gudgeon_assembly
  use gudgeon_kinds, only: dp
  use small_cholesky, only: factorise_cholesky, solve_cholesky
  implicit none
  private
  public :: equations_t, body_t, most_coordinates, most_velocities

  integer, parameter :: most_coordinates = 24   !! of a chain
  integer, parameter :: most_velocities = 20    !! of a body

  !> One body, as the chain moves it. `begin` sets as many numbers to 0 as it has.
  type :: body_t
    integer :: n = 0                                          !! velocities
    real(dp) :: map(most_velocities, most_coordinates)        !! J: velocities by the rates of the coordinates
    real(dp) :: bias(most_velocities)                         !! b: accelerations where those of the coordinates vanish
    real(dp) :: mass(most_velocities, most_velocities)        !! M
    real(dp) :: load(most_velocities)                         !! Q
  contains
    procedure :: begin => begin_body
  end type body_t

  !> mass z'' = force, for n coordinates.
  type :: equations_t
    integer :: n = 0
    real(dp) :: mass(most_coordinates, most_coordinates)
    real(dp) :: force(most_coordinates)
  contains
    procedure :: begin
    procedure :: add
    procedure :: solve
  end type equations_t

contains

  pure subroutine begin_body(self, n, n_coordinates)
    class(body_t), intent(inout) :: self
    integer, intent(in) :: n               !! velocities
    integer, intent(in) :: n_coordinates   !! of the chain
    self%n = n
    self%map(:n, :n_coordinates) = 0
    self%bias(:n) = 0
    self%mass(:n, :n) = 0
    self%load(:n) = 0
  end subroutine begin_body

  !> No bodies yet.
  pure subroutine begin(self, n)
    class(equations_t), intent(inout) :: self
    integer, intent(in) :: n   !! coordinates
    self%n = n
    self%mass(:n, :n) = 0
    self%force(:n) = 0
  end subroutine begin

  !> Add a body.
  pure subroutine add(self, body)
    class(equations_t), intent(inout) :: self
    type(body_t), intent(in) :: body
    real(dp) :: own_force(body%n)
    associate (n => self%n, m => body%n)
      associate (map => body%map(:m, :n), mass => body%mass(:m, :m))
        own_force = body%load(:m) - matmul(mass, body%bias(:m))
        self%mass(:n, :n) = self%mass(:n, :n) + matmul(transpose(map), matmul(mass, map))
        self%force(:n) = self%force(:n) + matmul(own_force, map)
      end associate
    end associate
  end subroutine add

  !> The accelerations z'' of the coordinates, the first of them held at `held` if `holds_first`: then `holding` is the force that
  !> this takes, else 0. `definite` is false where the mass matrix is not positive definite: there is no answer then.
  pure subroutine solve(self, holds_first, accelerations, holding, definite, held)
    class(equations_t), intent(in) :: self
    logical, intent(in) :: holds_first
    real(dp), intent(out) :: accelerations(:)   !! (n)
    real(dp), intent(out) :: holding
    logical, intent(out) :: definite
    real(dp), intent(in), optional :: held   !! [its unit/s^2]; 0 where it is not given
    real(dp) :: matrix(self%n, self%n), a(self%n)
    integer :: first
    first = merge(2, 1, holds_first)
    a = self%force(:self%n)
    a(:first - 1) = 0
    if (holds_first .and. present(held)) then
      a = a - held*self%mass(:self%n, 1)
      a(1) = held
    end if
    matrix = self%mass(:self%n, :self%n)
    call factorise_cholesky(self%n - first + 1, matrix(first:, first:), definite)
    holding = 0
    accelerations = 0
    if (.not. definite) return
    call solve_cholesky(self%n - first + 1, matrix(first:, first:), a(first:))
    accelerations(:self%n) = a
    if (holds_first) holding = dot_product(self%mass(1, :self%n), a) - self%force(1)
  end subroutine solve
end module gudgeon_assembly
