!> A crankshaft with several cylinders: a chain of stations j = 1..n from the front with the inertias J_j, between them segments
!> with torsional stiffness and damping, rings of dampers on stations, and cylinders with ideal joints. The mechanism, with
!> everything that it may have, stands at the station m; its angle is the crank angle q, and u_j = q_j - q are the twists. A rigid
!> shaft has n = 1.
!>
!>     M_j = k_j (q_(j+1) - q_j) + c_j (q_(j+1)' - q_j'):  torque of segment j on station j, -M_j on station j + 1
!>     M_r = k_r (q_r - q_s) + c_r (q_r' - q_s'):          torque of ring r on its station s;  J_r q_r'' = -M_r
!>     (J_j + sum I_i) q_j'' = sum (G_i - I_i'/2 q_j'^2) + M_j - M_(j-1) + sum M_r - d_j (q_j' - w_d) + drive at its station
!>
!> At m the same sums are added to the equation of the crank: no other acceleration is coupled with those of the mechanism.
module crank_train
  use kinds, only: dp
  use state_layout, only: layout_t, coordinates_t, slice_t
  use run_state, only: run_state_t
  use chain_motion, only: motion_t, accelerations_t, turn_crank
  use train_motion, only: most_stations, most_cylinders
  use chain_bodies, only: bodies_t, drive_t
  use varying_drive, only: varying_drive_t
  use ideal_cylinders, only: ideal_cylinder_t, small_sine_cosine
  implicit none
  private
  public :: crank_train_t, ring_t

  !> The ring of a damper; one in oil (viscous) has no stiffness, and its angle is no state.
  type :: ring_t
    integer :: station = 1
    logical :: is_viscous = .false.
    real(dp) :: inertia = 0          !! [kg m^2]
    real(dp) :: stiffness = 0        !! [N m/rad]
    real(dp) :: damping = 0          !! [N m s/rad]
    type(coordinates_t) :: at        !! its angle from its station, if it is not viscous
    type(slice_t) :: speed_at        !! its speed minus that of its station, if it is
  end type ring_t

  type :: crank_train_t
    integer :: n = 1                 !! number of stations
    integer :: full = 1              !! m, the station of the mechanism
    integer :: driven = 1            !! station of the drive
    logical :: is_chain = .false.    !! the case gives stations; else the shaft is rigid and has no results of its own
    integer :: full_number = 1, full_throw = 1   !! cylinder of the mechanism in the case, and its throw
    real(dp) :: full_axial_position = 0          !! [m]
    real(dp) :: axis_offset = 0                  !! of all cylinder axes, each along its own y [m]
    integer :: n_throws = 1
    integer :: throw_station(most_cylinders) = 1 !! station of each throw
    real(dp) :: inertia(most_stations) = 0       !! J_j [kg m^2]
    real(dp) :: stiffness(most_stations) = 0     !! k_j [N m/rad]
    real(dp) :: damping(most_stations) = 0       !! c_j [N m s/rad]
    real(dp) :: drag(most_stations) = 0          !! d_j [N m s/rad]
    real(dp) :: drag_speed = 0                   !! w_d [rad/s]
    type(ring_t), allocatable :: rings(:)
    type(ideal_cylinder_t), allocatable :: cylinders(:)   !! without that of the mechanism
    type(coordinates_t) :: at(most_stations)     !! indices of the twists in the state
    logical :: holds_station = .false.           !! the speed of the driven station is prescribed, and it is not m
    type(varying_drive_t), allocatable :: run_up !! this speed with a run-up; not allocated: it is constant
    real(dp) :: start_angle = 0, start_speed = 0 !! of the held station [rad], [rad/s]
  contains
    procedure :: claim
    procedure :: declare
    procedure :: energy_scale
    procedure, non_overridable :: read_state
    procedure, non_overridable :: load_stations
    procedure, non_overridable :: drive_of_crank
    procedure, non_overridable :: accelerate_stations
    procedure, non_overridable :: set_rates
    procedure, non_overridable :: segment_torque
    procedure, non_overridable :: ring_torque
    procedure, non_overridable :: find_journal
    procedure :: energy
    procedure, non_overridable :: frees_crank
    procedure :: add_slopes
  end type crank_train_t

  interface
    !> Claim the twists of stations and the angles and speeds of rings in the state vector. The scale of a twist is that by a torque
    !> of the size of the mechanism's energy.
    module subroutine claim(self, layout, bodies, crank_speed)
      class(crank_train_t), intent(inout) :: self
      type(layout_t), intent(inout) :: layout
      type(bodies_t), intent(in) :: bodies   !! of the mechanism
      real(dp), intent(in) :: crank_speed    !! natural size of the crank speed [rad/s]
    end subroutine claim

    !> Declare the states at the angle [rad] and the speed [rad/s] of the crank.
    module subroutine declare(self, list, t, y, crank_angle, crank_speed)
      class(crank_train_t), intent(inout) :: self
      type(run_state_t), intent(inout) :: list
      real(dp), intent(in) :: t, crank_angle, crank_speed
      real(dp), intent(inout) :: y(:)
    end subroutine declare

    !> Complete the derivatives of the accelerations with respect to the state (see `difference_jacobian`): those of the mechanism
    !> must be there, with the damping of a drive at its station; those of stations and rings are set, and the mechanism's get what
    !> the torque of the shaft adds.
    module subroutine add_slopes(self, drive, inertia, crank, rows, by_torque, a_p, a_v)
      class(crank_train_t), intent(in) :: self
      type(drive_t), intent(in) :: drive
      real(dp), intent(in) :: inertia(:)       !! of the stations [kg m^2]
      type(coordinates_t), intent(in) :: crank !! the crank angle in the state; n = 0: its speed is prescribed
      integer, intent(in) :: rows(:)           !! rows of the mechanism's accelerations that follow a torque on the crank
      real(dp), intent(in) :: by_torque(:)     !! their derivatives with respect to it
      real(dp), intent(inout) :: a_p(:, :), a_v(:, :)
    end subroutine add_slopes

    !> Natural size of the energy of stations, rings and cylinders [J].
    pure real(dp) module function energy_scale(self, crank_speed)
      class(crank_train_t), intent(in) :: self
      real(dp), intent(in) :: crank_speed    !! natural size [rad/s]
    end function energy_scale
  end interface

contains

  !> Set the motion of stations and rings and the crank angles of the cylinders, for a motion whose crank is known.
  pure subroutine read_state(self, t, y, motion)
    class(crank_train_t), intent(in) :: self
    real(dp), intent(in) :: t, y(*)
    type(motion_t), intent(inout) :: motion
    integer :: j
    associate (train => motion%train)
      do j = 1, self%n
        if (self%at(j)%n == 0) cycle
        train%twist(j) = y(self%at(j)%position)
        train%speed(j) = motion%crank_speed + y(self%at(j)%rate)
      end do
      train%twist(self%full) = 0
      train%speed(self%full) = motion%crank_speed
      if (self%holds_station) then
        if (allocated(self%run_up)) then
          train%twist(self%driven) = self%start_angle + self%run_up%turned(t) - motion%crank_angle
          train%speed(self%driven) = self%run_up%speed(t)
          motion%held_acceleration = self%run_up%acceleration(t)
        else
          train%twist(self%driven) = self%start_angle + self%start_speed*t - motion%crank_angle
          train%speed(self%driven) = self%start_speed
        end if
      end if
      do j = 1, size(self%rings)
        associate (ring => self%rings(j))
          if (ring%is_viscous) then
            train%ring_twist(j) = 0
            train%ring_speed(j) = train%speed(ring%station) + y(ring%speed_at%first)
          else
            train%ring_twist(j) = y(ring%at%position)
            train%ring_speed(j) = train%speed(ring%station) + y(ring%at%rate)
          end if
        end associate
      end do
      do j = 1, size(self%cylinders)
        train%angle(j) = motion%crank_angle + train%twist(self%cylinders(j)%station) + self%cylinders(j)%shift
      end do
    end associate
  end subroutine read_state

  !> Set inertia and torque of each station, and the power of gas and damping. The forces of the gas must be known.
  pure subroutine load_stations(self, motion)
    class(crank_train_t), intent(in) :: self
    type(motion_t), intent(inout) :: motion
    real(dp) :: moment, before, drag, power
    integer :: i, j
    associate (train => motion%train)
      power = 0
      before = 0
      do j = 1, self%n
        drag = self%drag(j)*(train%speed(j) - self%drag_speed)
        power = power - drag*train%speed(j)
        moment = 0
        if (j < self%n) then
          moment = self%segment_torque(motion, j)
          power = power - self%damping(j)*(train%speed(j + 1) - train%speed(j))**2
        end if
        train%inertia(j) = self%inertia(j)
        train%torque(j) = moment - before - drag
        before = moment
      end do
      do i = 1, size(self%rings)
        j = self%rings(i)%station
        train%torque(j) = train%torque(j) + self%ring_torque(motion, i)
        power = power - self%rings(i)%damping*(train%ring_speed(i) - train%speed(j))**2
      end do
      train%damping_power = power
    end associate
    call load_by_cylinders(self, motion)
  end subroutine load_stations

  !> Add the cylinders to inertias and torques of the stations, and set the power of the gas.
  pure subroutine load_by_cylinders(train, motion)
    type(crank_train_t), intent(in) :: train
    type(motion_t), intent(inout) :: motion
    real(dp) :: sine, cosine, of_twist(2), at_shaft(2), inertia, half_slope, weight, rate, power
    integer :: i
    power = 0
    associate (at => motion%train)
      do i = 1, size(train%cylinders)
        associate (it => train%cylinders(i), j => train%cylinders(i)%station)
          at_shaft = [motion%sin_crank, motion%cos_crank]
          if (j /= train%full) then
            call small_sine_cosine(at%twist(j), of_twist(1), of_twist(2))
            at_shaft = [motion%sin_crank*of_twist(2) + motion%cos_crank*of_twist(1), &
              motion%cos_crank*of_twist(2) - motion%sin_crank*of_twist(1)]
          end if
          sine = at_shaft(1)*it%cos_shift + at_shaft(2)*it%sin_shift
          cosine = at_shaft(2)*it%cos_shift - at_shaft(1)*it%sin_shift
          call it%find_terms(sine, cosine, inertia, half_slope, weight, rate)
          at%inertia(j) = at%inertia(j) + inertia
          at%torque(j) = at%torque(j) + (weight - at%gas_force(i)*rate - half_slope*at%speed(j)**2)
          power = power - at%gas_force(i)*rate*at%speed(j)
        end associate
      end do
      at%gas_power = power
    end associate
  end subroutine load_by_cylinders

  !> The drive of the crank: by the shaft, the other cylinders and, if that acts there, the drive of the case.
  pure type(drive_t) function drive_of_crank(self, drive, motion) result(of_crank)
    class(crank_train_t), intent(in) :: self
    type(drive_t), intent(in) :: drive
    type(motion_t), intent(in) :: motion
    of_crank%free_crank = self%frees_crank(drive)
    of_crank%torque = motion%train%torque(self%full)
    of_crank%damping = 0
    of_crank%acceleration = drive%acceleration
    of_crank%inertia = motion%train%inertia(self%full)
    if (self%driven /= self%full) return
    if (drive%free_crank) of_crank%torque = of_crank%torque + drive%torque
    of_crank%damping = drive%damping
  end function drive_of_crank

  !> Whether the crank moves under its loads: unless its own speed is prescribed.
  pure logical function frees_crank(self, drive)
    class(crank_train_t), intent(in) :: self
    type(drive_t), intent(in) :: drive
    frees_crank = drive%free_crank .or. self%driven /= self%full
  end function frees_crank

  !> Accelerations of stations and rings, when that of the crank is known, and the moment of the drive [N m].
  pure subroutine accelerate_stations(self, drive, motion, accelerations, moment)
    class(crank_train_t), intent(in) :: self
    type(drive_t), intent(in) :: drive
    type(motion_t), intent(in) :: motion
    type(accelerations_t), intent(inout) :: accelerations
    real(dp), intent(inout) :: moment   !! in: of `drive_of_crank` on the crank
    real(dp) :: torque
    integer :: j
    associate (train => motion%train, driven => self%driven)
      do j = 1, self%n
        if (j /= self%full .and. j /= driven) accelerations%station(j) = train%torque(j)/train%inertia(j)
      end do
      accelerations%station(self%full) = accelerations%crank
      if (driven /= self%full) then
        torque = train%torque(driven) - drive%damping*train%speed(driven)
        if (drive%free_crank) then
          accelerations%station(driven) = (torque + drive%torque)/train%inertia(driven)
        else
          accelerations%station(driven) = drive%acceleration
          moment = train%inertia(driven)*drive%acceleration - torque
        end if
      else if (.not. drive%free_crank) then
        moment = moment - train%torque(driven)
      end if
    end associate
    if (drive%free_crank) moment = drive%torque
    do j = 1, size(self%rings)
      accelerations%ring(j) = -self%ring_torque(motion, j)/self%rings(j)%inertia
    end do
  end subroutine accelerate_stations

  pure subroutine set_rates(self, motion, accelerations, dydt)
    class(crank_train_t), intent(in) :: self
    type(motion_t), intent(in) :: motion
    type(accelerations_t), intent(in) :: accelerations
    real(dp), intent(inout) :: dydt(*)
    integer :: i, j
    associate (train => motion%train)
      do j = 1, self%n
        if (self%at(j)%n == 0) cycle
        dydt(self%at(j)%position) = train%speed(j) - motion%crank_speed
        dydt(self%at(j)%rate) = accelerations%station(j) - accelerations%crank
      end do
      do i = 1, size(self%rings)
        associate (ring => self%rings(i), station => self%rings(i)%station)
          if (ring%is_viscous) then
            dydt(ring%speed_at%first) = accelerations%ring(i) - accelerations%station(station)
          else
            dydt(ring%at%position) = train%ring_speed(i) - train%speed(station)
            dydt(ring%at%rate) = accelerations%ring(i) - accelerations%station(station)
          end if
        end associate
      end do
    end associate
  end subroutine set_rates

  !> M_j [N m].
  pure real(dp) function segment_torque(self, motion, j) result(torque)
    class(crank_train_t), intent(in) :: self
    type(motion_t), intent(in) :: motion
    integer, intent(in) :: j
    associate (train => motion%train)
      torque = self%stiffness(j)*(train%twist(j + 1) - train%twist(j)) + self%damping(j)*(train%speed(j + 1) - train%speed(j))
    end associate
  end function segment_torque

  !> M_r [N m].
  pure real(dp) function ring_torque(self, motion, i) result(torque)
    class(crank_train_t), intent(in) :: self
    type(motion_t), intent(in) :: motion
    integer, intent(in) :: i
    associate (ring => self%rings(i), train => motion%train)
      torque = ring%damping*(train%ring_speed(i) - train%speed(ring%station))
      if (.not. ring%is_viscous) torque = torque + ring%stiffness*train%ring_twist(i)
    end associate
  end function ring_torque

  !> Turn of the shaft beyond the crank angle [rad] and its speed [rad/s] at main bearing b: means of those of the stations of the
  !> throws b - 1 and b, at an end of the shaft those of the one there.
  pure subroutine find_journal(self, motion, b, twist, speed)
    class(crank_train_t), intent(in) :: self
    type(motion_t), intent(in) :: motion
    integer, intent(in) :: b
    real(dp), intent(out) :: twist, speed
    associate (beside => self%throw_station([max(1, b - 1), min(self%n_throws, b)]))
      twist = 0.5_dp*sum(motion%train%twist(beside))
      speed = 0.5_dp*sum(motion%train%speed(beside))
    end associate
  end subroutine find_journal

  !> Kinetic energy of stations and rings, elastic energy of segments and rings, and the energy of the cylinders [J].
  pure real(dp) function energy(self, motion)
    class(crank_train_t), intent(in) :: self
    type(motion_t), intent(in) :: motion
    integer :: i
    associate (train => motion%train, n => self%n)
      energy = 0.5_dp*sum(self%inertia(:n)*train%speed(:n)**2) &
        + 0.5_dp*sum(self%stiffness(:n - 1)*(train%twist(2:n) - train%twist(:n - 1))**2)
      do i = 1, size(self%rings)
        energy = energy + 0.5_dp*self%rings(i)%inertia*train%ring_speed(i)**2
        if (.not. self%rings(i)%is_viscous) energy = energy + 0.5_dp*self%rings(i)%stiffness*train%ring_twist(i)**2
      end do
      do i = 1, size(self%cylinders)
        energy = energy + self%cylinders(i)%energy(train%angle(i), train%speed(self%cylinders(i)%station))
      end do
    end associate
  end function energy
end module crank_train
