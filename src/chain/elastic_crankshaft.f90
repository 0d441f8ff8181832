!> A crankshaft with torsional elasticity: one end is the crank, the other a flywheel, on which the drive acts.
!>
!>     J_f q_f'' = tau - D q_f' - M_s,    M_s = k_t (q_f - q) + c_t (q_f' - q')
!>
!> The moment M_s acts on the crank in place of the drive. If the speed is prescribed, it is that of the flywheel, and the crank
!> oscillates about it.
module elastic_crankshaft
  use kinds, only: dp
  use model_parameters, only: has_parameters_t, parameter_list_t
  use chain_motion, only: motion_t
  use chain_bodies, only: drive_t, undriven
  implicit none
  private
  public :: elastic_crankshaft_t

  type, extends(has_parameters_t) :: elastic_crankshaft_t
    real(dp) :: flywheel_inertia = 0      !! J_f [kg m^2]
    real(dp) :: stiffness = 0             !! k_t [N m/rad]
    real(dp) :: damping = 0               !! c_t [N m s/rad]
  contains
    procedure :: parameters
    procedure :: moment
    procedure :: drive_of_crank
    procedure :: accelerate_flywheel
    procedure :: energy
    procedure :: damping_power
    procedure :: natural_frequency
  end type elastic_crankshaft_t

contains

  subroutine parameters(self, list)
    class(elastic_crankshaft_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call list%add('flywheel_inertia', self%flywheel_inertia, &
      'moment of inertia of the flywheel at the driven end', 'kg m^2', '> 0', default='0.0', example='0.02', &
      usual='1e-7 to 1e6')
    call list%add('torsional_stiffness', self%stiffness, &
      'torsional stiffness between flywheel and crank', 'N m/rad', '> 0', default='0.0', example='2.0e4', usual='10 to 1e9')
    call list%add('torsional_damping', self%damping, 'damping moment per rate of twist', 'N m s/rad', '>= 0', default='0.0', &
      usual='0 to 1e4')
  end subroutine parameters

  !> Moment of the shaft on the crank [N m].
  pure real(dp) function moment(self, motion)
    class(elastic_crankshaft_t), intent(in) :: self
    type(motion_t), intent(in) :: motion
    moment = self%stiffness*(motion%flywheel_angle - motion%crank_angle) &
      + self%damping*(motion%flywheel_speed - motion%crank_speed)
  end function moment

  !> The drive of the crank by the shaft.
  pure type(drive_t) function drive_of_crank(self, motion) result(drive)
    class(elastic_crankshaft_t), intent(in) :: self
    type(motion_t), intent(in) :: motion
    drive = undriven
    drive%torque = self%moment(motion)
  end function drive_of_crank

  !> Acceleration of the flywheel [rad/s^2] and moment of the drive on it [N m].
  pure subroutine accelerate_flywheel(self, drive, motion, acceleration, drive_moment)
    class(elastic_crankshaft_t), intent(in) :: self
    type(drive_t), intent(in) :: drive
    type(motion_t), intent(in) :: motion
    real(dp), intent(out) :: acceleration, drive_moment
    real(dp) :: against
    against = self%moment(motion) + drive%damping*motion%flywheel_speed
    if (drive%free_crank) then
      drive_moment = drive%torque
      acceleration = (drive%torque - against)/self%flywheel_inertia
    else
      drive_moment = against + self%flywheel_inertia*drive%acceleration
      acceleration = drive%acceleration
    end if
  end subroutine accelerate_flywheel

  !> Elastic energy of the twist and kinetic energy of the flywheel [J].
  pure real(dp) function energy(self, motion)
    class(elastic_crankshaft_t), intent(in) :: self
    type(motion_t), intent(in) :: motion
    energy = 0.5_dp*self%stiffness*(motion%flywheel_angle - motion%crank_angle)**2 &
      + 0.5_dp*self%flywheel_inertia*motion%flywheel_speed**2
  end function energy

  !> Power of the damping on crank and flywheel [W], <= 0.
  pure real(dp) function damping_power(self, motion)
    class(elastic_crankshaft_t), intent(in) :: self
    type(motion_t), intent(in) :: motion
    damping_power = -self%damping*(motion%flywheel_speed - motion%crank_speed)**2
  end function damping_power

  !> Natural frequency of crank and flywheel on the shaft [rad/s]. `crank_inertia` includes everything that moves with the crank;
  !> `is_held`: the speed of the flywheel is prescribed.
  pure real(dp) function natural_frequency(self, crank_inertia, is_held)
    class(elastic_crankshaft_t), intent(in) :: self
    real(dp), intent(in) :: crank_inertia   !! [kg m^2]
    logical, intent(in) :: is_held
    natural_frequency = sqrt(self%stiffness*(1/crank_inertia + merge(0.0_dp, 1/self%flywheel_inertia, is_held)))
  end function natural_frequency
end module elastic_crankshaft
