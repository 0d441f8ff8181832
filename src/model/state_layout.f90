!> The layout of the state y = (positions | their rates | first-order states | quadratures): the indices of each owner's components,
!> and their natural sizes.
!>
!> When a scene is built, every owner (crank, joint, law, rod) claims the components that it needs, with their natural sizes. The
!> indices of rates, states and quadratures depend on the number of all positions and states. Therefore all claims are made twice:
!> the first time they are counted, and after `count_again` the same claims give the final indices. Quadratures are last, so that
!> more of them may be claimed later.
module state_layout
  use kinds, only: dp
  implicit none
  private
  public :: layout_t, coordinates_t, slice_t

  !> Positions of one owner, which are adjacent in the state, and their rates, which are adjacent too.
  type :: coordinates_t
    integer :: n = 0          !! number of positions
    integer :: position = 0   !! index of the first position in y
    integer :: rate = 0       !! index of the first rate in y
  end type coordinates_t

  !> First-order states or quadratures of one owner, adjacent in the state.
  type :: slice_t
    integer :: first = 1, last = 0   !! indices in y; empty unless claimed
  end type slice_t

  !> One part of the state.
  type :: section_t
    real(dp), allocatable :: scale(:)
    logical, allocatable :: grows(:)
  end type section_t

  integer, parameter :: positions = 1, rates = 2, states = 3, quadratures = 4

  !> The layout of one state.
  type :: layout_t
    integer :: n_positions = 0, n_states = 0, n_quadratures = 0
    integer, private :: all_positions = 0, all_states = 0   !! numbers counted the first time
    type(section_t), private :: section(4)
  contains
    procedure :: count_again
    procedure :: claim_positions
    procedure :: claim_states
    procedure :: claim_quadratures
    procedure :: n
    procedure :: natural_scales
  end type layout_t

contains

  !> Forget all claims except their number: the same claims, made again, give the final indices.
  pure subroutine count_again(self)
    class(layout_t), intent(inout) :: self
    self%all_positions = self%n_positions
    self%all_states = self%n_states
    self%n_positions = 0
    self%n_states = 0
    self%n_quadratures = 0
    self%section = section_t()
  end subroutine count_again

  !> Claim `n` positions and their rates. If a position `grows` without bound (a crank angle), its tolerance is not relative to its
  !> value.
  subroutine claim_positions(self, n, scale, rate_scale, at, grows)
    class(layout_t), intent(inout) :: self
    integer, intent(in) :: n
    real(dp), intent(in) :: scale        !! natural size of each position
    real(dp), intent(in) :: rate_scale   !! natural size of each rate
    type(coordinates_t), intent(out) :: at
    logical, intent(in) :: grows
    at%n = n
    at%position = self%n_positions + 1
    at%rate = self%all_positions + at%position
    call append(self%section(positions), n, scale, grows)
    call append(self%section(rates), n, rate_scale, .false.)
    self%n_positions = self%n_positions + n
  end subroutine claim_positions

  !> Claim `n` first-order states with one natural size.
  subroutine claim_states(self, n, scale, at)
    class(layout_t), intent(inout) :: self
    integer, intent(in) :: n
    real(dp), intent(in) :: scale
    type(slice_t), intent(out) :: at
    call append(self%section(states), n, scale, .false.)
    at%first = 2*self%all_positions + self%n_states + 1
    at%last = at%first + n - 1
    self%n_states = self%n_states + n
  end subroutine claim_states

  !> Claim `n` quadratures, integrals on which nothing depends, with one natural size. Size 0 excludes them from the error control.
  subroutine claim_quadratures(self, n, scale, at)
    class(layout_t), intent(inout) :: self
    integer, intent(in) :: n
    real(dp), intent(in) :: scale
    type(slice_t), intent(out) :: at
    call append(self%section(quadratures), n, scale, .true.)
    at%first = 2*self%all_positions + self%all_states + self%n_quadratures + 1
    at%last = at%first + n - 1
    self%n_quadratures = self%n_quadratures + n
  end subroutine claim_quadratures

  !> Length of the state.
  pure integer function n(self)
    class(layout_t), intent(in) :: self
    n = 2*self%n_positions + self%n_states + self%n_quadratures
  end function n

  !> Natural sizes of the components of the state, to which absolute tolerances refer, and which of them grow without bound.
  pure subroutine natural_scales(self, scales, growing)
    class(layout_t), intent(in) :: self
    real(dp), intent(out) :: scales(:)    !! (n)
    logical, intent(out) :: growing(:)    !! (n)
    integer :: i, first, last
    last = 0
    do i = 1, size(self%section)
      if (.not. allocated(self%section(i)%scale)) cycle
      first = last + 1
      last = last + size(self%section(i)%scale)
      scales(first:last) = self%section(i)%scale
      growing(first:last) = self%section(i)%grows
    end do
  end subroutine natural_scales

  !> Append components to one part of the state.
  pure subroutine append(section, n, scale, grows)
    type(section_t), intent(inout) :: section
    integer, intent(in) :: n
    real(dp), intent(in) :: scale
    logical, intent(in) :: grows
    integer :: i
    if (.not. allocated(section%scale)) allocate (section%scale(0), section%grows(0))
    section%scale = [section%scale, (scale, i=1, n)]
    section%grows = [section%grows, (grows, i=1, n)]
  end subroutine append
end module state_layout
