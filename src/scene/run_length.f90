!> Parameters of the end of a run: at the end given to the integrator, or when the motion is periodic. Also the analysis of the
!> motion that the run has reached.
module run_length
  use kinds, only: dp
  use model_parameters, only: has_parameters_t, parameter_list_t
  implicit none
  private
  public :: run_length_t, longest_period

  integer, parameter :: longest_period = 16   !! longest period that can be searched [revolutions]

  type, extends(has_parameters_t) :: run_length_t
    character(len=:), allocatable :: until   !! 'end' or 'periodic'
    integer :: period_revolutions = 0        !! longest period that is searched
    real(dp) :: periodic_tolerance = 0  !! largest difference between states one period apart, relative to the ranges of their
                                        !! components
    integer :: most_revolutions = 0          !! largest number of revolutions of a run until 'periodic'
    integer :: lyapunov_revolutions = 0  !! revolutions after the run over which the Lyapunov exponent is measured; 0: it is not
                                         !! measured
  contains
    procedure :: parameters
    procedure :: is_until_periodic
  end type run_length_t

contains

  subroutine parameters(self, list)
    class(run_length_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call list%word('until', self%until, 'end, periodic', 'end', &
      'end: by the keys of &integrator; periodic: when the motion repeats')
    call list%add('period_revolutions', self%period_revolutions, 'longest period that is recognised, in revolutions', &
      '>= 1 and <= 16', '16')
    call list%add('periodic_tolerance', self%periodic_tolerance, &
      'allowed change of the state after one period, over the range of each component', range='> 0 and <= 0.1', default='1.0e-4', &
      usual='1e-8 to 1e-2')
    call list%add('most_revolutions', self%most_revolutions, 'upper limit of revolutions of a run until = ''periodic''', &
      '>= 1 and <= 1000000', '1000')
    call list%add('lyapunov_revolutions', self%lyapunov_revolutions, &
      'revolutions after the run that measure the largest Lyapunov exponent; 0: it is not measured', '>= 0 and <= 1000000', '0')
  end subroutine parameters

  !> Whether the run continues until the motion is periodic.
  pure logical function is_until_periodic(self)
    class(run_length_t), intent(in) :: self
    is_until_periodic = .false.
    if (allocated(self%until)) is_until_periodic = self%until == 'periodic'
  end function is_until_periodic
end module run_length
