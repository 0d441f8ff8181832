!> The accuracy levels of the command line, as values of keys of the case. Those with method `auto` were chosen by measurement:
!> scripts/bench/measure_tradeoff.py --presets reports the errors that each level has in shipped cases (data/measured/presets.md).
!> `dissertation` is the integration of Reis (3.8, 4.4).
module accuracy_presets
  implicit none
  private
  public :: with_preset, accuracy_levels

  !> The names of the levels.
  character(len=*), parameter :: accuracy_levels = 'draft, standard, reference, dissertation'

  integer, parameter :: n_keys = 6, preset_length = 40
  character(len=*), parameter :: draft_period = 'run.periodic_tolerance=1e-3'

contains

  !> The keys of an accuracy level, followed by the overrides of the command line, so that explicit values take precedence. The
  !> method does not depend on that of the case; otherwise the cost of a level would depend more on this than on the level. The
  !> accuracy of quadratures inside the models (the oscillating film, the gas tables) follows the tolerance. Periods of a
  !> periodic motion differ by the errors of the integration, which exceed the usual `periodic_tolerance` in a draft: it gets a
  !> larger one. An empty level adds nothing.
  pure function with_preset(level, overrides) result(all)
    character(len=*), intent(in) :: level           !! one of `accuracy_levels`, or empty
    character(len=*), intent(in) :: overrides(:)    !! GROUP.KEY=VALUE
    character(len=:), allocatable :: all(:)
    character(len=*), parameter :: levels(3) = ['draft    ', 'standard ', 'reference']
    character(len=*), parameter :: tolerances(3) = ['1e-4 ', '1e-6 ', '1e-10']
    if (level == '') then
      allocate (all, source=overrides)
      return
    end if
    allocate (character(len=max(preset_length, len(overrides))) :: all(n_keys + size(overrides)))
    if (level == 'dissertation') then
      all(:n_keys) = [character(len=preset_length) :: 'integrator.method=adams', 'integrator.max_order=12', &
        'integrator.absolute_tolerance=0', 'integrator.relative_tolerance=1e-6', &
        'integrator.contact_entry=step_rejection', 'integrator.max_penetration=1e-9']
    else
      all(:n_keys) = [character(len=preset_length) :: 'integrator.method=auto', 'integrator.max_order=12', &
        'integrator.absolute_tolerance=0', 'integrator.relative_tolerance='//tolerances(findloc(levels == level, .true., 1)), &
        'integrator.contact_entry=root', 'integrator.max_penetration=0']
    end if
    all(n_keys + 1:) = overrides
    if (level == 'draft') all = [character(len=len(all)) :: draft_period, all]
  end function with_preset
end module accuracy_presets
