!> Slopes of the loads of a face by the motion of the piston, in closed form: with A p = r for the balances of the nodes that are
!> full, A dp = dr - dA p.
submodule (face_film) face_slopes
  use face_balance, only: respond
  implicit none

  !> The components of the motion.
  integer, parameter :: by_offset = 1, by_tilt = 2, by_offset_rate = 3, by_tilt_rate = 4, by_velocity = 5

contains

  module procedure add_slopes
    real(dp), dimension(n_motion, self%around, self%along - 1) :: source, dp_by
    real(dp) :: own(3, n_motion)
    integer :: k
    call find_sources(self, side, motion, at, p, source)
    call respond_of(self, side, motion, at, full, source, dp_by)
    do k = 1, n_motion
      where (p(1:self%around, 1:self%along - 1) < 0) dp_by(k, :, :) = 0
    end do
    call sum_slopes(self, side, motion, at, max(p, 0.0_dp), dp_by, own)
    own(:, by_tilt_rate) = own(:, by_tilt_rate) - side*self%arm*own(:, by_velocity)   ! U = x' - side r b'
    own(2, :) = own(2, :) - side*self%arm*own(3, :)
    slopes = slopes + own
  end procedure add_slopes

  !> Changes of the pressures that the changed sources make.
  pure subroutine respond_of(self, side, motion, at, full, source, dp_by)
    type(face_film_t), intent(in) :: self
    integer, intent(in) :: side
    type(face_motion_t), intent(in) :: motion
    real(dp), intent(in) :: at(self%around, 0:self%along + 1, n_seen)
    logical, intent(in) :: full(self%around, self%along - 1)
    real(dp), intent(in) :: source(n_motion, self%around, self%along - 1)
    real(dp), intent(out) :: dp_by(n_motion, self%around, self%along - 1)
    real(dp) :: along(self%around, self%along), round(0:self%around, self%along - 1), unused(self%around, self%along - 1)
    call self%find_flows(side, motion, at, along, round, unused)
    call respond(self%around, self%along, along, round, full, source, dp_by)
  end subroutine respond_of

  !> dr - dA p of each node, by each component of the motion; by the velocity that of the face, U, alone.
  pure subroutine find_sources(self, side, motion, at, p, source)
    type(face_film_t), intent(in) :: self
    integer, intent(in) :: side
    type(face_motion_t), intent(in) :: motion
    real(dp), intent(in) :: at(self%around, 0:self%along + 1, n_seen), p(0:self%around + 1, 0:self%along)
    real(dp), intent(out) :: source(n_motion, self%around, self%along - 1)
    real(dp), dimension(0:self%around, 0:self%along + 1) :: d_half, d_along, d_round   ! of H in the middles, of conductances
    real(dp) :: lever, squeeze, curvature, speed
    integer :: i, j, k
    speed = motion%velocity - side*self%arm*motion%tilt_rate
    do k = by_offset, by_tilt
      d_half = 0
      d_along = 0
      d_round = 0
      do j = 1, self%along
        lever = -side*merge(1.0_dp, self%z_half(j), k == by_offset)
        do i = 1, self%around
          d_half(i, j) = lever*self%cosine(i, 1)*at(i, j, slope_half)
          d_along(i, j) = self%step/(4*self%viscosity*(self%z(j) - self%z(j - 1)))*at(i, j, mean_half)**2*d_half(i, j)
        end do
        if (j == self%along) cycle
        lever = -side*merge(1.0_dp, self%z(j), k == by_offset)
        do i = 1, self%around
          d_round(i, j) = self%width(j)/(4*self%viscosity*self%step)*at(i, j, mean_edge)**2*at(i, j, slope_edge)* &
            lever*self%cosine(i, 2)*merge(2, 1, i == self%around)
        end do
      end do
      do j = 1, self%along - 1
        lever = -side*merge(1.0_dp, self%z(j), k == by_offset)
        squeeze = side*(motion%offset_rate + self%z(j)*motion%tilt_rate)*self%step*self%width(j)
        do i = 1, self%around
          curvature = 0
          if (at(i, j, slope) < 1) curvature = self%asperities%gap_curvature(at(i, j, gap))
          source(k, i, j) = squeeze*curvature*lever*self%cosine(i, 1)**2 + &
            0.5_dp*speed*self%step*(d_half(i, j + 1) - d_half(i, j)) + &
            d_along(i, j)*(p(i, j - 1) - p(i, j)) + d_along(i, j + 1)*(p(i, j + 1) - p(i, j)) + &
            d_round(i - 1, j)*(p(i - 1, j) - p(i, j)) + d_round(i, j)*(p(i + 1, j) - p(i, j))
        end do
      end do
    end do
    do j = 1, self%along - 1
      source(by_offset_rate, :, j) = side*self%step*self%width(j)*at(:, j, slope)*self%cosine(:, 1)
      source(by_tilt_rate, :, j) = self%z(j)*source(by_offset_rate, :, j)
      source(by_velocity, :, j) = 0.5_dp*self%step*(at(:, j + 1, mean_half) - at(:, j, mean_half))
    end do
  end subroutine find_sources

  !> Slopes of force, moment of the force, and friction, from those of the pressures.
  pure subroutine sum_slopes(self, side, motion, at, p, dp_by, own)
    type(face_film_t), intent(in) :: self
    integer, intent(in) :: side
    type(face_motion_t), intent(in) :: motion
    real(dp), intent(in) :: at(self%around, 0:self%along + 1, n_seen), p(0:self%around + 1, 0:self%along)
    real(dp), intent(in) :: dp_by(n_motion, self%around, self%along - 1)
    real(dp), intent(out) :: own(3, n_motion)
    real(dp), parameter :: apart = 1e-4_dp   ! half the distance of two gaps over the roughness, for the slope of p_a
    real(dp) :: speed, area, lever, change, hold, carried, by_gap, carried_by(n_motion), rough
    integer :: i, j, k
    rough = self%asperities%roughness
    speed = motion%velocity - side*self%arm*motion%tilt_rate
    own = 0
    carried = 0
    carried_by = 0
    do j = 0, self%along
      area = 2*self%step*self%width(j)
      do i = 1, self%around
        if (j > 0 .and. j < self%along) then
          own(1, :) = own(1, :) - side*self%cosine(i, 1)*area*dp_by(:, i, j)
          own(2, :) = own(2, :) - side*self%cosine(i, 1)*area*self%z(j)*dp_by(:, i, j)
          own(3, :) = own(3, :) - self%step*(at(i, j + 1, mean_half) - at(i, j, mean_half))*dp_by(:, i, j)
        end if
        own(3, by_velocity) = own(3, by_velocity) - self%viscosity/at(i, j, mean)*area
        by_gap = 0
        if (at(i, j, gap) < 8*rough) then
          associate (h => at(i, j, gap))
            carried = carried + self%asperities%pressure(-h, 0.0_dp)*area
            by_gap = (self%asperities%pressure(-h - apart*rough, 0.0_dp) - self%asperities%pressure(-h + apart*rough, 0.0_dp))/ &
              (2*apart*rough)*area
          end associate
        end if
        do k = by_offset, by_tilt
          lever = -side*self%cosine(i, 1)   ! of the gap
          change = lever*merge(1.0_dp, self%z(j), k == by_offset)
          hold = 0                          ! of the difference of H above and below
          if (j > 0 .and. j < self%along) hold = lever* &
            (at(i, j + 1, slope_half)*merge(1.0_dp, self%z_half(j + 1), k == by_offset) - &
            at(i, j, slope_half)*merge(1.0_dp, self%z_half(j), k == by_offset))
          own(1, k) = own(1, k) - side*self%cosine(i, 1)*by_gap*change
          own(2, k) = own(2, k) - side*self%cosine(i, 1)*self%z(j)*by_gap*change
          own(3, k) = own(3, k) + self%viscosity*speed*area*at(i, j, slope)*change/at(i, j, mean)**2 - p(i, j)*hold*self%step
          carried_by(k) = carried_by(k) + by_gap*change
        end do
      end do
    end do
    own(3, :) = own(3, :) + self%asperities%friction_force(speed, 1.0_dp)*carried_by
    own(3, by_velocity) = own(3, by_velocity) + self%asperities%friction_slope(speed, carried)
  end subroutine sum_slopes
end submodule face_slopes
