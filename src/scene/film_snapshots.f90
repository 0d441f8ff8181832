!> Pressure fields of the films at chosen times of a run. During the run only the motions at these times are stored; the pressures
!> are computed when it has ended.
module film_snapshots
  use kinds, only: dp
  use film_law, only: film_motion_t
  use ode_method, only: ode_method_t
  use scene_problem, only: scene_t, evaluation_t, phase_film
  use face_film, only: face_motion_t, faces_t
  use piston_guide, only: n_corners
  use inside_step, only: evaluate_inside
  implicit none
  private
  public :: film_snapshots_t, film_field_t, skirt_field_t

  !> Pressure over one half of a bearing. The other half is its mirror image.
  type :: film_field_t
    real(dp) :: time = 0, crank_angle = 0     !! [s], [rad]
    integer :: place = 0                      !! spot of the pin
    real(dp) :: clearance = 0, distance = 0   !! c and the magnitude of the eccentricity that the film model uses [m]
    real(dp) :: direction = 0                 !! of the eccentricity, counted from x towards y [rad]
    real(dp), allocatable :: angle(:)         !! measured from that direction [rad]
    real(dp), allocatable :: along(:)         !! axial distance from the middle of the bearing [m]
    real(dp), allocatable :: pressure(:, :)   !! [Pa]
  end type film_field_t

  !> Pressure over both faces of a skirt.
  type :: skirt_field_t
    real(dp) :: time = 0, crank_angle = 0     !! [s], [rad]
    type(faces_t) :: faces
  end type skirt_field_t

  type :: film_snapshots_t
    real(dp), allocatable :: times(:)         !! requested times, increasing [s]
    integer :: next = 1                       !! index of the next of them
    integer, private :: n = 0                 !! number of snapshots stored
    real(dp), allocatable, private :: kept(:, :)  !! (quantity, snapshot): time, crank angle, joint, share, e, e', both angular
                                                  !! speeds
    integer, private :: n_skirt = 0               !! number of motions of the skirt stored
    real(dp), allocatable, private :: skirt(:, :) !! (quantity, snapshot): time, crank angle, motion, deflections
  contains
    procedure :: prepare
    procedure :: record
    procedure :: fields
    procedure :: skirt_fields
  end type film_snapshots_t

contains

  !> Prepare for a scene that is ready to run.
  subroutine prepare(self, times, scene)
    class(film_snapshots_t), intent(inout) :: self
    real(dp), intent(in) :: times(:)   !! requested times, increasing [s]
    type(scene_t), intent(in) :: scene
    self%times = times
    allocate (self%kept(10, size(self%times)*size(scene%joints)), source=0.0_dp)
    allocate (self%skirt(7 + n_corners, size(self%times)), source=0.0_dp)
  end subroutine prepare

  !> Store the motions at the requested times in the last step of the method, up to t_to.
  subroutine record(self, method, scene, t_to, evaluations)
    class(film_snapshots_t), intent(inout) :: self
    class(ode_method_t), intent(inout) :: method
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t_to
    integer, intent(inout) :: evaluations   !! of the scene so far, increased by those made here
    type(evaluation_t) :: now
    type(film_motion_t) :: seen
    real(dp) :: y(scene%n), rate(2), share, thickening
    logical :: in_domain, has_skirt
    integer :: i
    has_skirt = .false.
    if (allocated(scene%guide)) has_skirt = scene%guide%filmed > 0
    do while (self%next <= size(self%times))
      if (self%times(self%next) > t_to) exit
      call evaluate_inside(scene, method, self%times(self%next), y, now, in_domain, evaluations)
      if (in_domain .and. has_skirt) then
        self%n_skirt = self%n_skirt + 1
        associate (it => now%motion%tilting)
          self%skirt(:, self%n_skirt) = [self%times(self%next), now%motion%crank_angle, it%offset, it%tilt, it%offset_rate, &
            it%tilt_rate, now%guide%speed, now%guide%deflection]
        end associate
      end if
      if (in_domain) then
        do i = 1, size(scene%joints)
          if (scene%joints(i)%acting(phase_film) == 0) cycle
          associate (element => scene%joints(i)%slots(scene%joints(i)%acting(phase_film))%element)
            if (.not. element%film%gives_pressure()) cycle
            call element%see_film(now%joint(i), seen, rate, share, thickening)
          end associate
          self%n = self%n + 1
          self%kept(:, self%n) = [self%times(self%next), now%motion%crank_angle, real(i, dp), share*thickening, seen%eccentricity, &
            seen%eccentricity_rate, seen%pin_speed, seen%turning_speed]
        end do
      end if
      self%next = self%next + 1
    end do
  end subroutine record

  !> The pressure fields at the requested times that the run has reached.
  function fields(self, scene) result(all)
    class(film_snapshots_t), intent(in) :: self
    type(scene_t), intent(in) :: scene
    type(film_field_t), allocatable :: all(:)
    type(film_motion_t) :: seen
    integer :: i
    allocate (all(self%n))
    do i = 1, self%n
      associate (kept => self%kept(:, i), field => all(i), joint => scene%joints(nint(self%kept(3, i))))
        field%time = kept(1)
        field%crank_angle = kept(2)
        field%place = joint%spot
        field%clearance = joint%bearing%clearance
        seen = film_motion_t(eccentricity=kept(5:6), eccentricity_rate=kept(7:8), pin_speed=kept(9), turning_speed=kept(10))
        field%distance = norm2(seen%eccentricity)
        field%direction = 0
        if (field%distance > 0) field%direction = atan2(kept(6), kept(5))
        call joint%slots(joint%acting(phase_film))%element%film%pressure_field(seen, field%angle, field%along, field%pressure)
        field%along = 0.5_dp*joint%bearing%length*field%along
        field%pressure = kept(4)*field%pressure
      end associate
    end do
  end function fields

  !> The films of the skirt at these times.
  function skirt_fields(self, scene) result(all)
    class(film_snapshots_t), intent(in) :: self
    type(scene_t), intent(in) :: scene
    type(skirt_field_t), allocatable :: all(:)
    integer :: i
    allocate (all(self%n_skirt))
    do i = 1, self%n_skirt
      associate (kept => self%skirt(:, i), field => all(i))
        field%time = kept(1)
        field%crank_angle = kept(2)
        call scene%guide%slots(scene%guide%filmed)%element%see_faces( &
          face_motion_t(kept(3), kept(4), kept(5), kept(6), kept(7)), kept(8:), field%faces)
      end associate
    end do
  end function skirt_fields
end module film_snapshots
