!> Where each owner's numbers stand in the state y = (positions | their rates | first-order states | quadratures), and how large
!> they naturally are.
!>
!> When a scene is built, every owner (crank, joint, law, rod) claims the numbers that it needs, with their natural size. When
!> all have claimed, each settles what it has claimed, since only then is known where rates, states and quadratures begin.
!> Quadratures come last, so more of them may be claimed and settled later.
module state_layout
  use gudgeon_kinds, only: dp
  implicit none
  private
  public :: layout_t, coordinates_t, slice_t

  !> Positions of one owner, neighbours in the state, and their rates, which are neighbours too.
  type :: coordinates_t
    integer :: n = 0          !! how many
    integer :: position = 0   !! where the first of them stands in y
    integer :: rate = 0       !! where the rate of the first stands; 0: not settled
  end type coordinates_t

  !> First-order states or quadratures of one owner, neighbours in the state.
  type :: slice_t
    integer :: first = 1, last = 0   !! in y; empty unless claimed and settled
    integer, private :: section = 0, before = 0
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
    type(section_t), private :: section(4)
  contains
    procedure :: claim_positions
    procedure :: claim_states
    procedure :: claim_quadratures
    generic :: settle => settle_coordinates, settle_slice
    procedure :: n
    procedure :: natural_scales
    procedure, private :: settle_coordinates
    procedure, private :: settle_slice
  end type layout_t

contains

  !> Positions and their rates, `n` of each. Where a position `grows` without bound (a crank angle), a tolerance relative to itself
  !> means nothing.
  subroutine claim_positions(self, n, scale, rate_scale, at, grows)
    class(layout_t), intent(inout) :: self
    integer, intent(in) :: n
    real(dp), intent(in) :: scale        !! natural size of each position
    real(dp), intent(in) :: rate_scale   !! and of each rate
    type(coordinates_t), intent(out) :: at
    logical, intent(in) :: grows
    at%n = n
    at%position = self%n_positions + 1
    call append(self%section(positions), n, scale, grows)
    call append(self%section(rates), n, rate_scale, .false.)
    self%n_positions = self%n_positions + n
  end subroutine claim_positions

  !> First-order states, `n` of them of one natural size.
  subroutine claim_states(self, n, scale, at)
    class(layout_t), intent(inout) :: self
    integer, intent(in) :: n
    real(dp), intent(in) :: scale
    type(slice_t), intent(out) :: at
    call append(self%section(states), n, scale, .false.)
    at%section = states
    at%before = self%n_states
    at%last = n
    self%n_states = self%n_states + n
  end subroutine claim_states

  !> Quadratures, `n` of them of one natural size: integrals on which nothing depends. Size 0: they take no part in the control
  !> of the error.
  subroutine claim_quadratures(self, n, scale, at)
    class(layout_t), intent(inout) :: self
    integer, intent(in) :: n
    real(dp), intent(in) :: scale
    type(slice_t), intent(out) :: at
    call append(self%section(quadratures), n, scale, .true.)
    at%section = quadratures
    at%before = self%n_quadratures
    at%last = n
    self%n_quadratures = self%n_quadratures + n
  end subroutine claim_quadratures

  !> Find out where claimed positions have their rates.
  pure subroutine settle_coordinates(self, at)
    class(layout_t), intent(in) :: self
    type(coordinates_t), intent(inout) :: at
    at%rate = at%position + self%n_positions
  end subroutine settle_coordinates

  !> Find out where claimed states or quadratures stand.
  pure subroutine settle_slice(self, at)
    class(layout_t), intent(in) :: self
    type(slice_t), intent(inout) :: at
    integer :: n
    n = at%last - at%first + 1
    at%first = 2*self%n_positions + at%before + 1
    if (at%section == quadratures) at%first = at%first + self%n_states
    at%last = at%first + n - 1
  end subroutine settle_slice

  !> Length of the state.
  pure integer function n(self)
    class(layout_t), intent(in) :: self
    n = 2*self%n_positions + self%n_states + self%n_quadratures
  end function n

  !> Natural sizes of the components of the state, against which a tolerance is meant, and which of them grow without bound.
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

  !> More of one kind.
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
