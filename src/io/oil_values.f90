!> Named oils in the values of a case.
module oil_values
  use named_oils, only: named_oil_t, known_temperatures, find_oil
  use case_values, only: case_values_t, value_t
  implicit none
  private
  public :: replace_oils

contains

  !> Put the data of each named oil of a loaded case beside its name, so that the resolved case has the numbers too. Refused are
  !> other numbers beside the name.
  subroutine replace_oils(values)
    type(case_values_t), intent(inout) :: values
    character(len=*), parameter :: keys(4) = [character(len=18) :: 'viscosity_law', 'known_temperatures', 'known_viscosities', &
      'density']
    type(named_oil_t) :: oil
    type(value_t) :: of_oil
    integer :: group, name, place, i
    do group = 1, size(values%groups)
      name = values%place_of(trim(values%groups(group)%name), 'oil')
      if (name == 0 .or. .not. values%is_present(group)) cycle
      if (values%values(name)%text == '') cycle
      oil = find_oil(values%values(name)%text)
      do i = 1, size(keys)
        place = values%place_of(trim(values%groups(group)%name), trim(keys(i)))
        associate (value => values%values(place))
          of_oil = value
          of_oil%given = .true.
          select case (keys(i))
          case ('viscosity_law')
            of_oil%text = 'walther'
          case ('known_temperatures')
            of_oil%reals(:2) = known_temperatures
          case ('known_viscosities')
            of_oil%reals(:2) = oil%viscosities
          case default   ! density
            of_oil%reals(1) = oil%density
          end select
          if (value%given(1) .and. (value%text /= of_oil%text .or. any(abs(value%reals - of_oil%reals) > 0))) &
            call values%refuse(trim(values%groups(group)%name), trim(keys(i)), &
            'must not be given: oil = '''//values%values(name)%text//''' gives it', unit='')
          value = of_oil
        end associate
      end do
    end do
  end subroutine replace_oils
end module oil_values
