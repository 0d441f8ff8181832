!> The layout of a scene's state vector: what its parts claim in it, and their values at the start.
submodule (scene_problem) scene_layout
  use joint_places, only: in_order
  implicit none

contains

  module procedure claim
    integer :: i
    self%joint_at = 0
    do i = 1, size(self%joints)
      self%joint_at(self%joints(i)%spot) = i
    end do
    self%reported = [pack(in_order, in_order == in_order(1) .or. self%joint_at(in_order) > 0), &
      pack([(i, i=n_places + 1, n_spots)], self%joint_at(n_places + 1:) > 0)]
    self%has_numbers = any(self%joint_at(n_places + 1:) > 0)
    self%highest_mode = n_phases**self%n_joints - 1
    if (allocated(self%guide)) self%highest_mode = 2*(self%highest_mode + 1) - 1
    self%crank_moves = self%chain%drive%free_crank .or. self%chain%has_crankshaft()
    if (allocated(self%chain%train)) self%crank_moves = self%chain%train%frees_crank(self%chain%drive)
    self%has_charge = .false.
    if (allocated(self%gas)) self%has_charge = self%gas%has_states()
    call claim_states(self)
    call self%layout%count_again()
    call claim_states(self)
    self%has_heat = any([(allocated(self%joints(i)%heat), i=1, self%n_joints)])
    self%clears_loads = self%has_heat
    self%is_plain = .not. (allocated(self%chain%elastic) .or. allocated(self%guide) .or. allocated(self%chain%varying) &
      .or. allocated(self%chain%train) .or. allocated(self%chain%floating) .or. allocated(self%given_load))
    self%has_more_rates = any(self%joints%has_own_rates) .or. allocated(self%chain%elastic) .or. allocated(self%guide) &
      .or. allocated(self%chain%train) .or. allocated(self%chain%floating) .or. size(self%carried) > 0 &
      .or. self%has_charge
    call self%set_layout()
  end procedure claim

  !> Let all parts claim their states.
  subroutine claim_states(scene)
    class(scene_t), intent(inout) :: scene
    type(slice_t) :: work
    integer :: i
    if (scene%crank_moves) call scene%layout%claim_positions(1, 1.0_dp, scene%speed_scale(), scene%crank, grows=.true.)
    do i = 1, scene%n_joints
      call scene%joints(i)%claim(scene%layout, scene%speed_scale(), scene%span)
    end do
    do i = 1, size(scene%carried)
      call scene%carried(i)%claim(scene%layout, scene%joints(scene%carried(i)%joint))
    end do
    if (allocated(scene%chain%floating)) call scene%chain%floating%claim(scene%layout, &
      scene%speed_scale()*scene%chain%bodies%crank%length*scene%chain%bodies%per_rod_length)
    if (allocated(scene%guide)) call scene%guide%claim(scene%layout, scene%speed_scale(), scene%span)
    if (allocated(scene%chain%elastic)) call claim_elastic(scene)
    if (allocated(scene%chain%train)) call claim_train(scene)
    call scene%layout%claim_quadratures(1, scene%energy_scale(), work)
    scene%work_at = work%first
    if (.not. scene%has_charge) return
    i = 1
    if (allocated(scene%chain%train)) i = 1 + size(scene%chain%train%cylinders)
    call scene%gas%charge%claim(scene%layout, i)
  end subroutine claim_states

  !> Claim the states of the elastic members.
  subroutine claim_elastic(scene)
    class(scene_t), intent(inout) :: scene
    real(dp) :: own_speed
    integer :: i
    own_speed = 0
    do i = 1, scene%n_joints
      own_speed = max(own_speed, scene%joints(i)%own_speed(scene%span))
    end do
    associate (elastic => scene%chain%elastic)
      elastic%start_angle = scene%start_angle
      elastic%start_speed = scene%start_speed
      elastic%holds_flywheel = .not. scene%chain%drive%free_crank
      if (scene%runs_up .and. scene%chain%has_crankshaft()) elastic%run_up = scene%chain%varying
      call elastic%claim(scene%layout, scene%chain%bodies, scene%speed_scale(), own_speed)
    end associate
  end subroutine claim_elastic

  !> Claim the states of stations and dampers.
  subroutine claim_train(scene)
    class(scene_t), intent(inout) :: scene
    associate (train => scene%chain%train)
      train%start_angle = scene%start_angle
      train%start_speed = scene%start_speed
      train%holds_station = .not. scene%chain%drive%free_crank .and. train%driven /= train%full
      if (scene%runs_up .and. train%holds_station) train%run_up = scene%chain%varying
      call train%claim(scene%layout, scene%chain%bodies, scene%speed_scale())
    end associate
  end subroutine claim_train

  module procedure set_layout
    self%n = self%layout%n()
    self%n_positions = self%layout%n_positions
    self%n_quadratures = self%layout%n_quadratures
  end procedure set_layout

  module procedure measure_joint
    integer :: n
    real(dp) :: scale
    n = size(self%reported)
    scale = 0
    if (self%n_joints > 0) then
      self%measures_loss = .not. work_tells(self)
      if (self%measures_loss) n = n + 1
    else if (.not. allocated(self%given_load)) then
      scale = self%energy_scale()/(self%chain%bodies%crank%length*self%speed_scale())
    end if
    call self%layout%claim_quadratures(n, scale, self%measures)
    self%has_more_rates = .true.
    call self%set_layout()
  end procedure measure_joint

  !> Whether the energy taken by the joints follows from the work of all forces: no other part does work except a constant torque.
  pure logical function work_tells(scene)
    class(scene_t), intent(in) :: scene
    work_tells = scene%chain%drive%free_crank .and. .not. (scene%chain%drive%damping > 0 .or. allocated(scene%gas) &
      .or. allocated(scene%chain%varying) .or. allocated(scene%guide) .or. allocated(scene%chain%elastic) &
      .or. allocated(scene%chain%train))
  end function work_tells

  module procedure initial_state
    integer :: i
    y = 0
    if (allocated(self%chain%elastic)) call self%chain%elastic%set_start(y)
    if (self%crank_moves) then
      y(self%crank%position) = self%start_angle
      y(self%crank%rate) = self%start_speed
      if (self%runs_up) y(self%crank%rate) = self%chain%varying%first_speed   ! on a shaft whose other end is run up
    end if
    do i = 1, self%n_joints
      call self%joints(i)%set_start(y)
    end do
    do i = 1, size(self%carried)
      call self%carried(i)%set_start(self%joints(self%carried(i)%joint), y)
    end do
    if (allocated(self%chain%floating)) call self%chain%floating%set_start(y)
    if (allocated(self%guide)) call self%guide%set_start(y)
    if (.not. self%has_charge) return
    call self%gas%set_charge(self%start_angle, y)
    if (allocated(self%other_gas)) &
      call self%other_gas%set_charges(self%gas, self%start_angle + self%chain%train%cylinders%shift, y)
  end procedure initial_state

  module procedure compared_states
    integer :: i, angle
    angle = 0
    if (allocated(self%chain%floating)) angle = self%chain%floating%turn%position
    at = [(i, i=1, self%n - self%n_quadratures)]
    at = pack(at, at /= self%crank%position .and. at /= angle)
  end procedure compared_states
end submodule scene_layout
