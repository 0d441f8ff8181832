!> Elastic faces: the rigid panel on its two springs, see `face_film`.
submodule (face_film) face_panel
  use face_yield, only: guess_yielding, balance_yielding
  implicit none

contains

  !> Change of offset and tilt of the panel over the deflections of its springs, top and bottom: the panel's motion across the bore
  !> over their rates too, and by virtual work what loads them over force and moment across the bore.
  pure function on_panel(film, side) result(lever)
    type(face_film_t), intent(in) :: film
    integer, intent(in) :: side
    real(dp) :: lever(2, 2)
    associate (z => film%height)
      lever = -side/(z(1) - z(2))*reshape([-z(2), 1.0_dp, z(1), -1.0_dp], [2, 2])
    end associate
  end function on_panel

  module procedure panel_motion
    real(dp) :: shift(2), shift_rate(2), lever(2, 2)
    lever = on_panel(self, side)
    shift = matmul(lever, springs%deflection)
    shift_rate = matmul(lever, springs%rate)
    panel = motion
    panel%offset = motion%offset + shift(1)
    panel%tilt = motion%tilt + shift(2)
    panel%offset_rate = motion%offset_rate + shift_rate(1)
    panel%tilt_rate = motion%tilt_rate + shift_rate(2)
    panel%velocity = motion%velocity + side*self%arm*shift_rate(2)   ! U = x' - side r b' of the piston
  end procedure panel_motion

  module procedure find_yielding
    real(dp) :: along(self%around, self%along), round(0:self%around, self%along - 1), source(self%around, self%along - 1)
    real(dp), dimension(self%around, self%along - 1, 2) :: by_rate, weight
    real(dp) :: load(2), share(2), area
    integer :: i, j, k
    call self%find_flows(side, motion, at, along, round, source)
    load = -springs%stiffness*springs%deflection
    do j = 0, self%along
      share(1) = (self%z(j) - self%height(2))/(self%height(1) - self%height(2))
      share(2) = 1 - share(1)
      area = 2*self%step*self%width(j)   ! with its mirror image
      do i = 1, self%around
        load = load + share*area*self%cosine(i, 1)*self%contact_pressure(at(i, j, gap))
      end do
      if (j == 0 .or. j == self%along) cycle
      do k = 1, 2
        weight(:, j, k) = share(k)*area*self%cosine(:, 1)
        by_rate(:, j, k) = -0.5_dp*weight(:, j, k)*at(:, j, slope)
      end do
    end do
    full = .true.
    associate (n => self%around, m => self%along, drag => springs%stiffness*relaxation)
      if (.not. self%cuts_suction) call guess_yielding(n, m, along, round, source, by_rate, weight, load, drag, full)
      call balance_yielding(n, m, along, round, source, by_rate, weight, load, drag, self%cuts_suction, full, springs%rate, p, &
        springs%balance)
    end associate
  end procedure find_yielding

  !> With the lever T, K tau w' = T^t (F_n, M_n) - K w, where the loads depend on w and w' through the motion of the panel.
  module procedure panel_slopes
    real(dp) :: lever(2, 2), loading(2, n_motion), by_deflection(n_motion, 2), by_rate(n_motion, 2), a(2, 2), inverse(2, 2)
    lever = on_panel(self, side)
    by_deflection = 0
    by_deflection(1:2, :) = lever
    by_rate = 0
    by_rate(3:4, :) = lever
    by_rate(5, :) = side*self%arm*lever(2, :)
    loading(1, :) = own(1, :)
    loading(2, :) = own(2, :) + side*self%arm*own(3, :)   ! moment across the bore alone
    loading = matmul(transpose(lever), loading)
    a = -matmul(loading, by_rate)
    a(1, 1) = a(1, 1) + stiffness*relaxation
    a(2, 2) = a(2, 2) + stiffness*relaxation
    inverse = reshape([a(2, 2), -a(2, 1), -a(1, 2), a(1, 1)], [2, 2])/(a(1, 1)*a(2, 2) - a(1, 2)*a(2, 1))
    of_rates(:, :n_motion) = matmul(inverse, loading)
    of_rates(:, n_motion + 1:) = matmul(inverse, matmul(loading, by_deflection)) - stiffness*inverse
    of_loads(:, :n_motion) = own
    of_loads(:, n_motion + 1:) = matmul(own, by_deflection)
    of_loads = of_loads + matmul(matmul(own, by_rate), of_rates)
  end procedure panel_slopes
end submodule face_panel
