!> The state of a run as a list of named numbers, from which another run may start.
!>
!> Every part of a run that has a state declares it once, by calls of `add`: a list that records takes the values from its parts, a
!> list that sets gives them to its parts. Numbers of the motion must all be there. Totals are what a run counts: time, energies,
!> contacts, wear, and extremes. A run that goes on needs them all; a run that begins anew with this motion leaves them at 0.
module run_state
  use kinds, only: dp
  implicit none
  private
  public :: run_state_t, state_number_t

  !> One or several numbers with one name.
  type :: state_number_t
    character(len=48) :: name = ''
    character(len=16) :: unit = ''
    character(len=:), allocatable :: says      !! short description
    real(dp), allocatable :: values(:)
    logical :: is_total = .false.
    logical :: is_whole = .false.              !! a whole number
    logical :: is_set = .false.                !! a part has accepted it
  end type state_number_t

  real(dp), parameter :: largest = 1e9_dp   !! angle [rad], beyond which turns are lost in rounding, and speed [rad/s], [m/s]

  type :: run_state_t
    character(len=:), allocatable :: file      !! absolute path of the file that it is from
    type(state_number_t), allocatable :: numbers(:)
    logical :: sets = .false.                  !! gives values to the parts; else it records them
    logical :: goes_on = .true.                !! it gives them the totals too
    logical :: of_totals = .false.             !! the numbers that are added now are totals
    character(len=:), allocatable :: fault     !! group, key and reason why the state does not fit; not allocated: it does
  contains
    procedure, private :: add_reals, add_real, add_integer
    generic :: add => add_reals, add_real, add_integer
    procedure :: refuse
    procedure :: find_unused
  end type run_state_t

contains

  !> Declare several numbers.
  subroutine add_reals(self, name, values, unit, says)
    class(run_state_t), intent(inout) :: self
    character(len=*), intent(in) :: name, unit, says
    real(dp), intent(inout) :: values(:)
    type(state_number_t) :: new
    character(len=60) :: counts
    integer :: i
    if (.not. self%sets) then
      new%name = name
      new%unit = unit
      new%says = says
      new%values = values
      new%is_total = self%of_totals
      if (.not. allocated(self%numbers)) allocate (self%numbers(0))
      self%numbers = [self%numbers, new]
      return
    end if
    if (self%of_totals .and. .not. self%goes_on) return
    do i = 1, size(self%numbers)
      associate (number => self%numbers(i))
        if (number%name /= name .or. (number%is_total .neqv. self%of_totals)) cycle
        number%is_set = .true.
        if (size(number%values) == size(values)) then
          if (any(unit == [character(len=5) :: 'rad', 'rad/s', 'm/s']) .and. any(abs(number%values) > largest)) then
            call self%refuse(name, 'must be at most 1e9 in size ('//unit//')')
          else
            values = number%values
          end if
        else
          write (counts, '(i0, a, i0)') size(number%values), ' values, but the case needs ', size(values)
          call self%refuse(name, trim(counts))
        end if
        return
      end associate
    end do
    call self%refuse(name, 'missing: the case needs it')
  end subroutine add_reals

  !> Declare a number.
  subroutine add_real(self, name, value, unit, says)
    class(run_state_t), intent(inout) :: self
    character(len=*), intent(in) :: name, unit, says
    real(dp), intent(inout) :: value
    real(dp) :: values(1)
    values = value
    call self%add(name, values, unit, says)
    value = values(1)
  end subroutine add_real

  !> Declare a whole number.
  subroutine add_integer(self, name, value, says)
    class(run_state_t), intent(inout) :: self
    character(len=*), intent(in) :: name, says
    integer, intent(inout) :: value
    real(dp) :: values(1)
    values = value
    call self%add(name, values, '', says)
    if (.not. self%sets) then
      self%numbers(size(self%numbers))%is_whole = .true.
    else if (abs(values(1) - anint(values(1))) > 0 .or. abs(values(1)) > huge(value)) then
      call self%refuse(name, 'must be a whole number')
    else
      value = nint(values(1))
    end if
  end subroutine add_integer

  !> Say why the state does not fit; the first reason is kept.
  subroutine refuse(self, name, reason)
    class(run_state_t), intent(inout) :: self
    character(len=*), intent(in) :: name, reason
    if (.not. allocated(self%fault)) self%fault = trim(merge('&so_far ', '&initial', self%of_totals))//' '//name//': '//reason
  end subroutine refuse

  !> Refuse the state if it contains a number that no part of the run has accepted.
  subroutine find_unused(self)
    class(run_state_t), intent(inout) :: self
    integer :: i
    do i = 1, size(self%numbers)
      associate (number => self%numbers(i))
        self%of_totals = number%is_total
        if (.not. (number%is_set .or. number%is_total .and. .not. self%goes_on)) &
          call self%refuse(trim(number%name), 'the case has no place for it')
      end associate
    end do
  end subroutine find_unused
end module run_state
