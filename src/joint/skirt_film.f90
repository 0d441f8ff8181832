!> Element of the guide: film between both faces of the skirt and the bore, with the contact of their asperities. Elastic faces have
!> the deflections of their ends as states. See `face_film`.
module skirt_film
  use kinds, only: dp
  use constants, only: degree
  use monotone_cubic, only: new_monotone_cubic
  use trace_row, only: trace_row_t, least, largest, largest_size, mean, of_cycle
  use chain_motion, only: motion_t, tilting_t
  use piston_skirt, only: skirt_t, n_corners, corner_names
  use face_film, only: face_film_t, face_motion_t, face_springs_t, faces_t, no_loads, tangent_found, tangent_acts
  use guide_case, only: guide_case_t
  use guide_element, only: guide_element_t, guide_loads_t, deepest
  implicit none
  private
  public :: skirt_film_t

  type, extends(guide_element_t) :: skirt_film_t
    type(face_film_t) :: film
    real(dp) :: com_height = 0   !! of the centre of mass above the pin, along the piston [m]
    real(dp) :: stiffness = 0    !! of the spring at each end of each face [N/m]; 0: rigid faces
  contains
    procedure :: prepare
    procedure :: find_loads
    procedure :: admits
    procedure :: add_columns
    procedure :: see_faces
    procedure, private :: springs
    procedure, private :: find_film_loads
    procedure, private :: find_elastic_loads
  end type skirt_film_t

contains

  subroutine prepare(self, wanted)
    class(skirt_film_t), intent(inout) :: self
    type(guide_case_t), intent(in) :: wanted
    type(skirt_t) :: skirt
    skirt = wanted%skirt()
    self%com_height = wanted%piston_com(1)
    associate (film => self%film)
      film%radius = skirt%radius
      film%height = skirt%height
      film%clearance = skirt%clearance
      film%half_angle = wanted%half_angle_deg*degree
      film%barrel = wanted%barrel
      film%widest = wanted%widest_height() - wanted%piston_com(1)
      film%ovality = wanted%ovality
      film%viscosity = wanted%film%oil%viscosity()
      if (allocated(wanted%profile%x)) &
        film%profile = new_monotone_cubic(wanted%profile%x - wanted%piston_com(1), wanted%profile%y)
      film%cuts_suction = wanted%film%cuts_suction()
      film%around = wanted%film%oil%around
      film%along = wanted%film%oil%along
      film%asperities = wanted%film%asperities
      call film%prepare()
    end associate
    self%stiffness = wanted%stiffness
    if (.not. self%stiffness > 0) return
    self%n_states = n_corners
    self%state_name = 'skirt_deflection'
    self%state_unit = 'm'
    self%state_scale(:n_corners) = skirt%clearance
  end subroutine prepare

  pure subroutine find_loads(self, skirt, motion, y, now)
    class(skirt_film_t), intent(in) :: self
    type(skirt_t), intent(in) :: skirt
    type(motion_t), intent(in) :: motion
    real(dp), intent(in) :: y(*)
    type(guide_loads_t), intent(inout) :: now
    type(face_motion_t) :: at
    real(dp) :: depth(n_corners), depth_rate(n_corners)
    associate (it => motion%tilting)
      at = face_motion_t(it%offset, it%tilt, it%offset_rate, it%tilt_rate, now%speed)
    end associate
    now%deflection = 0
    now%spring_energy = 0
    now%spring_power = 0
    if (self%stiffness > 0) now%deflection = y(self%states%first:self%states%last)
    if (now%tangent%role == tangent_acts) then
      now%skirt = now%tangent%loads_at(at)
      if (self%stiffness > 0) &
        call now%tangent%yield(at, now%deflection, now%skirt, now%rates(self%rates%first:self%rates%last))
    else if (self%stiffness > 0) then
      call self%find_elastic_loads(at, now)
    else
      call self%find_film_loads(at, now)
    end if
    if (self%stiffness > 0) then
      now%spring_energy = 0.5_dp*self%stiffness*sum(now%deflection**2)
      now%spring_power = self%stiffness*dot_product(now%deflection, now%rates(self%rates%first:self%rates%last))
    end if
    now%force = now%force + now%skirt%force
    now%moment = now%moment + now%skirt%moment
    now%friction_force = now%friction_force + now%skirt%friction
    call self%film%ends(at, depth, depth_rate)
    now%corner%depth = depth - now%deflection
    now%corner%depth_rate = depth_rate
    now%skirt_power = -(now%skirt%force*at%offset_rate + now%skirt%moment*at%tilt_rate + now%skirt%friction*at%velocity) &
      - now%spring_power
  end subroutine find_loads

  !> Loads of the films of both faces, and their tangent if it is wanted.
  pure subroutine find_film_loads(self, at, now)
    class(skirt_film_t), intent(in) :: self
    type(face_motion_t), intent(in) :: at
    type(guide_loads_t), intent(inout) :: now
    integer :: side
    now%skirt = no_loads
    if (now%tangent%role == tangent_found) then
      now%tangent%motion = at
      now%tangent%slopes = 0
      do side = 1, -1, -2
        call self%film%find_loads(side, at, now%skirt, now%tangent%slopes)
      end do
      now%tangent%loads = now%skirt
    else
      do side = 1, -1, -2
        call self%film%find_loads(side, at, now%skirt)
      end do
    end if
  end subroutine find_film_loads

  !> The same of elastic faces, with the rates of their deflections.
  pure subroutine find_elastic_loads(self, at, now)
    class(skirt_film_t), intent(in) :: self
    type(face_motion_t), intent(in) :: at
    type(guide_loads_t), intent(inout) :: now
    type(face_springs_t) :: springs(2)
    real(dp) :: own(3, 5), of_loads(3, 7), of_rates(2, 7)
    integer :: k, side
    now%skirt = no_loads
    springs = self%springs(now%deflection)
    if (now%tangent%role == tangent_found) then
      now%tangent%slopes = 0
      now%tangent%rate_slopes = 0
    end if
    do k = 1, 2
      side = 3 - 2*k
      if (now%tangent%role == tangent_found) then
        own = 0
        call self%film%find_loads(side, at, now%skirt, own, springs(k))
        call self%film%panel_slopes(side, self%stiffness, own, of_loads, of_rates)
        now%tangent%slopes = now%tangent%slopes + of_loads(:, :5)
        now%tangent%by_deflection(:, 2*k - 1:2*k) = of_loads(:, 6:)
        now%tangent%rate_slopes(2*k - 1:2*k, :5) = of_rates(:, :5)
        now%tangent%rate_slopes(2*k - 1:2*k, 4 + 2*k:5 + 2*k) = of_rates(:, 6:)
      else
        call self%film%find_loads(side, at, now%skirt, springs=springs(k))
      end if
      now%rates(self%rates%first + 2*k - 2:self%rates%first + 2*k - 1) = springs(k)%rate
    end do
    now%springs_balance = all(springs%balance)
    if (now%tangent%role /= tangent_found) return
    now%tangent%motion = at
    now%tangent%loads = now%skirt
    now%tangent%deflection = now%deflection
    now%tangent%rate = now%rates(self%rates%first:self%rates%last)
  end subroutine find_elastic_loads

  !> The springs of both faces, with their deflections.
  pure function springs(self, deflection)
    class(skirt_film_t), intent(in) :: self
    real(dp), intent(in) :: deflection(n_corners)
    type(face_springs_t) :: springs(2)
    springs(1) = face_springs_t(self%stiffness, deflection(:2), [0.0_dp, 0.0_dp])
    springs(2) = face_springs_t(self%stiffness, deflection(3:), [0.0_dp, 0.0_dp])
  end function springs

  subroutine see_faces(self, motion, deflection, faces)
    class(skirt_film_t), intent(in) :: self
    type(face_motion_t), intent(in) :: motion
    real(dp), intent(in) :: deflection(n_corners)
    type(faces_t), intent(out) :: faces
    type(face_springs_t) :: springs(2)
    if (self%stiffness > 0) then
      springs = self%springs(deflection)
      call self%film%field(motion, faces, springs)
    else
      call self%film%field(motion, faces)
    end if
    faces%height = faces%height + self%com_height
  end subroutine see_faces

  pure logical function admits(self, y, tilting)
    class(skirt_film_t), intent(in) :: self
    real(dp), intent(in) :: y(*)
    type(tilting_t), intent(in) :: tilting
    real(dp) :: gap
    if (self%stiffness > 0) then
      gap = self%film%least_elastic_gap(tilting%offset, tilting%tilt, self%springs(y(self%states%first:self%states%last)))
    else
      gap = self%film%least_relief_gap(tilting%offset, tilting%tilt)
    end if
    admits = gap > deepest*self%film%asperities%roughness
  end function admits

  pure subroutine add_columns(self, now, row)
    class(skirt_film_t), intent(in) :: self
    type(guide_loads_t), intent(in) :: now
    type(trace_row_t), intent(inout) :: row
    integer :: i
    associate (skirt => now%skirt)
      call row%add('skirt_force[N]', skirt%force, 'force of the bore on the skirt along y, of film and asperities')
      call row%keep('max_skirt_force', largest_size, 'largest force of the bore on the skirt')
      call row%add('skirt_moment[N.m]', skirt%moment, 'moment of film and asperities on the piston about its centre of mass')
      call row%add('skirt_friction_force[N]', skirt%friction, 'friction of the bore on the skirt, along x')
      call row%add('skirt_power[W]', now%skirt_power, 'power that film and asperities take from the piston')
      call row%keep('mean_skirt_power', mean, 'mean power that the film of the skirt takes', told=of_cycle, is_sampled=.true.)
      call row%add('skirt_min_film_thickness[m]', skirt%least_gap, 'smallest gap of both faces')
      call row%keep('min_skirt_film_thickness', least, 'smallest gap between skirt and bore', has_angle=.true.)
      call row%add('skirt_max_film_pressure[Pa]', skirt%pressure, 'largest pressure of the film of both faces')
      call row%keep('max_skirt_film_pressure', largest, 'largest pressure of the film of the skirt', has_angle=.true.)
      call row%add('skirt_asperity_force[N]', skirt%asperities, 'force of the asperities of both faces, where it presses')
      call row%keep('max_skirt_asperity_force', largest, 'largest force of the asperities of the skirt')
    end associate
    call row%add_on_request('slap_speed[m/s]', maxval(abs(now%corner%depth_rate)), &
      'speed across the bore of the faster end of the skirt')
    call row%keep('max_slap_speed', largest, 'largest speed of an end of the skirt across the bore: the hardest slap', &
      has_angle=.true.)
    do i = 1, n_corners
      row%place = corner_names(i)//'_'
      call row%add('gap[m]', -now%corner(i)%depth, 'gap between this end of a face of the skirt and the bore')
      if (self%stiffness > 0) call row%add('deflection[m]', now%deflection(i), &
        'deflection of this end of a face of the skirt, away from the bore')
    end do
    row%place = ''
    if (.not. self%stiffness > 0) return
    call row%add_on_request('skirt_deflection[m]', maxval(now%deflection), 'largest deflection of an end of a face of the skirt')
    call row%keep('max_deflection', largest, 'largest deflection of an end of a face of the skirt', has_angle=.true.)
    call row%add_on_request('skirt_spring_energy[J]', now%spring_energy, 'elastic energy stored in the faces of the skirt')
  end subroutine add_columns
end module skirt_film
