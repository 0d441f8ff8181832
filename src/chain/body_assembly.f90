!> Equations of motion of a chain, assembled from its bodies.
!>
!> Each body has a small number of velocities v of its own (of a point, an angular speed, and of modes if it is elastic) with a mass
!> matrix M. They follow from the rates z' of the chain's coordinates by a velocity map J, and accelerations correspondingly:
!>
!>     v = J z',    v' = J z'' + b
!>
!> By virtual work every body adds J^T M J to the mass matrix of the chain and J^T (Q - M b) to its forces, where Q are the loads on
!> the body and the inertial loads of its motion (centripetal terms). The mass matrix is symmetric and positive definite; there are
!> no constraints, since the coordinates are independent.
module body_assembly
  use kinds, only: dp
  use small_cholesky, only: factorise_cholesky, solve_cholesky
  implicit none
  private
  public :: equations_t, body_t, most_coordinates

  integer, parameter :: most_coordinates = 24   !! of a chain
  integer, parameter :: most_velocities = 20    !! of a body

  !> One body with its velocity map. `begin` sets all used elements to 0.
  type :: body_t
    integer :: n = 0                                          !! number of velocities
    real(dp) :: map(most_velocities, most_coordinates)        !! J: from rates of the coordinates to velocities
    real(dp) :: bias(most_velocities)                         !! b: accelerations for vanishing accelerations of the coordinates
    real(dp) :: mass(most_velocities, most_velocities)        !! M
    real(dp) :: load(most_velocities)                         !! Q
  contains
    procedure :: begin => begin_body
  end type body_t

  !> The equations mass z'' = force for n coordinates.
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
    integer, intent(in) :: n               !! number of velocities
    integer, intent(in) :: n_coordinates   !! of the chain
    self%n = n
    self%map(:n, :n_coordinates) = 0
    self%bias(:n) = 0
    self%mass(:n, :n) = 0
    self%load(:n) = 0
  end subroutine begin_body

  !> Begin without bodies.
  pure subroutine begin(self, n)
    class(equations_t), intent(inout) :: self
    integer, intent(in) :: n   !! number of coordinates
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

  !> Solve for the accelerations z'' of the coordinates. If `holds_first`, the first of them is prescribed as `held`, and `holding`
  !> is the force required for it, else 0. `definite` is false if the mass matrix is not positive definite; there is no solution
  !> then.
  pure subroutine solve(self, holds_first, accelerations, holding, definite, held)
    class(equations_t), intent(in) :: self
    logical, intent(in) :: holds_first
    real(dp), intent(out) :: accelerations(:)   !! (n)
    real(dp), intent(out) :: holding
    logical, intent(out) :: definite
    real(dp), intent(in) :: held   !! [unit of the coordinate/s^2]
    real(dp) :: matrix(self%n, self%n), a(self%n)
    integer :: first
    first = merge(2, 1, holds_first)
    a = self%force(:self%n)
    a(:first - 1) = 0
    if (holds_first) then
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
end module body_assembly
