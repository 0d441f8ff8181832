!> Wear of a pin and its bore by Archard's law: the depth at a point of a surface increases by k p |v| dt, where k is the wear rate
!> of its material, p the contact pressure there and v the sliding speed.
module archard_wear
  use kinds, only: dp
  use constants, only: two_pi
  use model_parameters, only: has_parameters_t, parameter_list_t
  implicit none
  private
  public :: wear_law_t, worn_surface_t, of_pin, of_bore

  integer, parameter :: of_pin = 1, of_bore = 2   !! indices of the wear rates

  !> The law of one joint, as a case gives it.
  type, extends(has_parameters_t) :: wear_law_t
    real(dp) :: rate(2) = 0   !! k of pin and bore, K/H of Archard's law [m^2/N]
    integer :: bins = 0       !! number of equal arcs into which each surface is divided
    character(len=:), allocatable :: bore      !! 'round', or 'worn': the depth of wear changes the contact
    integer :: cycles_per_update = 1           !! turns of the crank between two changes of the bore's shape
    real(dp) :: extrapolation = 1              !! each of these spans stands for so many
    real(dp) :: greatest_step_ratio = 0        !! upper limit of the depth added at once, over the clearance
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
  end type worn_surface_t

contains

  subroutine parameters(self, list)
    class(wear_law_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call list%add('rate', self%rate, 'specific wear rates of pin and bore: volume per normal force and sliding path', &
      'm^2/N', '>= 0 and <= 1e-6', default='0.0', example='1.0e-15', usual='1e-20 to 1e-9')
    call list%add('bins', self%bins, 'number of arcs of each surface in NAME.wear.csv', '>= 4 and <= 3600', '360')
    call list%word('bore', self%bore, 'round, worn', 'round', &
      'round: wear is only counted; worn: the worn bore acts in the contact (geometry = ''winkler'')')
    call list%add('cycles_per_update', self%cycles_per_update, 'crank revolutions between changes of a worn bore', &
      '>= 1 and <= 1000000', '1')
    call list%add('extrapolation', self%extrapolation, &
      'factor by which the wear between two changes is multiplied, as if it had lasted so much longer', &
      range='>= 1', default='1.0', usual='1 to 1e6')
    call list%add('greatest_step_ratio', self%greatest_step_ratio, &
      'largest change of depth over the clearance; also half of its limit over the mean penetration. Reduces extrapolation', &
      range='> 0 and <= 1', default='0.05', usual='1e-3 to 0.2')
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
end module archard_wear
