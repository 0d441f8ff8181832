!> Rules that the groups of a film with memory must obey together, in a case with a mechanism and in that of a bearing.
module history_rules
  use kinds, only: dp
  use history_case, only: history_case_t, most_positions
  use case_values, only: case_values_t
  use number_text, only: short_text
  use value_reader, only: read_numbers
  implicit none
  private
  public :: check_history, check_shape, read_positions

contains

  !> Note the errors of a film with memory. The last arguments are the names of its groups.
  subroutine check_history(values, history, bearing_radius, bearing_length, pressure_viscosity, ambient, supply_group, bore_group)
    type(case_values_t), intent(inout) :: values
    type(history_case_t), intent(in) :: history
    real(dp), intent(in) :: bearing_radius, bearing_length   !! [m]
    real(dp), intent(in) :: pressure_viscosity, ambient      !! [1/Pa], ambient over cavitation pressure [Pa]
    character(len=*), intent(in) :: supply_group, bore_group
    real(dp), parameter :: thinnest_ring = 1.02_dp, most_thickening = 20
    if (allocated(history%bore)) then
      associate (bore => history%bore)
        call values%forbid(bore%outer_radius > 0 .and. bore%table%is_wanted(), bore_group, 'compliance_table', &
          'cannot be combined with outer_radius: the bore is a ring or has a table')
        call values%demand(bore%outer_radius > 0 .or. bore%table%is_wanted(), bore_group, 'outer_radius', &
          'without compliance_table')
        call values%forbid(bore%outer_radius > 0 .and. bore%outer_radius <= thinnest_ring*bearing_radius, bore_group, &
          'outer_radius', 'must be > 1.02 bearing_radius = '//short_text(thinnest_ring*bearing_radius))
      end associate
    end if
    if (.not. allocated(history%supply)) return
    associate (supply => history%supply)
      call values%forbid(pressure_viscosity*(supply%pressure + ambient) >= most_thickening, supply_group, 'pressure', &
        'must be < 20/pressure_viscosity')
      select case (supply%kind)
      case ('grooves')
        call values%demand(supply%width_deg > 0, supply_group, 'width_deg', 'with kind = ''grooves''')
        call values%demand(supply%length > 0, supply_group, 'length', 'with kind = ''grooves''')
        call values%forbid(supply%length > bearing_length, supply_group, 'length', 'must be <= bearing_length')
      case ('holes')
        call values%demand(supply%diameter > 0, supply_group, 'diameter', 'with kind = ''holes''')
      case default
        call values%demand(supply%groove_width > 0, supply_group, 'groove_width', 'with kind = ''circumferential_groove''')
        call values%forbid(supply%groove_width >= bearing_length, supply_group, 'groove_width', 'must be < bearing_length')
        call values%forbid(supply%fixed_to == 'pin', supply_group, 'fixed_to', &
          'must be bearing with kind = ''circumferential_groove''')
        return
      end select
      call values%forbid(size(supply%positions) == 0, supply_group, 'position_deg', 'must be 1 to 8 angles')
    end associate
  end subroutine check_history

  !> Note the errors of the shape of a bore and of the tilt of its pin.
  subroutine check_shape(values, history, clearance, bearing_radius, bearing_length, group)
    type(case_values_t), intent(inout) :: values
    type(history_case_t), intent(in) :: history
    real(dp), intent(in) :: clearance, bearing_radius, bearing_length   !! [m]
    character(len=*), intent(in) :: group
    real(dp), parameter :: deepest = 0.1_dp   !! over the radius
    associate (shape => history%shape)
      call values%forbid(norm2(shape%tilt)*bearing_length/2 >= clearance, group, 'tilt', &
        'must be < 2 clearance/bearing_length = '//short_text(2*clearance/bearing_length)//': the pin would touch at its ends')
      if (allocated(history%supply)) call values%forbid(any(abs(shape%tilt) > 0) .and. &
        history%supply%kind == 'circumferential_groove', group, 'tilt', &
        'cannot be combined with a circumferential_groove: the film beside it is one of two equal lands')
      if (.not. allocated(shape%table%x)) return
      call values%forbid(any(abs(shape%factor*shape%table%y) > deepest*bearing_radius), group, 'table', &
        'must have deviations of at most 0.1 bearing_radius = '//short_text(deepest*bearing_radius)//' m, times factor')
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
