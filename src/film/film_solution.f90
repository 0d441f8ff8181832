!> Solutions of the film of finite length at one eccentricity ratio by Richardson's extrapolation, from pairs of grids of which one
!> has half as many nodes in each direction. They are used for the table of `film_map`.
module film_solution
  use kinds, only: dp
  use finite_film, only: film_solver_t, film_answer_t, cavitation_reynolds
  implicit none
  private
  public :: film_solution_t, solved_film

  type :: solver_pair_t
    type(film_solver_t) :: fine, coarse
  end type solver_pair_t

  !> Solutions for one eccentricity ratio and any direction of the velocity.
  type :: film_solution_t
    private
    integer :: cavitation = 0
    type(solver_pair_t), allocatable :: pairs(:)
  contains
    procedure :: begin
    procedure :: solve
  end type film_solution_t

  integer, parameter :: nodes_along = 10   !! ratio of the nodes around the film to those along half of it

contains

  !> Prepare for the thickness `gap` = 1 - eps (> 0, <= 1) and the half length L/(2R), with `film_points` nodes around the film, or
  !> more where it is thin (`nodes_at`).
  pure subroutine begin(self, film_points, half_length, cavitation, gap)
    class(film_solution_t), intent(inout) :: self
    integer, intent(in) :: film_points   !! divisible by 4
    real(dp), intent(in) :: half_length, gap
    integer, intent(in) :: cavitation    !! condition of cavitation, as in `finite_film`
    integer :: grids, nodes, along, i
    real(dp) :: shift
    self%cavitation = cavitation
    grids = grids_for(film_points, cavitation)
    nodes = nodes_at(film_points, grids, gap)
    along = 2*max(3, nodes/(2*nodes_along))
    if (allocated(self%pairs)) deallocate (self%pairs)
    allocate (self%pairs(grids))
    do i = 1, grids
      shift = real(i - 1, dp)/grids
      call self%pairs(i)%fine%begin(nodes, along, gap, half_length, shift)
      call self%pairs(i)%coarse%begin(nodes/2, along/2, gap, half_length, shift)
    end do
  end subroutine begin

  !> Number of nodes around the film at a thickness. Thin films need more, since the pressure of a separating film is small compared
  !> with the part that is cut off, and the edge of the pressure moves from node to node. The mean of several grids needs fewer
  !> nodes.
  pure integer function nodes_at(film_points, grids, gap)
    integer, intent(in) :: film_points, grids
    real(dp), intent(in) :: gap
    integer, parameter :: enough = 200
    real(dp), parameter :: thin = 0.05_dp, very_thin = 0.012_dp
    nodes_at = film_points
    if (grids > 1) then
      if (gap < very_thin) nodes_at = 4*(film_points/3)
    else if (gap < very_thin .and. film_points < enough) then
      nodes_at = 2*film_points
    else if (gap < thin) then
      nodes_at = 4*((3*film_points)/8)
    end if
  end function nodes_at

  !> Number of grids whose mean is taken. Where the film ruptures at a free edge, the force has an error that changes with the
  !> position of the edge between two nodes, and that Richardson's extrapolation does not remove. The mean over grids shifted by a
  !> quarter of the node distance reduces it by a factor of five to ten. On coarse grids other errors dominate.
  pure integer function grids_for(film_points, cavitation)
    integer, intent(in) :: film_points, cavitation
    integer, parameter :: fine_film = 160
    grids_for = merge(4, 1, cavitation == cavitation_reynolds .and. film_points >= fine_film)
  end function grids_for

  !> The film for a velocity in the direction alpha [rad] from n to t; in each pair the errors of second order cancel. `warm`: start
  !> from the previous solution.
  pure subroutine solve(self, alpha, warm, film)
    class(film_solution_t), intent(inout) :: self
    real(dp), intent(in) :: alpha
    logical, intent(in) :: warm
    type(film_answer_t), intent(out) :: film
    type(film_answer_t) :: fine, coarse
    integer :: i
    do i = 1, size(self%pairs)
      call self%pairs(i)%coarse%solve(alpha, self%cavitation, warm, coarse)
      call self%pairs(i)%fine%solve(alpha, self%cavitation, warm, fine, self%pairs(i)%coarse)
      film%force = film%force + (4*fine%force - coarse%force)/3
      film%flow = film%flow + (4*fine%flow - coarse%flow)/3
      film%most = film%most + (4*fine%most - coarse%most)/3
    end do
    film%force = film%force/size(self%pairs)
    film%flow = film%flow/size(self%pairs)
    film%most = film%most/size(self%pairs)
  end subroutine solve

  !> The same for one eccentricity ratio and one direction [rad].
  pure subroutine solved_film(film_points, half_length, cavitation, gap, alpha, film)
    integer, intent(in) :: film_points, cavitation
    real(dp), intent(in) :: half_length, gap, alpha
    type(film_answer_t), intent(out) :: film
    type(film_solution_t) :: solution
    call solution%begin(film_points, half_length, cavitation, gap)
    call solution%solve(alpha, .false., film)
  end subroutine solved_film
end module film_solution
