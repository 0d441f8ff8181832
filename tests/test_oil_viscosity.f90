!> Viscosity of an oil at a temperature: against values computed with 30 digits from the published equations, and a published
!> example.
module test_oil_viscosity
  use kinds, only: dp
  use checks, only: checks_t
  use oil_viscosity, only: oil_t
  implicit none
  private
  public :: run_test_oil_viscosity

contains

  subroutine run_test_oil_viscosity(check)
    class(checks_t), intent(inout) :: check
    call walther(check)
    call vogel(check)
    call density(check)
    call known_points(check)
  end subroutine run_test_oil_viscosity

  !> An ISO VG 32 oil (32 and 5.4 mm^2/s at 40 and 100 degrees C; 8.5 at 80 according to a published table of ASTM D341), an SAE
  !> 15W-40 oil, and a fuel below 2 mm^2/s, where the exponential in Z matters.
  subroutine walther(check)
    class(checks_t), intent(inout) :: check
    type(oil_t) :: oil
    oil = new_oil('walther', 353.15_dp, [32e-6_dp, 5.4e-6_dp])
    call check%relative(oil%kinematic_viscosity(), 8.53321469154105e-6_dp, 1e-12_dp, 'ISO VG 32 at 80 degrees C')
    oil = new_oil('walther', 323.15_dp, [30e-6_dp, 5.23e-6_dp])
    call check%relative(oil%kinematic_viscosity(), 20.3141340985244e-6_dp, 1e-12_dp, 'a spindle oil at 50 degrees C')
    oil = new_oil('walther', 453.15_dp, [105e-6_dp, 14e-6_dp])
    call check%relative(oil%kinematic_viscosity(), 3.60858370848609e-6_dp, 1e-12_dp, 'SAE 15W-40 at 180 degrees C')
    oil = new_oil('walther', 423.15_dp, [1.8e-6_dp, 0.8e-6_dp])
    call check%relative(oil%kinematic_viscosity(), 0.50463430301132e-6_dp, 1e-12_dp, 'a fuel at 150 degrees C')
  end subroutine walther

  !> nu = a exp(b/(T - T0)), computed by hand: b = 884.038700262919 K.
  subroutine vogel(check)
    class(checks_t), intent(inout) :: check
    type(oil_t) :: oil
    oil = new_oil('vogel', 453.15_dp, [105e-6_dp, 14e-6_dp])
    call check%relative(oil%kinematic_viscosity(), 3.74421400399834e-6_dp, 1e-12_dp, 'Vogel''s equation')
    call check%relative(oil%kinematic_viscosity(), 105e-6_dp*exp(884.038700262919_dp*(1/275.0_dp - 1/135.0_dp)), 1e-12_dp, &
      'Vogel''s equation')
  end subroutine vogel

  !> A lubricating oil of 880 kg/m^3 at 15 degrees C, and mu = rho nu.
  subroutine density(check)
    class(checks_t), intent(inout) :: check
    type(oil_t) :: oil
    oil = new_oil('walther', 363.15_dp, [105e-6_dp, 14e-6_dp])
    oil%density = 880
    call check%relative(oil%density_at(), 832.24422654321_dp, 1e-12_dp, 'density at 90 degrees C')
    oil = new_oil('walther', 353.15_dp, [32e-6_dp, 5.4e-6_dp])
    call check%relative(oil%dynamic_viscosity(), 823.67278491013_dp*8.53321469154105e-6_dp, 1e-12_dp, 'dynamic viscosity')
    oil%temperature = 288.15_dp
    call check%relative(oil%density_at(), 865.0_dp, 1e-15_dp, 'density at the reference temperature')
  end subroutine density

  !> Both laws reproduce the known points, in either order, and the viscosity decreases with temperature.
  subroutine known_points(check)
    class(checks_t), intent(inout) :: check
    character(len=7), parameter :: laws(2) = [character(len=7) :: 'walther', 'vogel']
    type(oil_t) :: oil
    real(dp) :: before
    integer :: i, k
    do i = 1, 2
      oil = new_oil(trim(laws(i)), 313.15_dp, [105e-6_dp, 14e-6_dp])
      call check%relative(oil%kinematic_viscosity(), 105e-6_dp, 1e-12_dp, 'the first known point')
      oil%temperature = 373.15_dp
      call check%relative(oil%kinematic_viscosity(), 14e-6_dp, 1e-12_dp, 'the second known point')
      oil%known_temperatures = oil%known_temperatures([2, 1])
      oil%known_viscosities = oil%known_viscosities([2, 1])
      call check%relative(oil%kinematic_viscosity(), 14e-6_dp, 1e-12_dp, 'points in the other order')
      before = huge(before)
      do k = 0, 50
        oil%temperature = 200 + 10*k
        call check%that(oil%kinematic_viscosity() > 0 .and. oil%kinematic_viscosity() < before, &
          'viscosity decreases with temperature')
        before = oil%kinematic_viscosity()
      end do
    end do
  end subroutine known_points

  !> An oil known at 40 and 100 degrees C.
  pure function new_oil(law, temperature, viscosities) result(oil)
    character(len=*), intent(in) :: law
    real(dp), intent(in) :: temperature, viscosities(2)
    type(oil_t) :: oil
    oil%law = law
    oil%temperature = temperature
    oil%known_temperatures = [313.15_dp, 373.15_dp]
    oil%known_viscosities = viscosities
    oil%density = 865
    oil%vogel_temperature = 178.15_dp
  end function new_oil
end module test_oil_viscosity
