!> The states of a crankshaft with several cylinders: their natural sizes, and their declaration.
submodule (crank_train) train_states
  implicit none

  real(dp), parameter :: least_twist = 1e-6_dp   !! smallest natural size of a twist [rad]

contains

  module procedure claim
    real(dp) :: energy, scale, fastest
    integer :: i, j
    energy = 0.5_dp*(bodies%crank_term + bodies%piston%mass*bodies%crank%length**2)*crank_speed**2
    fastest = 0
    do j = 1, self%n - 1
      fastest = max(fastest, sqrt(self%stiffness(j)*(1/least_inertia(j) + 1/least_inertia(j + 1))))
    end do
    do j = 1, self%n
      self%at(j) = coordinates_t()
      if (j == self%full .or. self%holds_station .and. j == self%driven) cycle
      scale = max(least_twist, energy*sum(1/self%stiffness(min(j, self%full):max(j, self%full) - 1)))
      call layout%claim_positions(1, scale, min(scale*fastest, crank_speed), self%at(j), grows=.false.)
    end do
    do i = 1, size(self%rings)
      associate (ring => self%rings(i))
        if (ring%is_viscous) cycle
        scale = max(least_twist, energy/ring%stiffness)
        call layout%claim_positions(1, scale, min(scale*sqrt(ring%stiffness/ring%inertia), crank_speed), ring%at, grows=.false.)
      end associate
    end do
    do i = 1, size(self%rings)
      if (self%rings(i)%is_viscous) call layout%claim_states(1, crank_speed, self%rings(i)%speed_at)
    end do

  contains

    !> Inertia of a station, without what a cylinder adds only at some angles [kg m^2].
    pure real(dp) function least_inertia(j) result(inertia)
      integer, intent(in) :: j
      integer :: k
      inertia = self%inertia(j)
      if (j == self%full) inertia = inertia + bodies%crank_term
      do k = 1, size(self%cylinders)
        if (self%cylinders(k)%station == j) inertia = inertia + self%cylinders(k)%bodies%crank_term
      end do
      inertia = max(inertia, 1e-3_dp*bodies%piston%mass*bodies%crank%length**2)
    end function least_inertia
  end procedure claim

  module procedure energy_scale
    integer :: i
    energy_scale = 0.5_dp*(sum(self%inertia(:self%n)) + sum(self%rings%inertia))*crank_speed**2
    do i = 1, size(self%cylinders)
      associate (b => self%cylinders(i)%bodies)
        energy_scale = energy_scale + 0.5_dp*(b%crank_term + b%piston%mass*b%crank%length**2)*crank_speed**2 &
          + (b%crank%mass + b%rod%mass + b%piston%mass)*norm2(b%gravity)*b%crank%length
      end associate
    end do
  end procedure energy_scale

  module procedure declare
    type(motion_t) :: motion
    real(dp) :: twist(self%n), rate(self%n), ring(size(self%rings)), ring_rate(size(self%rings))
    integer :: i, j
    if (.not. self%is_chain) return
    call turn_crank(motion, crank_angle, crank_speed)
    call self%read_state(t, y, motion)
    twist = motion%train%twist(:self%n)
    rate = motion%train%speed(:self%n) - crank_speed
    ring = motion%train%ring_twist(:size(ring))
    do i = 1, size(ring)
      ring_rate(i) = motion%train%ring_speed(i) - motion%train%speed(self%rings(i)%station)
    end do
    call list%add('station_twists', twist, 'rad', 'angles of the stations of the crankshaft minus the crank angle')
    call list%add('station_twist_rates', rate, 'rad/s', 'their rates')
    if (size(ring) > 0) then
      call list%add('damper_twists', ring, 'rad', 'angles of the rings of dampers minus those of their stations; 0 in oil')
      call list%add('damper_twist_rates', ring_rate, 'rad/s', 'their rates')
    end if
    if (.not. list%sets) return
    do j = 1, self%n
      if (self%at(j)%n > 0) then
        y(self%at(j)%position) = twist(j)
        y(self%at(j)%rate) = rate(j)
      else if (j /= self%full) then
        self%start_angle = self%start_angle + (twist(j) - motion%train%twist(j))
      end if
    end do
    do i = 1, size(ring)
      if (self%rings(i)%is_viscous) then
        y(self%rings(i)%speed_at%first) = ring_rate(i)
      else
        y(self%rings(i)%at%position) = ring(i)
        y(self%rings(i)%at%rate) = ring_rate(i)
      end if
    end do
  end procedure declare
end submodule train_states
