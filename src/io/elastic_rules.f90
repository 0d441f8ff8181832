!> Rules that the values of a case with elastic members must obey together.
module elastic_rules
  use gudgeon_kinds, only: dp
  use gudgeon_constants, only: pi
  use gudgeon_errors, only: error_t
  use number_text, only: short_text
  use chain_motion, only: motion_t, accelerations_t, turn_crank
  use chain_bodies, only: rod_t, crank_t, piston_t, bodies_t, new_bodies, drive_t
  use chain_loads, only: loads_t, unloaded
  use elastic_rod, only: elastic_rod_t, largest_shank
  use assembled_chain, only: accelerate_assembled
  use case_definition, only: case_t
  use case_values, only: case_values_t
  implicit none
  private
  public :: check_elastic

contains

  !> Check that an elastic rod has mass between its pins, a shank that fits between them, and a positive definite mass matrix in its
  !> undeformed state.
  subroutine check_elastic(c, values, error)
    type(case_t), intent(in) :: c
    type(case_values_t), intent(in) :: values
    type(error_t), allocatable, intent(out) :: error
    type(elastic_rod_t) :: rod
    type(rod_t) :: rigid
    real(dp) :: largest, least
    if (.not. allocated(c%elastic_rod)) return
    associate (m => c%mechanism)
      rigid = rod_t(m%rod_length, m%rod_mass, m%rod_inertia, m%rod_com)
      if (m%rod_mass <= 0) then
        call values%refuse('mechanism', 'rod_mass', 'must be > 0 with an elastic rod', error)
      else if (m%rod_com(1) <= 0 .or. m%rod_com(1) >= m%rod_length) then
        call values%refuse('mechanism', 'rod_com', 'must be between the pins, > 0 and < rod_length, with an elastic rod', error)
      else if (c%elastic_rod%shank_mass > largest_shank(rigid)*(1 + 1e-12_dp)) then
        largest = largest_shank(rigid)
        call values%refuse('elastic_rod', 'shank_mass', 'must be <= '//short_text(largest)//': a heavier uniform shank leaves '// &
                           'a lump of negative mass on one of the pins, with this rod_mass and rod_com', error)
      end if
      if (allocated(error)) return
      rod = c%elastic_rod
      call rod%prepare(rigid)
      least = sum(rod%t(:rod%n_bending)**2)/rod%bending_mass
      if (m%rod_inertia + m%rod_mass*sum(m%rod_com**2) <= least) then
        call values%refuse('mechanism', 'rod_inertia', 'must be > '//short_text(least - m%rod_mass*sum(m%rod_com**2))// &
                           ' with an elastic rod of this shank: its transverse modes alone have more', error)
      else if (.not. is_definite(c, rigid, rod)) then
        call values%refuse('elastic_rod', 'transverse_modes', 'mass matrix not positive definite with these shapes: '// &
                           'must be fewer, or rod_inertia or crank_inertia larger, or rod_com nearer to the '// &
                           'line of the pins', error)
      end if
    end associate
  end subroutine check_elastic

  !> Whether the mass matrix of the undeformed chain is positive definite at every crank angle.
  logical function is_definite(c, rigid, rod) result(definite)
    type(case_t), intent(in) :: c
    type(rod_t), intent(in) :: rigid
    type(elastic_rod_t), intent(in) :: rod
    integer, parameter :: angles = 24
    type(bodies_t) :: bodies
    type(motion_t) :: motion
    type(loads_t) :: loads
    type(accelerations_t) :: accelerations
    real(dp) :: crank_moment
    logical :: reachable
    integer :: i
    associate (m => c%mechanism)
      bodies = new_bodies(crank_t(m%crank_length, m%crank_mass, m%crank_inertia, m%crank_com), rigid, piston_t(m%piston_mass), &
        [0.0_dp, 0.0_dp])
    end associate
    loads = unloaded
    motion%crank_pin = 0
    motion%crank_pin_rate = 0
    motion%offset = 0
    motion%offset_rate = 0
    motion%shape = 0
    motion%shape_rate = 0
    definite = .true.
    do i = 1, angles
      call turn_crank(motion, 2*pi*i/angles, 0.0_dp)
      call rod%follow(bodies%crank%length, motion, reachable)
      call accelerate_assembled(bodies, drive_t(c%drive%kind == 'free' .or. allocated(c%crankshaft), 0.0_dp, 0.0_dp, 0.0_dp), &
        [c%crank_pin%has_clearance(), c%joint%has_clearance()], loads, motion, accelerations, crank_moment, rod, definite)
      if (.not. definite) return
    end do
  end function is_definite
end module elastic_rules
