!> Builds the crankshaft with several cylinders of a case.
module train_builder
  use kinds, only: dp
  use constants, only: two_pi, degree
  use case_definition, only: case_t
  use train_case, only: full_cylinder, number_throws, list_value
  use chain_bodies, only: bodies_t, crank_t, rod_t, piston_t, new_bodies
  use chain_motion, only: motion_t
  use ideal_chain, only: inertia_at
  use ideal_cylinders, only: ideal_cylinder_t
  use crank_train, only: crank_train_t, ring_t
  use other_cylinders, only: other_cylinders_t
  use working_gas, only: working_gas_t
  use gas_cycle, only: gas_cycle_t, new_gas_cycle
  use error_handling, only: error_t
  implicit none
  private
  public :: build_train, build_other_gas, axis_gravity, inertia_beside, least_inertia, mean_inertias

  integer, parameter :: angles = 256   !! at which inertias are sampled in a turn

contains

  !> The crankshaft and the cylinders other than that of the mechanism; with `is_rigid` all on one station, with the whole inertia.
  subroutine build_train(case, is_rigid, train)
    type(case_t), intent(in) :: case
    logical, intent(in) :: is_rigid
    type(crank_train_t), allocatable, intent(out) :: train
    integer :: j
    allocate (train)
    allocate (train%rings(0), train%cylinders(0))
    train%is_chain = allocated(case%shaft) .and. .not. is_rigid
    train%axis_offset = case%mechanism%axis_offset
    if (allocated(case%shaft)) then
      associate (shaft => case%shaft)
        train%n = shaft%n_inertia
        train%driven = shaft%driven()
        train%drag_speed = shaft%absolute_damping_speed
        do j = 1, train%n
          train%inertia(j) = shaft%inertia(j)
          train%drag(j) = list_value(shaft%absolute_damping, shaft%n_absolute, j)
          if (j == train%n) cycle
          train%stiffness(j) = list_value(shaft%stiffness, shaft%n_stiffness, j)
          train%damping(j) = shaft%segment_damping(j)
        end do
      end associate
    end if
    if (allocated(case%dampers)) call add_rings(case, train)
    if (allocated(case%cylinders)) call add_cylinders(case, train)
    if (is_rigid) call make_rigid(train)
  end subroutine build_train

  subroutine add_rings(case, train)
    type(case_t), intent(in) :: case
    type(crank_train_t), intent(inout) :: train
    integer :: i
    deallocate (train%rings)
    allocate (train%rings(size(case%dampers)))
    do i = 1, size(case%dampers)
      associate (it => case%dampers(i), ring => train%rings(i))
        ring%station = it%station
        ring%is_viscous = it%kind == 'viscous'
        ring%inertia = it%inertia
        if (.not. ring%is_viscous) ring%stiffness = it%stiffness
        ring%damping = it%ring_damping()
      end associate
    end do
  end subroutine add_rings

  subroutine add_cylinders(case, train)
    type(case_t), intent(in) :: case
    type(crank_train_t), intent(inout) :: train
    type(ideal_cylinder_t), allocatable :: others(:)
    integer :: throw(size(case%cylinders)), i, n, full
    logical :: has_crank(size(case%cylinders))
    real(dp) :: gravity(2)
    call number_throws(case%cylinders, throw, has_crank)
    full = full_cylinder(case%cylinders)
    train%full_number = full
    train%full_throw = throw(full)
    train%n_throws = maxval(throw)
    train%full_axial_position = case%cylinders(full)%axial_position
    train%full = max(1, case%cylinders(full)%station)
    train%throw_station(throw) = max(1, case%cylinders%station)
    allocate (others(size(case%cylinders) - 1))
    gravity = axis_gravity(case)
    n = 0
    do i = 1, size(case%cylinders)
      if (i == full) cycle
      n = n + 1
      associate (it => case%cylinders(i), other => others(n), m => case%mechanism)
        other%number = i
        other%station = max(1, it%station)
        other%throw = throw(i)
        other%bank = (it%bank_deg - case%cylinders(full)%bank_deg)*degree
        other%shift = (it%phase_deg - case%cylinders(full)%phase_deg)*degree - other%bank
        other%sin_shift = sin(other%shift)
        other%cos_shift = cos(other%shift)
        other%axial_position = it%axial_position
        call other%set_bodies(new_bodies(crank_t(m%crank_length, it%crank_mass, it%crank_inertia, it%crank_com), &
          rod_t(m%rod_length, it%rod_mass, it%rod_inertia, it%rod_com), piston_t(it%piston_mass, axis_offset=m%axis_offset), &
          [gravity(1)*cos(other%bank) + gravity(2)*sin(other%bank), gravity(2)*cos(other%bank) - gravity(1)*sin(other%bank)]))
      end associate
    end do
    call move_alloc(others, train%cylinders)
  end subroutine add_cylinders

  !> Make the shaft rigid: one station, with all inertias.
  subroutine make_rigid(train)
    type(crank_train_t), intent(inout) :: train
    train%inertia(1) = sum(train%inertia(:train%n)) + sum(train%rings%inertia)
    train%drag(1) = sum(train%drag(:train%n))
    deallocate (train%rings)
    allocate (train%rings(0))
    train%cylinders%station = 1
    train%throw_station = 1
    train%n = 1
    train%full = 1
    train%driven = 1
  end subroutine make_rigid

  !> The gas in the other cylinders, whose states `start` finds. The pressure of the mechanism's own gas gets the factor of its
  !> cylinder, and so does the heat of its cycle. Error: a cycle cannot be integrated.
  subroutine build_other_gas(case, tolerance, gas, train, other, error)
    type(case_t), intent(in) :: case
    real(dp), intent(in) :: tolerance   !! allowed relative error of the pressure
    type(working_gas_t), intent(inout) :: gas
    type(crank_train_t), intent(in) :: train
    type(other_cylinders_t), allocatable, intent(out) :: other
    type(error_t), allocatable, intent(out) :: error
    integer :: i
    allocate (other)
    other%number = train%cylinders%number
    allocate (other%scale(size(train%cylinders)), other%has_gas(size(train%cylinders)))
    if (.not. allocated(case%cylinders)) return
    do i = 1, size(train%cylinders)
      other%scale(i) = case%cylinders(other%number(i))%pressure_scale
      other%has_gas(i) = case%cylinders(other%number(i))%gas
    end do
    gas%scale = case%cylinders(train%full_number)%pressure_scale
    if (.not. allocated(gas%cycle)) return
    if (all(abs(case%cylinders%heat_scale - 1) <= 0) .and. .not. gas%has_states()) return
    allocate (other%cycles(size(train%cylinders)))
    do i = 1, size(train%cylinders)
      other%cycles(i) = gas%cycle
      call scale_heat(case%cylinders(other%number(i))%heat_scale, tolerance, other%cycles(i), error)
      if (allocated(error)) return
    end do
    call scale_heat(case%cylinders(train%full_number)%heat_scale, tolerance, gas%cycle, error)
  end subroutine build_other_gas

  !> Give a cycle this part of its heat. Error: it cannot be integrated.
  subroutine scale_heat(factor, tolerance, cycle, error)
    real(dp), intent(in) :: factor, tolerance
    type(gas_cycle_t), intent(inout) :: cycle
    type(error_t), allocatable, intent(out) :: error
    if (.not. abs(factor - 1) > 0) return
    cycle%release%heat = factor*cycle%release%heat
    call new_gas_cycle(cycle, tolerance, error)
  end subroutine scale_heat

  !> Gravity along the axis of the mechanism's cylinder and across it [m/s^2].
  pure function axis_gravity(case) result(gravity)
    type(case_t), intent(in) :: case
    real(dp) :: gravity(2)
    associate (m => case%mechanism)
      gravity = [-m%gravity*cos(m%gravity_angle_deg*degree), 0 - m%gravity*sin(m%gravity_angle_deg*degree)]   ! no negative zero
    end associate
  end function axis_gravity

  !> The bodies of the mechanism.
  pure type(bodies_t) function bodies_of(case) result(bodies)
    type(case_t), intent(in) :: case
    associate (m => case%mechanism)
      bodies = new_bodies(crank_t(m%crank_length, m%crank_mass, m%crank_inertia + case%drive%flywheel_inertia, m%crank_com), &
        rod_t(m%rod_length, m%rod_mass, m%rod_inertia, m%rod_com), piston_t(m%piston_mass, axis_offset=m%axis_offset), &
        [0.0_dp, 0.0_dp])
    end associate
  end function bodies_of

  !> Inertia that moves with the mechanism's crank beside it at any angle: of its station, and of cranks and rods of other cylinders
  !> there as points on their pins [kg m^2]; 0 for a case with one cylinder.
  real(dp) function inertia_beside(case) result(inertia)
    type(case_t), intent(in) :: case
    type(crank_train_t), allocatable :: train
    integer :: i
    inertia = 0
    if (.not. case%has_train()) return
    call build_train(case, .false., train)
    inertia = train%inertia(train%full)
    do i = 1, size(train%cylinders)
      if (train%cylinders(i)%station == train%full) inertia = inertia + train%cylinders(i)%bodies%crank_inertia
    end do
  end function inertia_beside

  !> Inertia of each station with its cylinders, over a turn of the shaft: the mean and the smallest one [kg m^2].
  subroutine station_inertias(train, bodies, mean, least)
    type(crank_train_t), intent(in) :: train
    type(bodies_t), intent(in) :: bodies   !! of the mechanism
    real(dp), intent(out) :: mean(:), least(:)
    real(dp) :: now(train%n), q
    integer :: k, i
    mean = 0
    least = huge(least)
    do k = 1, angles
      q = two_pi*k/angles
      now = train%inertia(:train%n)
      now(train%full) = now(train%full) + inertia_at(bodies, q)
      do i = 1, size(train%cylinders)
        associate (it => train%cylinders(i))
          now(it%station) = now(it%station) + it%inertia(q + it%shift)
        end associate
      end do
      mean = mean + now/angles
      least = min(least, now)
    end do
  end subroutine station_inertias

  !> The smallest inertia of a station at an angle of a turn, where it is more than rounding of its mean [kg m^2].
  real(dp) function least_inertia(case, station) result(inertia)
    type(case_t), intent(in) :: case
    integer, intent(in) :: station
    type(crank_train_t), allocatable :: train
    real(dp), allocatable :: mean(:), least(:)
    call build_train(case, .false., train)
    allocate (mean(train%n), least(train%n))
    call station_inertias(train, bodies_of(case), mean, least)
    inertia = merge(least(station), 0.0_dp, least(station) > 1e-12_dp*mean(station))
  end function least_inertia

  !> The mean inertia of each station with its cylinders over a turn [kg m^2].
  subroutine mean_inertias(train, bodies, mean)
    type(crank_train_t), intent(in) :: train
    type(bodies_t), intent(in) :: bodies
    real(dp), allocatable, intent(out) :: mean(:)
    real(dp), allocatable :: least(:)
    allocate (mean(train%n), least(train%n))
    call station_inertias(train, bodies, mean, least)
  end subroutine mean_inertias
end module train_builder
