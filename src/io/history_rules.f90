!> Rules that the groups of a film with memory in a joint must obey together.
module history_rules
  use kinds, only: dp
  use error_handling, only: error_t
  use film_cells, only: film_cells_t, new_film_cells
  use film_history, only: film_history_t
  use history_case, only: history_case_t, bore_case_t, supply_case_t, shape_case_t, most_positions
  use joint_case, only: joint_case_t
  use case_values, only: case_values_t
  use number_text, only: short_text
  use value_reader, only: read_numbers
  implicit none
  private
  public :: check_film_history, read_positions

contains

  !> Note the errors of a film with memory: of its groups by themselves, and of a supply that its cells do not resolve.
  subroutine check_film_history(joint, group, place, values)
    type(joint_case_t), intent(in) :: joint
    character(len=*), intent(in) :: group   !! of the joint
    integer, intent(in) :: place            !! index in `places`
    type(case_values_t), intent(inout) :: values
    type(film_history_t) :: film
    type(film_cells_t) :: cells
    type(error_t), allocatable :: error
    character(len=:), allocatable :: own, oil, supply, bore, shape, cavitation
    integer :: key
    own = values%law_group('film_history', place)
    oil = values%law_group('lubrication', place)
    supply = values%law_group('supply', place)
    bore = values%law_group('bore', place)
    shape = values%law_group('shape', place)
    cavitation = ''
    key = values%place_of(oil, 'cavitation')
    if (allocated(joint%film)) then
      if (values%is_used(key)) cavitation = values%values(key)%text
    end if
    associate (history => joint%history)
      if (.not. allocated(history%march)) then
        call values%forbid(allocated(history%supply), supply, 'kind', 'needs the group film_history, whose film it feeds')
        call values%forbid(allocated(history%bore), bore, 'outer_radius', 'needs the group film_history, whose film deforms it')
        call values%forbid(allocated(history%shape), shape, 'table', 'needs the group film_history, whose film has this shape')
        call values%forbid(joint%ambient_over_cavitation > 0, oil, 'ambient_over_cavitation', 'needs the group film_history')
        call values%forbid(cavitation == 'mass_conserving', oil, 'cavitation', &
          'needs the group film_history, whose film conserves its oil')
        return
      end if
      call values%forbid(.not. allocated(joint%film), own, 'drive', 'needs the group lubrication: the film of that joint')
      call values%forbid(mod(history%march%cycle_deg, 360) /= 0, own, 'cycle_deg', 'must be a multiple of 360')
      call values%forbid(cavitation == 'gumbel' .or. cavitation == 'none', oil, 'cavitation', &
        'must be mass_conserving with film_history, or reynolds for a film without memory, for comparison')
      call values%forbid(cavitation == 'reynolds' .and. .not. values%is_given(oil, 'cavitation'), oil, 'cavitation', &
        'must be given with film_history: mass_conserving, or reynolds for a film without memory')
      if (values%problems%concerns(group)) return
      if (allocated(history%bore)) call check_bore(values, history%bore, joint%bearing_radius, bore)
      if (allocated(history%supply)) call check_supply(values, joint, history%supply, supply)
      if (allocated(history%shape)) call check_shape(values, joint, history%shape, shape)
    end associate
    if (values%problems%n > 0) return
    call joint%make_history(film)
    call new_film_cells(film%bearing, film%supply, film%around, film%along, cells, error, film%shape)
    if (allocated(error)) call values%refuse_group(supply, error%message)
  end subroutine check_film_history

  subroutine check_bore(values, bore, bearing_radius, group)
    type(case_values_t), intent(inout) :: values
    type(bore_case_t), intent(in) :: bore
    real(dp), intent(in) :: bearing_radius   !! [m]
    character(len=*), intent(in) :: group
    real(dp), parameter :: thinnest_ring = 1.02_dp
    call values%forbid(bore%outer_radius > 0 .and. bore%table%is_wanted(), group, 'compliance_table', &
      'cannot be combined with outer_radius: the bore is a ring or has a table')
    call values%demand(bore%outer_radius > 0 .or. bore%table%is_wanted(), group, 'outer_radius', 'without compliance_table')
    call values%forbid(bore%outer_radius > 0 .and. bore%outer_radius <= thinnest_ring*bearing_radius, group, &
      'outer_radius', 'must be > 1.02 bearing_radius = '//short_text(thinnest_ring*bearing_radius))
  end subroutine check_bore

  subroutine check_supply(values, joint, supply, group)
    type(case_values_t), intent(inout) :: values
    type(joint_case_t), intent(in) :: joint
    type(supply_case_t), intent(in) :: supply
    character(len=*), intent(in) :: group
    real(dp), parameter :: most_thickening = 20
    real(dp), parameter :: rounding = 1e-12_dp   ! relative difference of two angles that counts as none
    call values%forbid(joint%elastic%pressure_viscosity*(supply%pressure + joint%ambient_over_cavitation) >= most_thickening, &
      group, 'pressure', 'must be < 20/pressure_viscosity')
    if (supply%feed%is_wanted() .and. allocated(supply%feed%x)) then
      call values%forbid(any(supply%feed%y < 0), group, 'pressure_table', 'must have pressures >= 0, above ambient')
      call values%forbid(supply%feed%x(size(supply%feed%x)) - supply%feed%x(1) > joint%history%march%cycle_deg*(1 + rounding), &
        group, 'pressure_table', 'must not span more than cycle_deg')
    end if
    select case (supply%kind)
    case ('grooves')
      call values%demand(supply%width_deg > 0, group, 'width_deg', 'with kind = ''grooves''')
      call values%demand(supply%length > 0, group, 'length', 'with kind = ''grooves''')
      call values%forbid(supply%length > joint%bearing_length, group, 'length', 'must be <= bearing_length')
    case ('holes')
      call values%demand(supply%diameter > 0, group, 'diameter', 'with kind = ''holes''')
    case default
      call values%demand(supply%groove_width > 0, group, 'groove_width', 'with kind = ''circumferential_groove''')
      call values%forbid(supply%groove_width >= joint%bearing_length, group, 'groove_width', 'must be < bearing_length')
      call values%forbid(supply%fixed_to == 'pin', group, 'fixed_to', &
        'must be bearing with kind = ''circumferential_groove''')
      return
    end select
    call values%forbid(size(supply%positions) == 0, group, 'position_deg', 'must be 1 to 8 angles')
  end subroutine check_supply

  subroutine check_shape(values, joint, shape, group)
    type(case_values_t), intent(inout) :: values
    type(joint_case_t), intent(in) :: joint
    type(shape_case_t), intent(in) :: shape
    character(len=*), intent(in) :: group
    real(dp), parameter :: deepest = 0.1_dp   !! over the radius
    associate (clearance => joint%clearance, radius => joint%bearing_radius, length => joint%bearing_length)
      call values%forbid(norm2(shape%tilt)*length/2 >= clearance, group, 'tilt', &
        'must be < 2 clearance/bearing_length = '//short_text(2*clearance/length)//': the pin would touch at its ends')
      if (allocated(joint%history%supply)) call values%forbid(any(abs(shape%tilt) > 0) .and. &
        joint%history%supply%kind == 'circumferential_groove', group, 'tilt', &
        'cannot be combined with a circumferential_groove: the film beside it is one of two equal lands')
      if (.not. allocated(shape%table%x)) return
      call values%forbid(any(abs(shape%factor*shape%table%y) > deepest*radius), group, 'table', &
        'must have deviations of at most 0.1 bearing_radius = '//short_text(deepest*radius)//' m, times factor')
      call values%forbid(clearance + minval(shape%factor*shape%table%y) <= 0, group, 'table', &
        'must have deviations > -clearance, times factor: the bore has no gap there')
    end associate
  end subroutine check_shape

  !> Read the angles of grooves and holes; none if they are not a list of 1 to 8 numbers.
  subroutine read_positions(history)
    type(history_case_t), intent(inout) :: history
    real(dp) :: found(most_positions)
    logical :: all_read
    integer :: n
    if (.not. allocated(history%supply)) return
    call read_numbers(history%supply%position_deg, ',', found, n, all_read)
    history%supply%positions = found(:merge(n, 0, all_read))
  end subroutine read_positions
end module history_rules
