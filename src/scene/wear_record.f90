!> Counts the wear of pin and bore of a joint during a run. The motion does not depend on it.
module wear_record
  use kinds, only: dp
  use constants, only: pi
  use run_state, only: run_state_t
  use ode_method, only: ode_method_t
  use archard_wear, only: worn_surface_t, of_pin, of_bore
  use contact_arc, only: contact_arc_t
  use clearance_joint, only: clearance_joint_t, phase_contact
  use scene_problem, only: scene_t, evaluation_t
  use run_length, only: longest_period
  implicit none
  private
  public :: wear_record_t, wear_profile_t

  !> The worn surfaces of a joint at the end of a run. Arrays have one element, or column, for the pin and one for the bore.
  type :: wear_profile_t
    integer :: place = 0                       !! spot of the pin
    real(dp), allocatable :: depth(:, :)       !! mean depth of wear in each bin [m]
    real(dp), allocatable :: volume(:, :)      !! volume worn from each bin [m^3]
    logical :: bore_changes = .false.          !! the following numbers belong to a bore whose shape changes
    real(dp) :: turns = 0                      !! turns of the crank that its last shape stands for
    real(dp) :: step_ratios(2) = 0             !! largest change of depth over the clearance, and over the mean penetration
  end type wear_profile_t

  !> Gauss's rule with three points inside Kronrod's with seven, on [-1, 1].
  integer, parameter :: n_nodes = 7
  real(dp), parameter :: nodes(n_nodes) = [-0.96049126870802028342_dp, -0.77459666924148337704_dp, -0.43424374934680255800_dp, &
    0.0_dp, 0.43424374934680255800_dp, 0.77459666924148337704_dp, 0.96049126870802028342_dp]
  real(dp), parameter :: weights(n_nodes) = [0.10465622602646726519_dp, 0.26848808986833344073_dp, 0.40139741477596222291_dp, &
    0.45091653865847414235_dp, 0.40139741477596222291_dp, 0.26848808986833344073_dp, 0.10465622602646726519_dp]
  real(dp), parameter :: gauss(n_nodes) = [0.0_dp, 5.0_dp, 0.0_dp, 8.0_dp, 0.0_dp, 5.0_dp, 0.0_dp]/9

  !> What the nodes of one interval need to be distributed over the surfaces.
  type :: samples_t
    type(evaluation_t) :: now(n_nodes)
    real(dp) :: load(n_nodes)                  !! pressing force times sliding speed [W]
    real(dp) :: angle(n_nodes, 2)              !! of the line of centres, from marks on pin and bore, without jumps [rad]
  end type samples_t

  type :: wear_record_t
    integer :: joint = 0                       !! index of the scene's joint
    integer :: evaluations = 0                 !! number of evaluations of the scene so far
    real(dp) :: time = 0                       !! time up to which wear has been counted [s]
    real(dp), private :: total = 0             !! integral of pressing force times sliding speed since the bore last changed [N m]
    real(dp), private :: depth_sum = 0         !! the same of their product with the penetration [N m^2]
    type(worn_surface_t), private :: surface(2)    !! since the last change of the bore
    type(worn_surface_t), private :: earlier(2)    !! before it, extrapolated
    real(dp), private :: turns = 0             !! turns of the crank that `earlier` stands for
    real(dp), private :: step_ratios(2) = 0    !! largest change of depth over the clearance, and over the mean penetration
    real(dp), allocatable, private :: before(:, :)   !! load path of each bin before the last change of the bore, as it was [N m]
    real(dp), allocatable, private :: marks(:, :, :) !! the same at the ends of revolutions, (bin, surface, mod(k, ...)) [N m]
    real(dp), allocatable, private :: ahead(:, :)    !! load path at the end of a revolution inside the present step [N m]
    integer, private :: last_mark = 0                !! revolution marked last
  contains
    procedure :: prepare
    procedure :: follow
    procedure :: look_ahead
    procedure :: mark_revolution
    procedure :: growth
    procedure :: declare
    procedure :: begin_at
    procedure :: change_bore
    procedure :: end_cycle
    procedure :: find_profile
  end type wear_record_t

contains

  !> Prepare to count the wear of a joint, from none.
  subroutine prepare(self, joint, scene)
    class(wear_record_t), intent(inout) :: self
    integer, intent(in) :: joint               !! index of a joint with wear
    type(scene_t), intent(in) :: scene
    integer :: k
    self%joint = joint
    do k = 1, size(self%surface)
      call self%surface(k)%prepare(scene%joints(joint)%wear%bins)
      call self%earlier(k)%prepare(scene%joints(joint)%wear%bins)
    end do
    associate (bins => scene%joints(joint)%wear%bins)
      allocate (self%before(bins, 2), self%marks(bins, 2, 0:longest_period), source=0.0_dp)
    end associate
  end subroutine prepare

  !> Declare the wear so far of a joint of the scene, and shape its bore by it. The load path of a bin is the integral of the force
  !> that presses on it over the sliding path.
  subroutine declare(self, pre, list, joint)
    class(wear_record_t), intent(inout) :: self
    character(len=*), intent(in) :: pre
    type(run_state_t), intent(inout) :: list
    type(clearance_joint_t), intent(inout) :: joint
    character(len=*), parameter :: of(2) = [character(len=4) :: 'pin', 'bore']
    integer :: k
    do k = 1, size(of)
      call list%add(pre//trim(of(k))//'_load_path', self%surface(k)%load_path, 'N m', 'load path of each bin, from 0 degrees')
      if (joint%has_worn_bore()) call list%add(pre//trim(of(k))//'_earlier_load_path', self%earlier(k)%load_path, 'N m', &
        'load path of each bin before the bore changed its shape last, extrapolated')
    end do
    call list%add(pre//'load_path', self%total, 'N m', 'load path of all bins')
    if (.not. joint%has_worn_bore()) return
    call list%add(pre//'load_path_penetration', self%depth_sum, 'N m2', 'integral of the penetration over it')
    call list%add(pre//'wear_revolutions', self%turns, '', 'crank revolutions of the wear before')
    call list%add(pre//'wear_steps', self%step_ratios, '', &
      'largest change of depth at once, over the clearance and over the mean penetration')
    if (list%sets .and. list%goes_on) call shape_bore(self, joint)
  end subroutine declare

  !> Forget the wear before a time [s].
  subroutine begin_at(self, t)
    class(wear_record_t), intent(inout) :: self
    real(dp), intent(in) :: t
    integer :: i
    self%time = t
    self%total = 0
    self%depth_sum = 0
    do i = 1, size(self%surface)
      self%surface(i)%load_path = 0
      self%earlier(i)%load_path = 0
    end do
    self%before = 0
  end subroutine begin_at

  !> Change the shape of the bore of a joint by the wear since the last change.
  subroutine change_bore(self, joint)
    class(wear_record_t), intent(inout) :: self
    type(clearance_joint_t), intent(inout) :: joint
    call self%end_cycle(joint)
    call shape_bore(self, joint)
  end subroutine change_bore

  !> Give the bore of a joint the shape of the wear up to its last change.
  subroutine shape_bore(self, joint)
    type(wear_record_t), intent(in) :: self
    type(clearance_joint_t), intent(inout) :: joint
    call joint%slots(joint%acting(phase_contact))%element%wear_bore(depth_by_load(self, joint, of_bore)* &
      self%earlier(of_bore)%load_path)
  end subroutine shape_bore

  !> Depth of wear in a bin over its load path [1/N].
  pure real(dp) function depth_by_load(self, joint, surface)
    class(wear_record_t), intent(in) :: self
    type(clearance_joint_t), intent(in) :: joint
    integer, intent(in) :: surface   !! of_pin or of_bore
    associate (radius => merge(joint%pin_radius, joint%bearing%radius, surface == of_pin))
      depth_by_load = joint%wear%rate(surface)/(radius*joint%bearing%length*self%surface(surface)%width())
    end associate
  end function depth_by_load

  !> Multiply the wear since the last change of the bore by the extrapolation. This is reduced if the change of depth would exceed
  !> the largest ratio to the clearance, or twice that ratio to the mean penetration, weighted by the load; wear that has happened
  !> always counts.
  subroutine end_cycle(self, joint)
    class(wear_record_t), intent(inout) :: self
    type(clearance_joint_t), intent(in) :: joint
    real(dp) :: factor, change, lengths(2)
    integer :: k
    change = depth_by_load(self, joint, of_bore)*maxval(self%surface(of_bore)%load_path)
    lengths = joint%bearing%clearance
    if (self%total > 0) lengths(2) = self%depth_sum/self%total
    factor = joint%wear%extrapolation
    if (change > 0) factor = max(1.0_dp, min(factor, minval([1, 2]*joint%wear%greatest_step_ratio*lengths/change)))
    if (change > 0) self%step_ratios = max(self%step_ratios, factor*change/lengths)
    do k = 1, size(self%surface)
      self%before(:, k) = self%before(:, k) + self%surface(k)%load_path
      self%earlier(k)%load_path = self%earlier(k)%load_path + factor*self%surface(k)%load_path
      self%surface(k)%load_path = 0
    end do
    self%turns = self%turns + factor*joint%wear%cycles_per_update
    self%total = 0
    self%depth_sum = 0
  end subroutine end_cycle

  !> Count the wear up to t, in the last step of the method and in one phase of the joint. An interval is halved until the rules of
  !> three and seven points agree within the tolerance of the run, relative to the sum so far, and until the line of centres turns
  !> by at most `widest_turn`.
  subroutine follow(self, method, scene, t)
    class(wear_record_t), intent(inout) :: self
    class(ode_method_t), intent(inout) :: method
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t
    real(dp), parameter :: shortest = 1.0_dp/4096   !! of an interval, over the time since the last call
    type(samples_t) :: samples
    real(dp), parameter :: finest = 1e-8_dp         !! least tolerance of the sum
    real(dp) :: done, part, span, sums(2), turn, widest
    logical :: is_rough
    span = t - self%time
    if (scene%joints(self%joint)%rubs() .and. span > 0) then
      done = 0
      part = 1
      do while (done < 1)
        call evaluate_nodes(self, method, scene, self%time + done*span, part*span, samples)
        sums = 0.5_dp*part*span*[dot_product(weights, samples%load), dot_product(gauss, samples%load)]
        is_rough = sums(1) > 0 .and. part > shortest
        turn = sweep(samples)
        widest = widest_turn(self, scene, turn, samples)
        if (is_rough) is_rough = turn > widest .or. &
          sums(1)*(10*abs(sums(1) - sums(2))/sums(1))**1.5_dp > max(method%settings%tolerance, finest)*(self%total + sums(1))
        if (is_rough) then
          part = 0.5_dp*part
        else
          if (sums(1) > 0) call distribute(self, scene, sums(1), samples)
          self%total = self%total + sums(1)
          done = done + part
          part = (0.9_dp*widest/max(turn, 0.45_dp*widest))*part   ! at most twice; it should not have to be halved
          if (done + part > 1 - shortest) part = 1 - done
        end if
      end do
    end if
    self%time = t
  end subroutine follow

  !> Find the wear at the end of a revolution at t, inside the last step. It is counted only when the step ends, so that it does not
  !> depend on whether revolutions are followed.
  subroutine look_ahead(self, method, scene, t)
    class(wear_record_t), intent(inout) :: self
    class(ode_method_t), intent(inout) :: method
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t
    type(wear_record_t) :: copy
    copy = self
    call copy%follow(method, scene, t)
    self%evaluations = copy%evaluations
    self%ahead = load_path(copy)
  end subroutine look_ahead

  !> Mark the wear at the end of revolution k: that found ahead inside a step, or that counted so far.
  subroutine mark_revolution(self, k)
    class(wear_record_t), intent(inout) :: self
    integer, intent(in) :: k
    self%last_mark = k
    if (.not. allocated(self%ahead)) self%ahead = load_path(self)
    self%marks(:, :, mod(k, size(self%marks, 3))) = self%ahead
    deallocate (self%ahead)
  end subroutine mark_revolution

  !> Largest depth by which a bin of the pin and one of the bore has worn in the last revolutions [m]. All of them, and the one
  !> before, must be marked.
  pure function growth(self, scene, revolutions) result(depth)
    class(wear_record_t), intent(in) :: self
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: revolutions   !! up to `longest_period`
    real(dp) :: depth(2)
    integer :: k
    associate (n => size(self%marks, 3))
      do k = 1, size(depth)
        depth(k) = depth_by_load(self, scene%joints(self%joint), k)*maxval(self%marks(:, k, mod(self%last_mark, n)) - &
          self%marks(:, k, mod(self%last_mark - revolutions, n)))
      end do
    end associate
  end function growth

  !> Load path of each bin so far, without extrapolation, (bin, surface) [N m].
  pure function load_path(self)
    class(wear_record_t), intent(in) :: self
    real(dp) :: load_path(size(self%before, 1), 2)
    integer :: k
    do k = 1, size(self%surface)
      load_path(:, k) = self%before(:, k) + self%surface(k)%load_path
    end do
  end function load_path

  !> Largest angle by which the line of centres may turn in an interval [rad]: two bins, or one if the worn bore acts; where the
  !> surfaces touch along a wide arc, half of the standard deviation of the load along it, since the load of a bin then changes
  !> little. The standard deviation is computed only where `turn` exceeds these bins.
  function widest_turn(self, scene, turn, samples) result(widest)
    type(wear_record_t), intent(in) :: self
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: turn
    type(samples_t), intent(in) :: samples
    real(dp) :: widest
    integer, parameter :: in_middle = (n_nodes + 1)/2
    type(contact_arc_t) :: arc
    real(dp) :: total, middle
    associate (joint => scene%joints(self%joint), width => self%surface(of_bore)%width())
      widest = merge(1, 2, joint%has_worn_bore())*width
      if (turn <= widest) return
      call joint%slots(joint%acting(joint%phase))%element%spread(samples%now(in_middle)%joint(self%joint), width=width, arc=arc)
    end associate
    if (arc%n == 0) return
    associate (at => 0.5_dp*(arc%ends(1, :arc%n) + arc%ends(2, :arc%n)), load => arc%loads(:arc%n))
      total = sum(load)
      if (.not. total > 0) return
      middle = sum(load*at)/total
      widest = max(widest, 0.5_dp*sqrt(sum(load*(at - middle)**2)/total))
    end associate
  end function widest_turn

  !> Evaluate the scene at the nodes of an interval.
  subroutine evaluate_nodes(self, method, scene, t, span, samples)
    type(wear_record_t), intent(inout) :: self
    class(ode_method_t), intent(inout) :: method
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t, span   !! beginning and length of the interval [s]
    type(samples_t), intent(inout) :: samples
    real(dp), parameter :: negligible = 1e-200_dp   !! [W]; avoids divisions of rounding
    real(dp) :: y(scene%n), time
    logical :: in_domain
    integer :: i, k
    k = self%joint
    do i = 1, n_nodes
      time = t + 0.5_dp*(1 + nodes(i))*span
      call method%interpolate(time, y)
      call scene%evaluate(time, y, samples%now(i), in_domain)
      samples%load(i) = 0
      samples%angle(i, :) = 0
      if (i > 1) samples%angle(i, :) = samples%angle(i - 1, :)
      if (.not. in_domain) cycle
      associate (now => samples%now(i), before => samples%angle(i, :))
        samples%load(i) = scene%joints(k)%sliding_load(now%joint(k))
        if (samples%load(i) < negligible) samples%load(i) = 0
        samples%angle(i, :) = before + modulo(atan2(now%joint(k)%normal(2), now%joint(k)%normal(1)) &
          - scene%turned(now, k) - before + pi, 2*pi) - pi
      end associate
    end do
    self%evaluations = self%evaluations + n_nodes
  end subroutine evaluate_nodes

  !> Largest angle that the line of centres passes over on a surface [rad].
  pure real(dp) function sweep(samples)
    type(samples_t), intent(in) :: samples
    sweep = maxval(maxval(samples%angle, 1) - minval(samples%angle, 1))
  end function sweep

  !> Distribute the load path of an interval over the surfaces: along the arcs of contact at the points of Gauss's rule, or where
  !> surfaces touch along a line, which may turn back, the part of each node over the angle that it passes over around this node.
  subroutine distribute(self, scene, total, samples)
    type(wear_record_t), intent(inout) :: self
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: total   !! [N m]
    type(samples_t), intent(in) :: samples
    real(dp), parameter :: to_end = (1 + nodes(1))/(nodes(2) - nodes(1))   !! from the outer nodes to the ends of the interval
    type(contact_arc_t) :: arc
    real(dp) :: shares(n_nodes), on_line, edges(0:n_nodes)
    integer :: i, j, k
    shares = gauss*samples%load
    if (.not. sum(shares) > 0) shares = weights*samples%load
    shares = total/sum(shares)*shares
    on_line = 0
    do i = 1, n_nodes
      if (.not. shares(i) > 0) cycle
      self%depth_sum = self%depth_sum + shares(i)*samples%now(i)%joint(self%joint)%penetration
      associate (joint => scene%joints(self%joint), now => samples%now(i)%joint(self%joint))
        call joint%slots(joint%acting(joint%phase))%element%spread(now, width=self%surface(of_bore)%width(), arc=arc)
      end associate
      if (arc%n == 0) on_line = on_line + shares(i)
      if (arc%n > 0) arc%loads(:arc%n) = shares(i)/sum(arc%loads(:arc%n))*arc%loads(:arc%n)
      do k = 1, size(self%surface)
        do j = 1, arc%n
          call self%surface(k)%add(samples%angle(i, k) + arc%ends(1, j), samples%angle(i, k) + arc%ends(2, j), arc%loads(j))
        end do
      end do
    end do
    if (.not. on_line > 0) return
    shares = weights*samples%load
    shares = on_line/sum(shares)*shares
    do k = 1, size(self%surface)
      associate (angle => samples%angle(:, k))
        edges(1:n_nodes - 1) = 0.5_dp*(angle(:n_nodes - 1) + angle(2:))
        edges(0) = angle(1) - to_end*(angle(2) - angle(1))
        edges(n_nodes) = angle(n_nodes) + to_end*(angle(n_nodes) - angle(n_nodes - 1))
      end associate
      do i = 1, n_nodes
        if (shares(i) > 0) call self%surface(k)%add(edges(i - 1), edges(i), shares(i))
      end do
    end do
  end subroutine distribute

  !> The worn surfaces so far.
  subroutine find_profile(self, scene, worn)
    class(wear_record_t), intent(in) :: self
    type(scene_t), intent(in) :: scene
    type(wear_profile_t), intent(out) :: worn
    real(dp) :: radius
    integer :: k
    associate (joint => scene%joints(self%joint), n => size(self%surface(1)%load_path))
      worn%place = joint%spot
      worn%bore_changes = joint%has_worn_bore()
      worn%turns = self%turns
      worn%step_ratios = self%step_ratios
      allocate (worn%depth(n, 2), worn%volume(n, 2))
      do k = 1, size(self%surface)
        radius = merge(joint%pin_radius, joint%bearing%radius, k == of_pin)
        worn%volume(:, k) = joint%wear%rate(k)*(self%earlier(k)%load_path + self%surface(k)%load_path)
        worn%depth(:, k) = worn%volume(:, k)/(radius*joint%bearing%length*self%surface(k)%width())
      end do
    end associate
  end subroutine find_profile
end module wear_record
