!> An elastic connecting rod: its material, its shapes and their constants, and the motion of its pin.
!>
!> The deformation is described relative to the chord, the line from the centre of the big end to the piston pin, with the
!> coordinate xi from 0 to L along it:
!>
!>     w(xi, t) = sum_k eta_k(t) phi_k(xi),    phi_k = sin(k pi xi/L)                                       across the chord
!>     u(xi, t) = sum_j a_j(t) psi_j(xi),      psi_1 = xi/L,  psi_j = sin((j - 1) pi xi/L), j >= 2          along it
!>
!> A point of the rod is at xi + u - sigma along the chord and at w perpendicular to it. sigma = 1/2 int (dw/dxi)^2 is the
!> shortening due to bending: it stiffens a rod in tension, also under the inertia of its own mass, and softens a rod in compression
!> until it buckles. The length of the chord is
!>
!>     l = L + a_1 - sum_k b_k eta_k^2,    b_k = (k pi)^2/(4 L)
!>
!> The bending shapes are those of a beam on two pins. The axial shapes are those of Craig and Bampton (1968): the extension under a
!> force at the ends, and the free vibrations between fixed ends. Energies are of second order in the amplitudes; the position of
!> the pin and the work of the forces on it are exact in the terms above.
!>
!> Mass and moment of inertia are those of the rod in &mechanism. The elastic part is a uniform shank of mass m_b; point masses at
!> the two pins give the rod its total mass and its centre of mass along the chord.
module elastic_rod
  use kinds, only: dp
  use constants, only: pi
  use model_parameters, only: has_parameters_t, parameter_list_t
  use chain_motion, only: motion_t, most_shapes, crank_pin, piston_pin, body_big_end, body_small_end
  use chain_bodies, only: rod_t
  use small_cholesky, only: factorise_cholesky, solve_cholesky
  implicit none
  private
  public :: elastic_rod_t, most_of_a_kind, largest_shank

  integer, parameter :: most_of_a_kind = most_shapes/2   !! largest number of bending shapes, and of axial shapes
  !> The equations are those of small deformations. A chord that is shorter or longer than the rod by this part of its length is
  !> outside the model.
  real(dp), parameter :: largest_change = 0.5_dp

  type, extends(has_parameters_t) :: elastic_rod_t
    real(dp) :: youngs_modulus = 0        !! E [Pa]
    real(dp) :: section_area = 0          !! [m^2]
    real(dp) :: section_inertia = 0       !! second moment of area [m^4]
    integer :: n_bending = 0              !! number of bending shapes
    integer :: n_axial = 0                !! number of axial shapes; 0: the rod does not stretch
    real(dp) :: shank_mass = 0            !! m_b [kg]; 0: the largest possible value, set by `prepare`
    real(dp) :: damping_ratio = 0         !! damping ratio of each bending shape
    real(dp) :: axial_damping_ratio = 0   !! damping ratio of each axial shape
    ! quantities derived from these and from the rigid rod
    real(dp) :: length = 0                !! L [m]
    real(dp) :: end_mass = 0              !! m_2, point mass on the piston pin [kg]
    integer :: n = 0                      !! number of shapes; bending shapes come first
    real(dp) :: shortening(most_of_a_kind) = 0       !! b_k [1/m]
    real(dp) :: slope(most_of_a_kind, 2) = 0         !! dphi_k/dxi at the crank pin and at the piston pin [1/m]
    real(dp) :: bending_mass = 0                     !! M = int phi_k^2 dm [kg]
    real(dp) :: s(most_of_a_kind) = 0                !! S_k = int phi_k dm [kg]
    real(dp) :: t(most_of_a_kind) = 0                !! T_k = int xi phi_k dm [kg m]
    real(dp) :: p(most_of_a_kind, most_of_a_kind) = 0   !! P_ij = int phi_i' phi_j' (mass beyond xi) dxi [kg/m]
    real(dp) :: q(most_of_a_kind, most_of_a_kind) = 0   !! Q_ij, the same with the first moment of the mass beyond xi [kg]
    real(dp) :: z0(most_of_a_kind) = 0               !! int psi_j dm [kg]
    real(dp) :: z1(most_of_a_kind) = 0               !! int xi psi_j dm [kg m]
    real(dp) :: axial_mass(most_of_a_kind, most_of_a_kind) = 0      !! int psi_i psi_j dm [kg]
    real(dp) :: axial_inverse(most_of_a_kind, most_of_a_kind) = 0   !! inverse of this matrix [1/kg]
    real(dp) :: coupling(most_of_a_kind, most_of_a_kind) = 0        !! Z_jk = int psi_j phi_k dm [kg]
    real(dp) :: stiffness(most_shapes) = 0           !! of each shape [N/m]
    real(dp) :: damping(most_shapes) = 0             !! [N s/m]
  contains
    procedure :: parameters
    procedure :: prepare
    procedure :: follow
    procedure :: follow_piston
    procedure :: natural_frequency
    procedure :: bending_frequency
    procedure :: axial_frequency
    procedure :: mid_deflection
    procedure :: strain_energy
    procedure :: damping_power
  end type elastic_rod_t

contains

  subroutine parameters(self, list)
    class(elastic_rod_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call list%add('youngs_modulus', self%youngs_modulus, 'Young''s modulus of the rod', 'Pa', '> 0', default='207.0e9', &
      usual='1e9 to 1e12')
    call list%add('section_area', self%section_area, 'cross-sectional area of the shank', 'm^2', '> 0', example='3.0e-4', &
      usual='1e-7 to 1')
    call list%add('section_inertia', self%section_inertia, 'second moment of area for bending in the plane of motion', 'm^4', &
      '> 0', example='1.5e-8', usual='1e-14 to 0.1')
    call list%add('transverse_modes', self%n_bending, 'number of bending modes', '>= 0 and <= 8', '2')
    call list%add('axial_shapes', self%n_axial, &
      'number of axial shapes; 0: no stretching; 1 to 3 miss most of the waves of an impact', '>= 0 and <= 8', '4')
    call list%add('shank_mass', self%shank_mass, &
      'mass of the uniform elastic shank; 0: the largest that rod_mass and rod_com allow', 'kg', '> 0', default='0.0', &
      usual='1e-4 to 1e4')
    call list%add('damping_ratio', self%damping_ratio, 'damping ratio of each bending mode', range='>= 0 and < 1', default='0.01', &
      usual='0 to 0.2')
    call list%add('axial_damping_ratio', self%axial_damping_ratio, &
      'damping ratio of each axial shape', range='>= 0 and < 1', default='0.01', usual='0 to 0.2')
  end subroutine parameters

  !> Mass of the largest uniform shank with which no point mass is negative [kg].
  pure real(dp) function largest_shank(rod)
    type(rod_t), intent(in) :: rod
    largest_shank = min(rod%mass, 2*rod%mass*rod%com(1)/rod%length, 2*rod%mass*(1 - rod%com(1)/rod%length))
  end function largest_shank

  !> Compute the derived quantities from the keys and the rigid rod. Limits: 0 < U < L, mass > 0, 0 < shank_mass <= `largest_shank`.
  pure subroutine prepare(self, rod)
    class(elastic_rod_t), intent(inout) :: self
    type(rod_t), intent(in) :: rod
    real(dp) :: mass
    integer :: k

    if (.not. self%shank_mass > 0) self%shank_mass = largest_shank(rod)
    mass = self%shank_mass
    self%length = rod%length
    self%end_mass = max(0.0_dp, rod%mass*rod%com(1)/rod%length - 0.5_dp*mass)
    self%n = self%n_bending + self%n_axial
    self%bending_mass = 0.5_dp*mass
    self%stiffness = 0
    self%damping = 0
    do k = 1, self%n_bending
      self%shortening(k) = (k*pi)**2/(4*rod%length)
      self%slope(k, crank_pin) = k*pi/rod%length
      self%slope(k, piston_pin) = k*pi/rod%length*(-1)**k
      self%stiffness(k) = self%youngs_modulus*self%section_inertia*(k*pi/rod%length)**4*0.5_dp*rod%length
      self%damping(k) = 2*self%damping_ratio*sqrt(self%stiffness(k)*self%bending_mass)
    end do
    do k = 1, most_of_a_kind
      self%s(k) = mass*(1 - (-1)**k)/(k*pi)
      self%t(k) = -mass*rod%length*(-1)**k/(k*pi)
    end do
    call find_foreshortening(self)
    call find_axial(self)
  end subroutine prepare

  !> P and Q: integrals of cos(i pi x) cos(j pi x) times 1, x and x^2 over [0, 1].
  pure subroutine find_foreshortening(rod)
    class(elastic_rod_t), intent(inout) :: rod
    real(dp) :: product, first, second, factor
    integer :: i, j
    do i = 1, rod%n_bending
      do j = 1, rod%n_bending
        product = merge(0.5_dp, 0.0_dp, i == j)
        first = 0.5_dp*(moment_1(i - j) + moment_1(i + j))
        second = 0.5_dp*(moment_2(i - j) + moment_2(i + j))
        factor = i*j*pi**2/rod%length
        rod%p(i, j) = factor*(rod%shank_mass*(product - first) + rod%end_mass*product)
        rod%q(i, j) = factor*rod%length*(0.5_dp*rod%shank_mass*(product - second) + rod%end_mass*product)
      end do
    end do
  end subroutine find_foreshortening

  !> Integral of x cos(m pi x) over [0, 1].
  pure real(dp) function moment_1(m)
    integer, intent(in) :: m
    moment_1 = 0.5_dp
    if (m /= 0) moment_1 = ((-1)**m - 1)/(m*pi)**2
  end function moment_1

  !> Integral of x^2 cos(m pi x) over [0, 1].
  pure real(dp) function moment_2(m)
    integer, intent(in) :: m
    moment_2 = 1.0_dp/3
    if (m /= 0) moment_2 = 2*(-1)**m/(m*pi)**2
  end function moment_2

  !> Constants of the axial shapes.
  pure subroutine find_axial(rod)
    class(elastic_rod_t), intent(inout) :: rod
    real(dp) :: factor(most_of_a_kind, most_of_a_kind)
    logical :: definite
    integer :: j
    if (rod%n_axial == 0) return
    associate (m => rod%shank_mass, l => rod%length, first => rod%n_bending + 1, na => rod%n_axial)
      rod%z0(1) = 0.5_dp*m + rod%end_mass
      rod%z1(1) = m*l/3 + rod%end_mass*l
      rod%axial_mass(1, 1) = m/3 + rod%end_mass
      rod%coupling(1, :rod%n_bending) = rod%t(:rod%n_bending)/l
      rod%stiffness(first) = rod%youngs_modulus*rod%section_area/l
      do j = 2, na
        rod%z0(j) = rod%s(j - 1)
        rod%z1(j) = rod%t(j - 1)
        rod%axial_mass(j, j) = 0.5_dp*m
        rod%axial_mass(1, j) = rod%t(j - 1)/l
        rod%axial_mass(j, 1) = rod%axial_mass(1, j)
        rod%coupling(j, j - 1) = 0.5_dp*m
        rod%stiffness(rod%n_bending + j) = rod%stiffness(first)*0.5_dp*((j - 1)*pi)**2
      end do
      do j = 1, na
        rod%damping(rod%n_bending + j) = 2*rod%axial_damping_ratio*sqrt(rod%stiffness(rod%n_bending + j)*rod%axial_mass(j, j))
      end do
    end associate
    factor = rod%axial_mass
    call factorise_cholesky(rod%n_axial, factor, definite)   ! always definite, since the shapes are linearly independent
    if (.not. definite) return
    rod%axial_inverse = 0
    do j = 1, rod%n_axial
      rod%axial_inverse(j, j) = 1
      call solve_cholesky(rod%n_axial, factor, rod%axial_inverse(:, j))
    end do
  end subroutine find_axial

  !> Set the rod of a motion whose crank, offset and shapes are known: sin A = (R sin q - d - o_y)/l. `reachable` is false if there
  !> is no rod angle, or if the chord differs from the length of the rod by more than `largest_change` of it.
  pure subroutine follow(self, crank_length, axis_offset, motion, reachable)
    class(elastic_rod_t), intent(in) :: self
    real(dp), intent(in) :: crank_length, axis_offset   !! R, d [m]
    type(motion_t), intent(inout) :: motion
    logical, intent(out) :: reachable
    associate (n => self%n_bending)
      motion%chord = self%length - sum(self%shortening(:n)*motion%shape(:n)**2)
      motion%chord_rate = -2*sum(self%shortening(:n)*motion%shape(:n)*motion%shape_rate(:n))
      if (self%n_axial > 0) then
        motion%chord = motion%chord + motion%shape(n + 1)
        motion%chord_rate = motion%chord_rate + motion%shape_rate(n + 1)
      end if
    end associate
    reachable = abs(motion%chord - self%length) < largest_change*self%length
    if (.not. reachable) return
    motion%sin_rod = (crank_length*motion%sin_crank - axis_offset - motion%offset(2))/motion%chord
    reachable = abs(motion%sin_rod) < 1
    if (.not. reachable) return
    motion%cos_rod = sqrt((1 - motion%sin_rod)*(1 + motion%sin_rod))
    motion%rod_speed = (crank_length*motion%cos_crank*motion%crank_speed - motion%offset_rate(2) &
      - motion%chord_rate*motion%sin_rod)/(motion%chord*motion%cos_rod)
    associate (n => self%n_bending)
      motion%turning(body_big_end:body_small_end) = matmul(motion%shape_rate(:n), self%slope(:n, :)) - motion%rod_speed
    end associate
  end subroutine follow

  !> Set the piston of a motion whose crank and rod are known.
  pure subroutine follow_piston(self, crank_length, motion)
    class(elastic_rod_t), intent(in) :: self
    real(dp), intent(in) :: crank_length   !! R [m]
    type(motion_t), intent(inout) :: motion
    motion%piston_position = crank_length*motion%cos_crank + motion%chord*motion%cos_rod - motion%offset(1)
    motion%piston_velocity = -crank_length*motion%sin_crank*motion%crank_speed + motion%chord_rate*motion%cos_rod &
      - motion%chord*motion%sin_rod*motion%rod_speed - motion%offset_rate(1)
  end subroutine follow_piston

  !> Natural frequency of one shape without the others [rad/s]; for bending of the shank on two pins (k pi/L)^2 sqrt(E I L/m_b).
  pure real(dp) function natural_frequency(self, shape)
    class(elastic_rod_t), intent(in) :: self
    integer, intent(in) :: shape
    real(dp) :: mass
    mass = self%bending_mass
    if (shape > self%n_bending) mass = self%axial_mass(shape - self%n_bending, shape - self%n_bending)
    natural_frequency = sqrt(self%stiffness(shape)/mass)
  end function natural_frequency

  !> Lowest natural frequency of bending between two fixed pins [rad/s]; 0: the rod does not bend.
  pure real(dp) function bending_frequency(self)
    class(elastic_rod_t), intent(in) :: self
    bending_frequency = 0
    if (self%n_bending > 0) bending_frequency = self%natural_frequency(1)
  end function bending_frequency

  !> Lowest natural frequency of axial vibration with a mass on the piston pin and a fixed crank pin [rad/s], by power iteration; 0:
  !> the rod does not stretch.
  pure real(dp) function axial_frequency(self, mass)
    class(elastic_rod_t), intent(in) :: self
    real(dp), intent(in) :: mass   !! [kg]
    real(dp) :: inertia(self%n_axial, self%n_axial), shape(self%n_axial), largest
    integer :: i
    integer, parameter :: iterations = 100   !! each reduces the part of the other modes by (second/first frequency)^2 > 3
    axial_frequency = 0
    if (self%n_axial == 0) return
    inertia = self%axial_mass(:self%n_axial, :self%n_axial)
    inertia(1, 1) = inertia(1, 1) + mass
    shape = 0
    shape(1) = 1
    do i = 1, iterations
      shape = matmul(inertia, shape)/self%stiffness(self%n_bending + 1:self%n)
      largest = norm2(shape)
      shape = shape/largest
    end do
    axial_frequency = 1/sqrt(largest)
  end function axial_frequency

  !> Deflection perpendicular to the chord half way between the pins [m], positive towards +y in a rod that points along +x, from
  !> the amplitudes of the shapes [m]; its rate [m/s] from theirs.
  pure real(dp) function mid_deflection(self, shape)
    class(elastic_rod_t), intent(in) :: self
    real(dp), intent(in) :: shape(:)
    integer :: k
    mid_deflection = 0
    do k = 1, self%n_bending, 2
      mid_deflection = mid_deflection + shape(k)*(-1)**(k/2)
    end do
  end function mid_deflection

  !> Elastic energy of bending and extension [J].
  pure real(dp) function strain_energy(self, motion)
    class(elastic_rod_t), intent(in) :: self
    type(motion_t), intent(in) :: motion
    strain_energy = 0.5_dp*sum(self%stiffness(:self%n)*motion%shape(:self%n)**2)
  end function strain_energy

  !> Power of the damping on the rod [W], <= 0.
  pure real(dp) function damping_power(self, motion)
    class(elastic_rod_t), intent(in) :: self
    type(motion_t), intent(in) :: motion
    damping_power = -sum(self%damping(:self%n)*motion%shape_rate(:self%n)**2)
  end function damping_power
end module elastic_rod
