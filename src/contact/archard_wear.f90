!> Wear of a pin and its bore by Archard's law: the depth at a point of a surface increases by k p |v| dt, where k is the wear rate
!> of its material, p the contact pressure there and v the sliding speed.
module archard_wear
  use gudgeon_kinds, only: dp
  use gudgeon_constants, only: two_pi
  use gudgeon_parameters, only: has_parameters_t, parameter_list_t
  use gudgeon_archive, only: archive_t
  implicit none
  private
  public :: wear_law_t, worn_surface_t, of_pin, of_bore

  integer, parameter :: of_pin = 1, of_bore = 2   !! indices of the wear rates

  !> The law of one joint, as a case gives it.
  type, extends(has_parameters_t) :: wear_law_t
    real(dp) :: rate(2) = 0   !! k of pin and bore, K/H of Archard's law [m^2/N]
    integer :: bins = 0       !! number of equal arcs into which each surface is divided
  contains
    procedure :: parameters
  end type wear_law_t

  !> The load path of a surface: the integral of the force that presses on each of its bins over the sliding path, Int Int p R L
  !> dphi |v| dt. Times k it is the volume worn from the bin.
  type :: worn_surface_t
    real(dp), allocatable :: load_path(:)   !! bin i covers the angles from (i - 1) to i bin widths [N m]
  contains
    procedure :: prepare
    procedure :: width
    procedure :: add
    procedure :: exchange
  end type worn_surface_t

contains

  subroutine parameters(self, list)
    class(wear_law_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call list%add('rate', self%rate, 'specific wear rates of pin and bore: volume per normal force and sliding path', &
      'm^2/N', '>= 0 and <= 1e-6', default='0.0', example='1.0e-15')
    call list%add('bins', self%bins, 'number of arcs of each surface in NAME.wear.csv', '>= 4 and <= 36000', '360')
  end subroutine parameters

  !> Begin with a surface that has not worn.
  pure subroutine prepare(self, bins)
    class(worn_surface_t), intent(inout) :: self
    integer, intent(in) :: bins
    if (allocated(self%load_path)) deallocate (self%load_path)
    allocate (self%load_path(bins), source=0.0_dp)
  end subroutine prepare

  !> Width of a bin [rad].
  pure real(dp) function width(self)
    class(worn_surface_t), intent(in) :: self
    width = two_pi/size(self%load_path)
  end function width

  !> Spread a load path [N m] evenly over the arc between two angles [rad], which differ by at most a turn.
  pure subroutine add(self, from, to, amount)
    class(worn_surface_t), intent(inout) :: self
    real(dp), intent(in) :: from, to, amount
    real(dp) :: ends(2), share
    integer :: i, bin
    ends = [min(from, to), max(from, to)]/self%width()
    do i = floor(ends(1)), floor(ends(2))
      share = 1
      if (ends(2) > ends(1)) share = (min(ends(2), i + 1.0_dp) - max(ends(1), real(i, dp)))/(ends(2) - ends(1))
      bin = modulo(i, size(self%load_path)) + 1
      self%load_path(bin) = self%load_path(bin) + share*amount
    end do
  end subroutine add

  !> Write the load paths to an archive, or read them from it.
  subroutine exchange(self, archive)
    class(worn_surface_t), intent(inout) :: self
    type(archive_t), intent(inout) :: archive
    call archive%exchange(self%load_path)
  end subroutine exchange
end module archard_wear
