!> Natural frequencies and shapes of a torsional chain: stations with inertias, segments between neighbours, and further inertias on
!> single stations (rings of dampers). Undamped; the smallest frequencies are exact to 1e-12 of the largest.
module torsional_modes
  use kinds, only: dp
  implicit none
  private
  public :: find_modes

contains

  !> Frequencies [rad/s], rising, without that of a free rotation of the whole chain, and shapes whose largest element is 1: of the
  !> stations, then of the rings. An inertia of a station that is held does not matter.
  subroutine find_modes(inertia, stiffness, ring_station, ring_inertia, ring_stiffness, held, frequency, shape)
    real(dp), intent(in) :: inertia(:), stiffness(:)   !! [kg m^2], [N m/rad]; the second has one element less
    integer, intent(in) :: ring_station(:)
    real(dp), intent(in) :: ring_inertia(:), ring_stiffness(:)
    integer, intent(in) :: held                        !! station that does not move; 0: none
    real(dp), allocatable, intent(out) :: frequency(:), shape(:, :)   !! (mode), (body, mode)
    real(dp), allocatable :: matrix(:, :), vectors(:, :), mass(:), values(:)
    integer, allocatable :: moving(:), order(:)
    integer :: i, j, n, bodies
    bodies = size(inertia) + size(ring_inertia)
    allocate (matrix(bodies, bodies), source=0.0_dp)
    do i = 1, size(stiffness)
      call connect(i, i + 1, stiffness(i))
    end do
    do i = 1, size(ring_inertia)
      call connect(ring_station(i), size(inertia) + i, ring_stiffness(i))
    end do
    mass = [inertia, ring_inertia]
    moving = pack([(i, i=1, bodies)], [(i /= held, i=1, bodies)])
    n = size(moving)
    matrix = matrix(moving, moving)
    do j = 1, n
      do i = 1, n
        matrix(i, j) = matrix(i, j)/sqrt(mass(moving(i))*mass(moving(j)))
      end do
    end do
    call diagonalise(matrix, values, vectors)
    allocate (order(n))
    call sort(values, order)
    if (held == 0) order = order(2:)
    allocate (frequency(size(order)), shape(bodies, size(order)))
    shape = 0
    do j = 1, size(order)
      frequency(j) = sqrt(max(values(order(j)), 0.0_dp))
      shape(moving, j) = vectors(:, order(j))/sqrt(mass(moving))
      shape(:, j) = shape(:, j)/shape(maxloc(abs(shape(:, j)), 1), j)
    end do

  contains

    subroutine connect(a, b, k)
      integer, intent(in) :: a, b
      real(dp), intent(in) :: k
      matrix(a, a) = matrix(a, a) + k
      matrix(b, b) = matrix(b, b) + k
      matrix(a, b) = matrix(a, b) - k
      matrix(b, a) = matrix(b, a) - k
    end subroutine connect
  end subroutine find_modes

  !> Eigenvalues and eigenvectors of a symmetric matrix, by Jacobi's rotations.
  subroutine diagonalise(a, values, vectors)
    real(dp), intent(inout) :: a(:, :)
    real(dp), allocatable, intent(out) :: values(:), vectors(:, :)
    integer, parameter :: most_sweeps = 60
    real(dp) :: angle, t, c, s, row(size(a, 1)), column(size(a, 1))
    logical :: has_turned
    integer :: sweep, p, q, i, n
    n = size(a, 1)
    allocate (vectors(n, n), source=0.0_dp)
    do i = 1, n
      vectors(i, i) = 1
    end do
    do sweep = 1, most_sweeps
      has_turned = .false.
      do p = 1, n - 1
        do q = p + 1, n
          if (abs(a(p, q)) <= epsilon(1.0_dp)*1e-3_dp*sqrt(abs(a(p, p)*a(q, q)))) cycle
          has_turned = .true.
          angle = (a(q, q) - a(p, p))/(2*a(p, q))
          t = sign(1.0_dp, angle)/(abs(angle) + sqrt(1 + angle**2))
          c = 1/sqrt(1 + t**2)
          s = t*c
          row = a(p, :)
          a(p, :) = c*row - s*a(q, :)
          a(q, :) = s*row + c*a(q, :)
          column = a(:, p)
          a(:, p) = c*column - s*a(:, q)
          a(:, q) = s*column + c*a(:, q)
          a(p, q) = 0
          a(q, p) = 0
          column = vectors(:, p)
          vectors(:, p) = c*column - s*vectors(:, q)
          vectors(:, q) = s*column + c*vectors(:, q)
        end do
      end do
      if (.not. has_turned) exit
    end do
    values = [(a(i, i), i=1, n)]
  end subroutine diagonalise

  !> The order in which values rise.
  pure subroutine sort(values, order)
    real(dp), intent(in) :: values(:)
    integer, allocatable, intent(inout) :: order(:)
    integer :: i, j, moved
    order = [(i, i=1, size(values))]
    do i = 2, size(values)
      moved = order(i)
      j = i - 1
      do while (j >= 1)
        if (values(order(j)) <= values(moved)) exit
        order(j + 1) = order(j)
        j = j - 1
      end do
      order(j + 1) = moved
    end do
  end subroutine sort
end module torsional_modes
