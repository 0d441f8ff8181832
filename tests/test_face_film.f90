!> The film between a face of a piston's skirt and its bore: states of an independent program, closed forms with their order,
!> losses, symmetry.
module test_face_film
  use kinds, only: dp
  use constants, only: pi, degree
  use checks, only: checks_t
  use data_tables, only: load_table
  use random_numbers, only: random_numbers_t
  use face_film, only: face_film_t, face_motion_t, face_loads_t, face_springs_t, faces_t, no_loads
  implicit none
  private
  public :: run_test_face_film

contains

  subroutine run_test_face_film(check)
    class(checks_t), intent(inout) :: check
    call states_of_another_program(check)
    call a_rectangle_is_squeezed(check)
    call a_plane_slides(check)
    call losses_are_positive(check)
    call slopes_are_those_of_loads(check)
    call springs_balance(check)
    call soft_springs_balance(check)
    call slopes_of_springs(check)
  end subroutine run_test_face_film

  !> One of the skirts of data/film/skirt_states.csv.
  subroutine make(number, is_gumbel, film)
    integer, intent(in) :: number
    logical, intent(in) :: is_gumbel
    type(face_film_t), intent(out) :: film
    real(dp), parameter :: sizes(6, 4) = reshape([45.0_dp, 40e-6_dp, 20e-6_dp, 0.0_dp, 8e-3_dp, 1e-6_dp, &
      45.0_dp, 22e-6_dp, 20e-6_dp, 0.0_dp, 10e-3_dp, 0.6e-6_dp, 45.0_dp, 60e-6_dp, 35e-6_dp, 0.0_dp, 6e-3_dp, 1.5e-6_dp, &
      35.0_dp, 35e-6_dp, 15e-6_dp, 60e-6_dp, 8e-3_dp, 1e-6_dp], [6, 4])
    film%radius = 0.0424_dp
    film%height = [6e-3_dp, -39e-3_dp]
    film%widest = -16.5e-3_dp
    film%half_angle = sizes(1, number)*degree
    film%clearance = sizes(2, number)
    film%barrel = sizes(3, number)
    film%ovality = sizes(4, number)
    film%viscosity = sizes(5, number)
    film%cuts_suction = is_gumbel
    associate (rough => film%asperities)
      rough%roughness = sizes(6, number)
      rough%density_product = 0.05_dp
      rough%sharpness = 0.01_dp
      rough%integral = 'exact'
      rough%youngs_modulus = [70e9_dp, 120e9_dp]
      rough%poissons_ratio = [0.33_dp, 0.26_dp]
      rough%coefficient = 0.1_dp
      rough%transition_speed = 0.01_dp
    end associate
    call film%prepare()
  end subroutine make

  !> Loads of both faces on the grid of the independent program. Its states have eight digits, which is 4e-7 of the largest force
  !> and moment, and 4e-6 of a film of 0.5 um.
  subroutine states_of_another_program(check)
    class(checks_t), intent(inout) :: check
    character(len=40), allocatable :: names(:)
    real(dp), allocatable :: rows(:, :)
    ! of each column, in its unit
    real(dp), parameter :: allowed(7) = [1e-3_dp, 2e-5_dp, 1e-5_dp, 1e-4_dp, 2e-12_dp, 2.0_dp, 5e-3_dp]
    real(dp) :: found(7)
    type(face_film_t) :: film
    type(face_loads_t) :: loads
    type(face_motion_t) :: motion
    integer :: i, k
    call load_table('film/skirt_states.csv', names, rows)
    do i = 1, size(rows, 2)
      call make(nint(rows(1, i)), rows(2, i) > 0.5_dp, film)
      motion = face_motion_t(rows(3, i), rows(4, i), rows(5, i), rows(6, i), rows(7, i))
      loads = no_loads
      call film%find_loads(1, motion, loads)
      call film%find_loads(-1, motion, loads)
      found = [loads%force, loads%moment, loads%friction, power(loads, motion), loads%least_gap, loads%pressure, loads%asperities]
      do k = 1, size(found)
        call check%close_to(found(k), rows(7 + k, i), allowed(k) + 3e-6_dp*abs(rows(7 + k, i)), 'skirt: '//trim(names(7 + k)))
      end do
    end do
  end subroutine states_of_another_program

  !> Power that the loads take from the piston [W].
  pure real(dp) function power(loads, motion)
    type(face_loads_t), intent(in) :: loads
    type(face_motion_t), intent(in) :: motion
    power = -(loads%force*motion%offset_rate + loads%moment*motion%tilt_rate + loads%friction*motion%velocity)
  end function power

  !> A flat face of width a and length b = 40 mm that approaches at a speed V: the load of the series, with an error of second order
  !> in the size of the cells.
  subroutine a_rectangle_is_squeezed(check)
    class(checks_t), intent(inout) :: check
    real(dp), parameter :: ratio(3) = [1.0_dp, 1.5_dp, 3.0_dp], load(3) = [0.03514425374_dp, 0.04894017722_dp, 0.06582923275_dp]
    real(dp), parameter :: length = 0.04_dp, gap = 20e-6_dp, speed = 0.1_dp, mu = 0.01_dp
    real(dp) :: miss(2)
    type(face_film_t) :: film
    type(face_loads_t) :: loads
    integer :: i, k
    do i = 1, size(ratio)
      do k = 1, 2
        film = flat(ratio(i)*length, length, gap, mu)
        film%around = 6*k
        film%along = 24*k
        call film%prepare()
        loads = no_loads
        call film%find_loads(1, face_motion_t(0.0_dp, 0.0_dp, speed, 0.0_dp, 0.0_dp), loads)
        miss(k) = -loads%force/(12*mu*speed*ratio(i)*length**4/gap**3)/load(i) - 1
      end do
      call check%close_to(miss(2), 0.0_dp, 6e-3_dp, 'skirt: squeeze of a rectangle')
      call check%close_to(miss(1)/miss(2), 4.0_dp, 0.6_dp, 'skirt: squeeze of a rectangle, order of the error')
    end do
  end subroutine a_rectangle_is_squeezed

  !> A flat, smooth face, a part of a cylinder of a large radius.
  type(face_film_t) function flat(width, length, gap, viscosity) result(film)
    real(dp), intent(in) :: width, length, gap, viscosity
    film%half_angle = 1e-5_dp
    film%radius = 0.5_dp*width/film%half_angle
    film%height = [0.5_dp*length, -0.5_dp*length]
    film%clearance = gap
    film%viscosity = viscosity
    film%asperities%roughness = 1e-12_dp
    film%asperities%integral = 'exact'
    film%asperities%youngs_modulus = 1e11_dp
    film%asperities%transition_speed = 1
  end function flat

  !> A wide plane slider: load, friction of the wall, and centre of pressure from the thick end, in closed form (Rayleigh), for
  !> gaps at the ends in the ratios K; the grid is within 3e-3. The wall takes the opposite of the friction on the face.
  subroutine a_plane_slides(check)
    class(checks_t), intent(inout) :: check
    real(dp), parameter :: k(3) = [1.5_dp, 2.1887_dp, 4.0_dp], &
      load(3) = [0.131162594596_dp, 0.160243141338_dp, 0.124196240747_dp], &
      friction(3) = [0.843720864865_dp, 0.75420220052_dp, 0.648392481493_dp], &
      centre(3) = [0.54042006_dp, 0.577429145_dp, 0.63378718_dp]
    real(dp), parameter :: length = 0.045_dp, width = 1e3_dp*length, thin = 10e-6_dp, speed = 8, mu = 0.01_dp
    type(face_film_t) :: film
    type(face_loads_t) :: loads
    type(face_motion_t) :: motion
    integer :: i, side
    real(dp) :: at
    do i = 1, size(k)
      do side = -1, 1, 2
        film = flat(width, length, 0.5_dp*(1 + k(i))*thin, mu)
        call film%prepare()
        motion = face_motion_t(0.0_dp, -side*(k(i) - 1)*thin/length, 0.0_dp, 0.0_dp, speed)   ! moves up, and opens upwards
        loads = no_loads
        call film%find_loads(side, motion, loads)
        call check%close_to(-side*loads%force/(mu*speed*length**2/thin**2*width), load(i), 5e-3_dp*load(i), &
          'skirt: load of a slider')
        call check%close_to(-loads%friction/(mu*speed*length/thin*width), friction(i), 1e-3_dp*friction(i), &
          'skirt: friction of a slider')
        at = (loads%moment + side*film%radius*loads%friction)/loads%force   ! height of the centre of pressure
        call check%close_to(0.5_dp - at/length, centre(i), 2e-3_dp, 'skirt: centre of pressure of a slider')
      end do
    end do
  end subroutine a_plane_slides

  !> In random states the loads of both faces never give power to the piston between smooth walls, and the mirror image of a state
  !> has the mirror image of its loads.
  subroutine losses_are_positive(check)
    class(checks_t), intent(inout) :: check
    type(face_film_t) :: film
    type(face_loads_t) :: loads, mirrored
    type(face_motion_t) :: motion
    type(random_numbers_t) :: random
    real(dp) :: least, unlike, u(5)
    integer :: i, k
    least = huge(least)
    unlike = 0
    call random%begin(7)
    do i = 1, 2000
      call make(1 + mod(i, 4), mod(i, 3) == 0, film)
      do k = 1, size(u)
        call random%uniform(u(k))
      end do
      u = (2*u - 1)*[20e-6_dp, 3e-4_dp, 0.1_dp, 5.0_dp, 15.0_dp]
      motion = face_motion_t(u(1), u(2), u(3), u(4), u(5))
      if (film%least_relief_gap(motion%offset, motion%tilt) < 9*film%asperities%roughness) cycle
      loads = no_loads
      mirrored = no_loads
      call film%find_loads(1, motion, loads)
      call film%find_loads(-1, motion, loads)
      call film%find_loads(1, face_motion_t(-u(1), -u(2), -u(3), -u(4), u(5)), mirrored)
      call film%find_loads(-1, face_motion_t(-u(1), -u(2), -u(3), -u(4), u(5)), mirrored)
      least = min(least, power(loads, motion))
      unlike = max(unlike, abs(loads%force + mirrored%force)/(abs(loads%force) + 1), &
        abs(loads%friction - mirrored%friction)/(abs(loads%friction) + 1))
    end do
    call check%that(least >= 0, 'skirt: no state gives power')
    call check%close_to(unlike, 0.0_dp, 1e-10_dp, 'skirt: mirror image')
  end subroutine losses_are_positive

  !> Slopes of force, moment and friction against differences of the loads on both sides of each state of another program; where the
  !> part of a face that is full changes the loads have a kink, and the slopes are those of one side. Differences of loads with
  !> these steps have errors of up to 4e-6 of the largest slope, by rounding and by curvature.
  subroutine slopes_are_those_of_loads(check)
    class(checks_t), intent(inout) :: check
    character(len=*), parameter :: motions(5) = [character(len=11) :: 'offset', 'tilt', 'offset rate', 'tilt rate', 'velocity']
    real(dp), parameter :: step(5) = [1e-12_dp, 1e-10_dp, 1e-7_dp, 1e-5_dp, 1e-5_dp]
    character(len=40), allocatable :: names(:)
    real(dp), allocatable :: rows(:, :)
    type(face_film_t) :: film
    real(dp) :: slopes(3, 5), unused(3, 5), here(3), there(3), back(3), size_of(3, 5), worst(3, 5)
    integer :: i, k
    call load_table('film/skirt_states.csv', names, rows)
    size_of = 0
    worst = 0
    do i = 1, size(rows, 2)
      call make(nint(rows(1, i)), rows(2, i) > 0.5_dp, film)
      slopes = 0
      unused = 0
      here = loads_at(rows(3:7, i), slopes)
      do k = 1, 5
        size_of(:, k) = max(size_of(:, k), abs(slopes(:, k)))
        there = loads_at(moved(rows(3:7, i), k, step(k)), unused)
        back = loads_at(moved(rows(3:7, i), k, -step(k)), unused)
        worst(:, k) = max(worst(:, k), min(abs((there - here)/step(k) - slopes(:, k)), abs((here - back)/step(k) - slopes(:, k))))
      end do
    end do
    do k = 1, 5
      call check%close_to(maxval(worst(:, k)/size_of(:, k)), 0.0_dp, 1e-5_dp, 'skirt: slopes by the '//trim(motions(k)))
    end do

  contains

    function loads_at(at, slopes_there) result(found)
      real(dp), intent(in) :: at(5)
      real(dp), intent(inout) :: slopes_there(3, 5)
      real(dp) :: found(3)
      type(face_loads_t) :: loads
      loads = no_loads
      call film%find_loads(1, face_motion_t(at(1), at(2), at(3), at(4), at(5)), loads, slopes_there)
      call film%find_loads(-1, face_motion_t(at(1), at(2), at(3), at(4), at(5)), loads, slopes_there)
      found = [loads%force, loads%moment, loads%friction]
    end function loads_at

    pure function moved(at, k, by)
      real(dp), intent(in) :: at(5), by
      integer, intent(in) :: k
      real(dp) :: moved(5)
      moved = at
      moved(k) = at(k) + by
    end function moved
  end subroutine slopes_are_those_of_loads

  !> A random state of an elastic skirt with smooth walls far enough from each other, which has the springs of its faces.
  subroutine draw(random, film, motion, springs, is_smooth)
    type(random_numbers_t), intent(inout) :: random
    type(face_film_t), intent(in) :: film
    type(face_motion_t), intent(out) :: motion
    type(face_springs_t), intent(out) :: springs(2)
    logical, intent(out) :: is_smooth
    real(dp) :: u(10)
    integer :: k
    do k = 1, size(u)
      call random%uniform(u(k))
    end do
    u(:5) = (2*u(:5) - 1)*[20e-6_dp, 3e-4_dp, 0.1_dp, 5.0_dp, 15.0_dp]
    motion = face_motion_t(u(1), u(2), u(3), u(4), u(5))
    springs = face_springs_t(10**(6 + 4*u(6)), [0.0_dp, 0.0_dp], [0.0_dp, 0.0_dp])
    springs(1)%deflection = 2e-5_dp*u(7:8)
    springs(2)%deflection = 2e-5_dp*u(9:10)
    is_smooth = film%least_elastic_gap(motion%offset, motion%tilt, springs) > 9*film%asperities%roughness
  end subroutine draw

  !> Loads of both elastic faces, and what they and their springs take from the piston [W].
  subroutine load_faces(film, motion, springs, loads, taken)
    type(face_film_t), intent(in) :: film
    type(face_motion_t), intent(in) :: motion
    type(face_springs_t), intent(inout) :: springs(2)
    type(face_loads_t), intent(out) :: loads
    real(dp), intent(out) :: taken
    integer :: k
    loads = no_loads
    taken = 0
    do k = 1, 2
      call film%find_loads(3 - 2*k, motion, loads, springs=springs(k))
      taken = taken - springs(k)%stiffness*dot_product(springs(k)%deflection, springs(k)%rate)
    end do
    taken = taken + power(loads, motion)
  end subroutine load_faces

  !> In random states what elastic faces take beyond the energy of their springs is what pressure flow, shear and the drag of the
  !> springs dissipate, summed over the grid from gaps that are computed here, or more where suction is cut off; no spring is drawn
  !> to the wall; the mirror image of a state has the mirror image of its loads.
  subroutine springs_balance(check)
    class(checks_t), intent(inout) :: check
    type(face_film_t) :: film
    type(face_loads_t) :: loads, mirrored
    type(face_motion_t) :: motion, mirror
    type(face_springs_t) :: springs(2), turned(2)
    type(faces_t) :: faces
    type(random_numbers_t) :: random
    real(dp) :: taken, other, lost, size, unlike, unbalanced, least
    integer :: i, n
    logical :: is_smooth
    unlike = 0
    unbalanced = 0
    least = 0
    n = 0
    call random%begin(11)
    do i = 1, 3000
      call make(1 + mod(i, 4), mod(i, 3) == 0, film)
      call draw(random, film, motion, springs, is_smooth)
      if (.not. is_smooth) cycle
      n = n + 1
      call load_faces(film, motion, springs, loads, taken)
      call film%field(motion, faces, springs)
      lost = dissipation(film, motion, springs, faces)
      if (film%cuts_suction) lost = max(lost, taken)   ! at the edges of what is cut off more is lost than these pressures tell
      size = lost + abs(loads%force*motion%offset_rate) + abs(loads%moment*motion%tilt_rate) + springs(1)%stiffness* &
        sum(abs(springs(1)%deflection*springs(1)%rate) + abs(springs(2)%deflection*springs(2)%rate))
      unbalanced = max(unbalanced, abs(taken - lost)/size)
      least = min(least, minval([springs(1)%deflection + 1e-5_dp*springs(1)%rate, &
        springs(2)%deflection + 1e-5_dp*springs(2)%rate]))
      mirror = face_motion_t(-motion%offset, -motion%tilt, -motion%offset_rate, -motion%tilt_rate, motion%velocity)
      turned = springs([2, 1])
      call load_faces(film, mirror, turned, mirrored, other)
      unlike = max(unlike, abs(loads%force + mirrored%force)/(abs(loads%force) + 1), abs(other - taken)/(abs(taken) + 1), &
        maxval(abs(turned(1)%rate - springs(2)%rate))/(maxval(abs(springs(2)%rate)) + 1e-6_dp))
    end do
    call check%that(n > 500, 'elastic skirt: states')
    call check%close_to(unbalanced, 0.0_dp, 5e-12_dp, 'elastic skirt: power against dissipation on the grid')
    call check%close_to(unlike, 0.0_dp, 1e-10_dp, 'elastic skirt: mirror image')
    call check%that(least >= -1e-18_dp, 'elastic skirt: no spring is drawn to the wall')
  end subroutine springs_balance

  !> Extreme skirts on soft springs, smooth and rough, whose film at rest would have up to 1e13 times the pressure that is left: in
  !> 4000 faces for each condition the springs balance within 1e-8 of what loads them, by sums over the field. (Steps that end where
  !> a node changes, without the turns of the path, left 2 % of those with suction cut off unbalanced, and said nothing.)
  subroutine soft_springs_balance(check)
    class(checks_t), intent(inout) :: check
    type(face_film_t) :: film
    type(face_motion_t) :: motion
    type(face_springs_t) :: springs(2)
    type(faces_t) :: faces
    type(random_numbers_t) :: random
    real(dp) :: worst(2)
    integer :: faces_of(2), said(2), k, is_gumbel
    worst = 0
    faces_of = 0
    said = 0
    call random%begin(18)
    do while (any(faces_of < 4000))
      call draw_soft(random, film, motion, springs)
      if (film%least_elastic_gap(motion%offset, motion%tilt, springs) < 0) cycle
      is_gumbel = merge(1, 2, film%cuts_suction)
      faces_of(is_gumbel) = faces_of(is_gumbel) + 2
      call film%field(motion, faces, springs)
      do k = 1, 2
        if (.not. springs(k)%balance) said(is_gumbel) = said(is_gumbel) + 1
        if (springs(k)%balance) worst(is_gumbel) = max(worst(is_gumbel), missed(film, springs, faces, k))
      end do
    end do
    call check%close_to(worst(1), 0.0_dp, 1e-8_dp, 'soft skirt: springs balance, suction cut off')
    call check%close_to(worst(2), 0.0_dp, 1e-8_dp, 'soft skirt: springs balance, Reynolds')
    call check%that(said(1) == 0, 'soft skirt: rates are found, suction cut off')
    call check%that(said(2) == 0, 'soft skirt: rates are found, Reynolds')
  end subroutine soft_springs_balance

  !> A random state of a random skirt on soft springs.
  subroutine draw_soft(random, film, motion, springs)
    type(random_numbers_t), intent(inout) :: random
    type(face_film_t), intent(out) :: film
    type(face_motion_t), intent(out) :: motion
    type(face_springs_t), intent(out) :: springs(2)
    real(dp) :: u(27), stiffness, length
    integer :: k
    do k = 1, size(u)
      call random%uniform(u(k))
    end do
    film%radius = spread_over(u(1), 1e-2_dp, 0.2_dp)
    film%height = [spread_over(u(2), 1e-3_dp, 0.2_dp), -spread_over(u(3), 1e-3_dp, 0.2_dp)]
    film%widest = 0.5_dp*sum(film%height)
    film%half_angle = (5 + 80*u(4))*degree
    film%clearance = spread_over(u(5), 1e-6_dp, 1e-3_dp)
    if (u(6) > 0.4_dp) film%barrel = film%clearance*spread_over(u(7), 1e-2_dp, 10.0_dp)
    if (u(8) > 0.4_dp) film%ovality = film%clearance*spread_over(u(9), 1e-2_dp, 10.0_dp)
    film%viscosity = spread_over(u(10), 1e-4_dp, 1.0_dp)
    film%cuts_suction = u(11) > 0.5_dp
    film%around = 3 + int(4*u(12))
    film%along = 8 + 8*int(3*u(13))
    associate (rough => film%asperities)
      rough%roughness = film%clearance*spread_over(u(14), 1e-3_dp, 0.5_dp)
      rough%density_product = spread_over(u(15), 1e-3_dp, 1.0_dp)
      rough%sharpness = spread_over(u(16), 1e-4_dp, 1.0_dp)
      rough%integral = 'exact'
      rough%youngs_modulus = [70e9_dp, 120e9_dp]
      rough%poissons_ratio = [0.33_dp, 0.26_dp]
      rough%transition_speed = 0.01_dp
    end associate
    call film%prepare()
    length = film%height(1) - film%height(2)
    motion%offset = film%clearance*(2*u(17) - 1)
    motion%tilt = 2*film%clearance/length*(2*u(18) - 1)
    motion%offset_rate = spread_over(u(19), 1e-5_dp, 3.0_dp)*sign(1.0_dp, u(20) - 0.5_dp)
    motion%tilt_rate = spread_over(u(21), 1e-5_dp, 3.0_dp)/length*(2*u(20) - 1)
    motion%velocity = spread_over(u(22), 1e-2_dp, 30.0_dp)*sign(1.0_dp, u(18) - 0.5_dp)
    stiffness = spread_over(u(23), 1e3_dp, 3e5_dp)
    springs(1) = face_springs_t(stiffness, film%clearance*u(24:25)**2, [0.0_dp, 0.0_dp])
    springs(2) = face_springs_t(stiffness, film%clearance*u(26:27)**2, [0.0_dp, 0.0_dp])
  end subroutine draw_soft

  !> A number between two others, uniform in its logarithm, from one between 0 and 1.
  pure real(dp) function spread_over(u, low, high)
    real(dp), intent(in) :: u, low, high
    spread_over = low*(high/low)**u
  end function spread_over

  !> What the springs of face k miss of their balance, over what loads them.
  real(dp) function missed(film, springs, faces, k)
    type(face_film_t), intent(in) :: film
    type(face_springs_t), intent(in) :: springs(2)
    type(faces_t), intent(in) :: faces
    integer, intent(in) :: k
    real(dp) :: left(2), load(2), share, area, pressure
    integer :: i, j, m
    associate (it => springs(k), z => faces%height)
      left = -it%stiffness*(it%deflection + 1e-5_dp*it%rate)
      load = it%stiffness*(abs(it%deflection) + 1e-5_dp*abs(it%rate))
      m = size(z)
      do j = 1, m
        share = (z(j) - film%height(2))/(film%height(1) - film%height(2))
        area = film%radius*film%half_angle/film%around*(z(min(j + 1, m)) - z(max(j - 1, 1)))
        do i = 1, film%around
          pressure = faces%pressure(i, j, k)
          if (faces%gap(i, j, k) < 8*film%asperities%roughness) pressure = pressure + &
            film%asperities%pressure(-faces%gap(i, j, k), 0.0_dp)
          left = left + [share, 1 - share]*area*cos(faces%angle(i))*pressure
          load = load + [share, 1 - share]*area*cos(faces%angle(i))*pressure
        end do
      end do
    end associate
    missed = maxval(abs(left))/maxval(load)
  end function missed

  !> What shear, pressure flow and drag of the springs dissipate between smooth walls [W].
  real(dp) function dissipation(film, motion, springs, faces) result(lost)
    type(face_film_t), intent(in) :: film
    type(face_motion_t), intent(in) :: motion
    type(face_springs_t), intent(in) :: springs(2)
    type(faces_t), intent(in) :: faces
    real(dp) :: wide, step, speed, width, beyond
    integer :: i, j, k, n, m
    n = size(faces%angle)
    m = size(faces%height)
    wide = film%half_angle/n
    step = film%radius*wide
    lost = 0
    do k = 1, 2
      speed = motion%velocity - (3 - 2*k)*film%radius*sin(film%half_angle)/film%half_angle*motion%tilt_rate
      lost = lost + 1e-5_dp*springs(k)%stiffness*sum(springs(k)%rate**2)
      associate (z => faces%height, p => faces%pressure(:, :, k))
        do i = 1, n
          do j = 1, m
            width = 0.5_dp*(z(min(j + 1, m)) - z(max(j - 1, 1)))
            lost = lost + 2*film%viscosity*speed**2/gap(faces%angle(i), z(j))*step*width
            if (j == 1) cycle
            lost = lost + 2*gap(faces%angle(i), 0.5_dp*(z(j - 1) + z(j)))**3/(12*film%viscosity)*step/(z(j) - z(j - 1))* &
              (p(i, j) - p(i, j - 1))**2
            if (j == m) cycle
            beyond = 0
            if (i < n) beyond = p(i + 1, j)
            lost = lost + 2*merge(1, 2, i < n)*gap(faces%angle(i) + 0.5_dp*wide, z(j))**3/(12*film%viscosity)*width/step* &
              (p(i, j) - beyond)**2
          end do
        end do
      end associate
    end do

  contains

    real(dp) function gap(angle, height)
      real(dp), intent(in) :: angle, height
      real(dp) :: share
      associate (z => film%height)
        share = (height - z(2))/(z(1) - z(2))
        gap = film%clearance + film%barrel*(2*(height - film%widest)/(z(1) - z(2)))**2 + film%ovality*sin(angle)**2 + cos(angle)* &
          (dot_product(springs(k)%deflection, [share, 1 - share]) - (3 - 2*k)*(motion%offset + height*motion%tilt))
      end associate
    end function gap
  end function dissipation

  !> Slopes of the loads of elastic faces and of the rates of their springs, by the motion of the piston and by deflections, against
  !> differences on both sides, as for rigid faces.
  subroutine slopes_of_springs(check)
    class(checks_t), intent(inout) :: check
    real(dp), parameter :: step(7) = [1e-12_dp, 1e-10_dp, 1e-7_dp, 1e-5_dp, 1e-5_dp, 1e-12_dp, 1e-12_dp]
    type(face_film_t) :: film
    type(face_motion_t) :: motion
    type(face_springs_t) :: springs(2)
    type(random_numbers_t) :: random
    real(dp) :: own(3, 5), of_loads(3, 7), of_rates(2, 7), at(7), here(5), change(5, 2), slopes(5), size_of(5, 7), worst(5, 7)
    integer :: i, k, side
    logical :: is_smooth
    size_of = 0
    worst = 0
    call random%begin(13)
    do i = 1, 400
      call make(1 + mod(i, 4), mod(i, 3) == 0, film)
      call draw(random, film, motion, springs, is_smooth)
      if (film%least_elastic_gap(motion%offset, motion%tilt, springs) < 0) cycle
      springs%stiffness = 5e7_dp
      side = merge(1, -1, mod(i, 2) == 0)
      at = [motion%offset, motion%tilt, motion%offset_rate, motion%tilt_rate, motion%velocity, springs(1)%deflection]
      own = 0
      here = found(at, own)
      call film%panel_slopes(side, springs(1)%stiffness, own, of_loads, of_rates)
      do k = 1, size(step)
        slopes = [of_loads(:, k), of_rates(:, k)]
        size_of(:, k) = max(size_of(:, k), abs(slopes))
        change(:, 1) = (found(moved(k, step(k)), own) - here)/step(k) - slopes
        change(:, 2) = (here - found(moved(k, -step(k)), own))/step(k) - slopes
        worst(:, k) = max(worst(:, k), minval(abs(change), dim=2))
      end do
    end do
    do k = 1, size(step)
      call check%close_to(maxval(worst(:, k)/size_of(:, k)), 0.0_dp, 1e-4_dp, 'elastic skirt: slopes')
    end do

  contains

    function moved(k, by)
      integer, intent(in) :: k
      real(dp), intent(in) :: by
      real(dp) :: moved(7)
      moved = at
      moved(k) = at(k) + by
    end function moved

    !> Loads of the face and rates of its springs.
    function found(at, own)
      real(dp), intent(in) :: at(7)
      real(dp), intent(inout) :: own(3, 5)
      real(dp) :: found(5)
      type(face_loads_t) :: loads
      type(face_springs_t) :: these
      loads = no_loads
      these = face_springs_t(springs(1)%stiffness, at(6:), [0.0_dp, 0.0_dp])
      call film%find_loads(side, face_motion_t(at(1), at(2), at(3), at(4), at(5)), loads, own, these)
      found = [loads%force, loads%moment, loads%friction, these%rate]
    end function found
  end subroutine slopes_of_springs
end module test_face_film
