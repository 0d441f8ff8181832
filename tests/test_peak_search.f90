!> The search for the largest value of a curve between two of its points.
module test_peak_search
  use kinds, only: dp
  use checks, only: checks_t
  use peak_search, only: peak_search_t, sample_t
  implicit none
  private
  public :: run_test_peak_search

contains

  subroutine run_test_peak_search(check)
    class(checks_t), intent(inout) :: check
    call peaks_of_curves(check)
  end subroutine run_test_peak_search

  !> Curves with known maxima: smooth, asymmetric, with a kink, near an end; each is found with the required accuracy and few
  !> evaluations.
  subroutine peaks_of_curves(check)
    class(checks_t), intent(inout) :: check
    type(peak_search_t) :: search
    character(len=14), parameter :: names(6) = [character(len=14) :: 'sine', 'steep pulse', 'kink', 'near an end', 'cubic', &
      'quartic']
    integer, parameter :: most(6) = [8, 14, 40, 9, 8, 30]
    real(dp), parameter :: within(6) = [3e-12_dp, 3e-12_dp, 1e-6_dp, 3e-12_dp, 3e-12_dp, 1e-10_dp]
    real(dp) :: t
    integer :: i, values
    logical :: is_done
    do i = 1, size(names)
      values = 0
      call search%begin(sample(0.0_dp), sample(1.0_dp))
      do
        call search%next_time(t, is_done)
        if (is_done) exit
        values = values + 1
        call check%that(t > 0 .and. t < 1, trim(names(i))//': inside')
        call search%add_value(t, curve(t))
      end do
      call check%close_to(search%value(1), 2.0_dp, within(i), trim(names(i))//': largest value')
      call check%that(values <= most(i), trim(names(i))//': number of evaluations')
    end do

  contains

    type(sample_t) function sample(t)
      real(dp), intent(in) :: t
      real(dp), parameter :: h = 1e-5_dp
      sample = sample_t(t, curve(t), (curve(t + h) - curve(t - h))/(2*h))
    end function sample

    !> All curves have the maximum 2.
    real(dp) function curve(t)
      real(dp), intent(in) :: t
      select case (i)
      case (1)
        curve = 1 + sin(1 + 2*t)
      case (2)
        curve = 2*exp(1 - 6*t)*6*t
      case (3)
        curve = 2 - abs(t - 0.37_dp)*merge(3.0_dp, 1.0_dp, t < 0.37_dp)
      case (4)
        curve = 2 - (t - 0.999_dp)**2*(1 + t)
      case (5)
        curve = 2 - (t - 0.2_dp)**2*(2 - t)
      case default
        curve = 2 - (t - 0.6_dp)**4
      end select
    end function curve
  end subroutine peaks_of_curves
end module test_peak_search
