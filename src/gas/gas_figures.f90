!> What the gas of one cylinder does in a cycle, before anything is simulated: its largest and least pressure and its work.
module gas_figures
  use kinds, only: dp
  use constants, only: degree
  use error_handling, only: error_t
  use ideal_linkage, only: linkage_t
  use gas_law, only: gas_law_t
  use working_gas, only: working_gas_t
  implicit none
  private
  public :: gas_figures_t, find_gas_figures, highest_peak

  real(dp), parameter :: highest_peak = 5e7_dp   !! largest pressure of usual machines [Pa]

  type :: gas_figures_t
    logical :: is_known = .false.   !! the following are
    real(dp) :: peak = 0            !! largest pressure [Pa]
    real(dp) :: peak_angle = 0      !! crank angle then, from 0 to the length of the cycle [degrees]
    real(dp) :: least = 0           !! least pressure [Pa]
    real(dp) :: imep = 0            !! work on the piston in a cycle over the displacement [Pa]
    real(dp) :: exponent = 0        !! n of p V^n over the compression before the peak; 0: not known [-]
  contains
    procedure :: are_usual
    procedure :: likely_unit
  end type gas_figures_t

contains

  !> Find the figures of a gas in a mechanism whose crank turns with the sense of `crank_speed`, by sums over quarters of a degree.
  !> They are not known of a pressure from outside, or if the cycle cannot be integrated.
  subroutine find_gas_figures(law, linkage, crank_speed, figures)
    class(gas_law_t), intent(in) :: law
    type(linkage_t), intent(in) :: linkage
    real(dp), intent(in) :: crank_speed   !! [rad/s]
    type(gas_figures_t), intent(out) :: figures
    real(dp), parameter :: tolerance = 1e-6_dp, step = 0.25_dp   ! [-], [degrees]
    type(working_gas_t) :: gas
    type(error_t), allocatable :: error
    real(dp) :: angle, pressure, work
    integer :: i, n
    call law%prepare(linkage, sign(1.0_dp, crank_speed), tolerance, gas, error)
    if (allocated(error)) return
    if (gas%is_external() .or. .not. gas%cylinder%displacement > 0) return
    n = nint(360*gas%revolutions/step)
    work = 0
    figures%least = huge(work)
    do i = 0, n - 1
      angle = i*step*degree
      call gas%start(angle, gas%sense)
      pressure = gas%pressure(angle)
      if (pressure > figures%peak) figures%peak_angle = i*step
      figures%peak = max(figures%peak, pressure)
      figures%least = min(figures%least, pressure)
      work = work + pressure*gas%cylinder%volume_slope(angle - gas%cylinder%dead_centre)
    end do
    figures%imep = gas%sense*work*step*degree/gas%cylinder%displacement
    figures%exponent = compression_exponent(gas, figures)
    figures%is_known = .true.
  end subroutine find_gas_figures

  !> Exponent between 100 and 40 degrees before the dead centre next to the peak, if the volumes are known and the pressure there is
  !> still far below the peak: neither does the gas burn then nor is it delivered.
  real(dp) function compression_exponent(gas, figures) result(exponent)
    type(working_gas_t), intent(inout) :: gas
    type(gas_figures_t), intent(in) :: figures
    real(dp), parameter :: before(2) = [100, 40]*degree, early = 0.5_dp
    real(dp) :: pressure(2), volume(2), angle
    integer :: i
    exponent = 0
    if (.not. gas%cylinder%dead_volume > 0) return
    do i = 1, 2
      angle = 360*nint(figures%peak_angle/360)*degree - gas%sense*before(i)
      call gas%start(gas%cylinder%dead_centre + angle, gas%sense)
      pressure(i) = gas%pressure(gas%cylinder%dead_centre + angle)
      volume(i) = gas%cylinder%volume(angle)
    end do
    if (pressure(2) < early*figures%peak) exponent = log(pressure(2)/pressure(1))/log(volume(1)/volume(2))
  end function compression_exponent

  !> Whether the pressures are of usual sizes, or would be in another unit: factor times pressure plus offset.
  pure logical function are_usual(self, factor, offset)
    class(gas_figures_t), intent(in) :: self
    real(dp), intent(in), optional :: factor, offset   !! [-], [Pa]; 1 and 0 without them
    real(dp), parameter :: lowest_peak = 1e5_dp, least(2) = [2e4_dp, 1e6_dp]   ! [Pa]
    real(dp) :: pressures(2)
    pressures = [self%least, self%peak]
    if (present(factor)) pressures = factor*pressures
    if (present(offset)) pressures = pressures + offset
    are_usual = pressures(1) >= least(1) .and. pressures(1) <= least(2) .and. pressures(2) >= lowest_peak .and. &
      pressures(2) <= highest_peak
  end function are_usual

  !> `: pascals under [bar]?`, the unit in which a table with unusual pressures was probably meant; empty if none explains them.
  pure function likely_unit(self) result(text)
    class(gas_figures_t), intent(in) :: self
    character(len=:), allocatable :: text
    real(dp), parameter :: atmosphere = 101325, gauge = 5e3_dp   ! [Pa]; a gauge shows less than this while the cylinder is open
    text = ''
    if (self%are_usual(factor=1e-5_dp)) then
      text = ': pascals under [bar]?'
    else if (self%are_usual(factor=1e5_dp)) then
      text = ': bar under [Pa]?'
    else if (self%least < gauge .and. self%are_usual(offset=atmosphere)) then
      text = ': gauge pressure?'
    else if (self%are_usual(factor=10.0_dp)) then
      text = ': MPa under [bar]?'
    else if (self%are_usual(factor=1e6_dp)) then
      text = ': MPa under [Pa]?'
    else if (self%are_usual(factor=1e-2_dp)) then
      text = ': kPa under [bar]?'
    end if
  end function likely_unit
end module gas_figures
