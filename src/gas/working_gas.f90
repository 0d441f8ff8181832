!> The gas in the cylinder of a running engine: its cycle, and the part of it that acts.
module working_gas
  use gudgeon_kinds, only: dp
  use gudgeon_archive, only: archive_t
  use trace_row, only: trace_row_t
  use gas_cycle, only: gas_cycle_t, cycle_angle, n_parts
  implicit none
  private
  public :: working_gas_t, n_gas_events

  !> Passages of the crank from one part of the cycle to the next: forwards, backwards.
  integer, parameter :: n_gas_events = 2

  type :: working_gas_t
    type(gas_cycle_t) :: cycle
    integer :: part = 0              !! of the cycle
    real(dp) :: cycle_start = 0      !! crank angle at which the present cycle began [rad]
  contains
    procedure :: find_part
    procedure, non_overridable :: pressure
    procedure, non_overridable :: force
    procedure :: force_slope
    procedure :: events
    procedure :: pass_bound
    procedure :: put_columns
    procedure :: exchange
  end type working_gas_t

contains

  !> Find the part of the cycle that the crank is in, or about to enter.
  subroutine find_part(self, crank_angle, crank_speed)
    class(working_gas_t), intent(inout) :: self
    real(dp), intent(in) :: crank_angle, crank_speed
    call self%cycle%part_at(crank_angle, crank_speed < 0, self%part, self%cycle_start)
  end subroutine find_part

  !> Pressure at a crank angle [Pa].
  pure real(dp) function pressure(self, crank_angle)
    class(working_gas_t), intent(in) :: self
    real(dp), value, intent(in) :: crank_angle
    pressure = self%cycle%pressure(crank_angle, self%part, self%cycle_start)
  end function pressure

  !> Force on the piston along -x [N] at a pressure [Pa].
  pure real(dp) function force(self, pressure)
    class(working_gas_t), intent(in) :: self
    real(dp), value, intent(in) :: pressure
    force = self%cycle%gas_force(pressure)
  end function force

  !> Pressure [Pa] and its force, and the volume at a crank angle of this sine and cosine.
  pure subroutine put_columns(self, sin_crank, cos_crank, pressure, row)
    class(working_gas_t), intent(in) :: self
    real(dp), intent(in) :: sin_crank, cos_crank, pressure
    type(trace_row_t), intent(inout) :: row
    real(dp) :: volume
    call row%put('cylinder_pressure[Pa]', pressure)
    volume = 0
    if (row%wants(1)) volume = self%cycle%cylinder%volume_at(sin_crank, cos_crank)
    call row%put('cylinder_volume[m3]', volume)
    call row%put('gas_force[N]', self%force(pressure))
  end subroutine put_columns

  !> Derivative of the force by the crank angle [N/rad].
  pure real(dp) function force_slope(self, crank_angle)
    class(working_gas_t), intent(in) :: self
    real(dp), intent(in) :: crank_angle
    force_slope = self%cycle%cylinder%area*self%cycle%pressure_slope(crank_angle, self%part, self%cycle_start)
  end function force_slope

  !> Event functions of the bounds of the present part, over the crank angle.
  pure subroutine events(self, crank_angle, crank_speed, g, g_rate)
    class(working_gas_t), intent(in) :: self
    real(dp), intent(in) :: crank_angle, crank_speed
    real(dp), intent(out) :: g(n_gas_events), g_rate(n_gas_events)
    real(dp) :: angle
    angle = crank_angle - self%cycle_start
    g = [angle - self%cycle%bound(self%part), self%cycle%bound(self%part - 1) - angle]
    g_rate = [crank_speed, -crank_speed]
  end subroutine events

  !> Enter the next part of the cycle that is not empty, forwards (1) or backwards (2).
  subroutine pass_bound(self, direction)
    class(working_gas_t), intent(inout) :: self
    integer, intent(in) :: direction
    integer :: way
    way = merge(1, -1, direction == 1)
    do
      self%part = self%part + way
      if (self%part > n_parts .or. self%part < 1) then
        self%part = merge(1, n_parts, way > 0)
        self%cycle_start = self%cycle_start + way*cycle_angle
      end if
      if (self%cycle%bound(self%part) > self%cycle%bound(self%part - 1)) exit
    end do
  end subroutine pass_bound

  !> The discrete state, to or from an archive.
  subroutine exchange(self, archive)
    class(working_gas_t), intent(inout) :: self
    type(archive_t), intent(inout) :: archive
    call archive%exchange(self%part)
    call archive%exchange(self%cycle_start)
  end subroutine exchange
end module working_gas
