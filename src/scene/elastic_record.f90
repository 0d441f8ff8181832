!> Records the largest deflection, stretch and strain energy of an elastic rod and the largest twist of an elastic crankshaft.
!>
!> All of them follow from the state alone. Peaks inside a step are therefore searched on the interpolant of the method, without
!> evaluations of the scene.
module elastic_record
  use kinds, only: dp
  use ode_method, only: ode_method_t
  use chain_motion, only: motion_t
  use scene_problem, only: scene_t, evaluation_t
  use peak_search, only: sample_t, peak_search_t, may_peak
  use run_figures, only: elastic_figures_t
  implicit none
  private
  public :: elastic_record_t

  !> The quantities: indices into arrays of values. Deflection, stretch and twist have either sign, and are searched for both.
  integer, parameter :: of_deflection = 1, of_stretch = 2, of_energy = 3, of_twist = 4, n_peaks = 4

  type :: elastic_record_t
    logical :: is_present = .false.      !! the scene has elastic members
    real(dp), private :: t = 0         !! end of the last interval that was searched [s]
    real(dp), private :: last(n_peaks) = 0   !! the quantities at that time
    real(dp), private :: rate(n_peaks) = 0   !! and their rates
  contains
    procedure, non_overridable :: prepare
    procedure, non_overridable :: begin
    procedure, non_overridable :: search
    procedure, non_overridable :: record_values
  end type elastic_record_t

contains

  !> Prepare the record for a scene, and compute the natural frequencies of its members.
  subroutine prepare(self, scene, figures)
    class(elastic_record_t), intent(out) :: self
    type(scene_t), intent(in) :: scene
    type(elastic_figures_t), intent(inout) :: figures
    self%is_present = allocated(scene%chain%elastic)
    if (.not. self%is_present) return
    if (scene%chain%has_elastic_rod()) then
      figures%bending_frequency = scene%chain%elastic%rod%bending_frequency()
      figures%axial_frequency = scene%chain%elastic%rod%axial_frequency(scene%chain%bodies%piston%mass)
    end if
    if (scene%chain%has_crankshaft()) figures%twist_frequency = scene%twist_frequency()
  end subroutine prepare

  !> Let the first interval begin at t, where the scene has been evaluated.
  pure subroutine begin(self, scene, t, now)
    class(elastic_record_t), intent(inout) :: self
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t
    type(evaluation_t), intent(in) :: now
    if (.not. self%is_present) return
    self%t = t
    call find_values(scene, now%motion, self%last, self%rate)
  end subroutine begin

  !> Search the peaks between the end of the last interval and t, where the scene is evaluated. Both must lie inside the last step
  !> of the method.
  subroutine search(self, method, scene, t, now, figures)
    class(elastic_record_t), intent(inout) :: self
    class(ode_method_t), intent(inout) :: method
    type(scene_t), intent(in) :: scene
    real(dp), intent(in) :: t
    type(evaluation_t), intent(in) :: now
    type(elastic_figures_t), intent(inout) :: figures
    real(dp) :: values(n_peaks), rates(n_peaks)
    if (.not. self%is_present) return
    call find_values(scene, now%motion, values, rates)
    if (t > self%t) then
      call search_both(of_deflection, figures%mid_deflection)
      call search_both(of_stretch, figures%stretch)
      call search_one(of_energy, 1.0_dp, figures%strain_energy)
      call search_both(of_twist, figures%twist)
    end if
    self%t = t
    self%last = values
    self%rate = rates

  contains

    subroutine search_both(quantity, largest)
      integer, intent(in) :: quantity
      real(dp), intent(inout) :: largest
      call search_one(quantity, 1.0_dp, largest)
      call search_one(quantity, -1.0_dp, largest)
    end subroutine search_both

    subroutine search_one(quantity, sign_of_peak, largest)
      integer, intent(in) :: quantity
      real(dp), intent(in) :: sign_of_peak
      real(dp), intent(inout) :: largest
      call search_between(method, scene, quantity, sign_of_peak, &
        sample_t(self%t, sign_of_peak*self%last(quantity), sign_of_peak*self%rate(quantity)), &
        sample_t(t, sign_of_peak*values(quantity), sign_of_peak*rates(quantity)), largest)
    end subroutine search_one
  end subroutine search

  !> Search the peak of a quantity, or of its negative, between two samples, if it may exceed the largest value so far.
  subroutine search_between(method, scene, quantity, sign_of_peak, left, right, largest)
    class(ode_method_t), intent(inout) :: method
    type(scene_t), intent(in) :: scene
    integer, intent(in) :: quantity
    real(dp), intent(in) :: sign_of_peak
    type(sample_t), intent(in) :: left, right
    real(dp), intent(inout) :: largest
    type(peak_search_t) :: peak
    type(motion_t) :: motion
    real(dp) :: t, y(scene%n), values(n_peaks), rates(n_peaks)
    logical :: is_done
    largest = max(largest, left%value, right%value)
    if (.not. may_peak(left%t, left%value, left%slope, right%t, right%value, right%slope, largest)) return
    call peak%begin(left, right)
    do
      call peak%next_time(t, is_done)
      if (is_done) exit
      call method%interpolate(t, y)
      call scene%chain%elastic%read_state(t, y, motion)
      motion%crank_angle = scene%crank_angle(t, y)
      motion%crank_speed = scene%crank_speed(t, y)
      call find_values(scene, motion, values, rates)
      call peak%add_value(t, sign_of_peak*values(quantity))
    end do
    largest = max(largest, peak%value(1))
  end subroutine search_between

  !> Account for the values of one evaluation.
  pure subroutine record_values(self, scene, now, figures)
    class(elastic_record_t), intent(in) :: self
    type(scene_t), intent(in) :: scene
    type(evaluation_t), intent(in) :: now
    type(elastic_figures_t), intent(inout) :: figures
    real(dp) :: values(n_peaks), rates(n_peaks)
    if (.not. self%is_present) return
    call find_values(scene, now%motion, values, rates)
    figures%mid_deflection = max(figures%mid_deflection, abs(values(of_deflection)))
    figures%stretch = max(figures%stretch, abs(values(of_stretch)))
    figures%strain_energy = max(figures%strain_energy, values(of_energy))
    figures%twist = max(figures%twist, abs(values(of_twist)))
  end subroutine record_values

  !> The quantities and their rates in one motion, of which crank, shapes and flywheel are read; 0 for a member that is not elastic.
  pure subroutine find_values(scene, motion, values, rates)
    type(scene_t), intent(in) :: scene
    type(motion_t), intent(in) :: motion
    real(dp), intent(out) :: values(n_peaks), rates(n_peaks)
    values = 0
    rates = 0
    if (scene%chain%has_elastic_rod()) then
      associate (rod => scene%chain%elastic%rod)
        values(of_deflection) = rod%mid_deflection(motion%shape)
        rates(of_deflection) = rod%mid_deflection(motion%shape_rate)
        if (rod%n_axial > 0) then
          values(of_stretch) = motion%shape(rod%n_bending + 1)
          rates(of_stretch) = motion%shape_rate(rod%n_bending + 1)
        end if
        values(of_energy) = rod%strain_energy(motion)
        rates(of_energy) = sum(rod%stiffness(:rod%n)*motion%shape(:rod%n)*motion%shape_rate(:rod%n))
      end associate
    end if
    if (scene%chain%has_crankshaft()) then
      values(of_twist) = motion%flywheel_angle - motion%crank_angle
      rates(of_twist) = motion%flywheel_speed - motion%crank_speed
    end if
  end subroutine find_values
end module elastic_record
