!> The accuracy levels of the command line, as values of keys of the case. They were chosen by measurement:
!> scripts/measure_tradeoff.py --presets reports the errors that each level has in shipped cases; scripts/record.py writes them to
!> data/measured/presets.md.
module accuracy_presets
  implicit none
  private
  public :: with_preset

  integer, parameter :: n_keys = 5, preset_length = 40

contains

  !> The keys of an accuracy level, followed by the overrides of the command line, so that explicit values take precedence. The
  !> method is `auto`; otherwise the cost of a level would depend more on the method of the case than on the level. The accuracy of
  !> quadratures inside the models (the oscillating film, the gas tables) follows the tolerance. An empty level adds nothing.
  pure function with_preset(level, overrides) result(all)
    character(len=*), intent(in) :: level           !! draft, standard, reference or empty
    character(len=*), intent(in) :: overrides(:)    !! GROUP.KEY=VALUE
    character(len=:), allocatable :: all(:)
    character(len=*), parameter :: levels(3) = ['draft    ', 'standard ', 'reference']
    character(len=*), parameter :: tolerances(3) = ['1e-4 ', '1e-6 ', '1e-10']
    if (level == '') then
      allocate (all, source=overrides)
      return
    end if
    allocate (character(len=max(preset_length, len(overrides))) :: all(n_keys + size(overrides)))
    all(:n_keys) = [character(len=preset_length) :: 'integrator.method=auto', 'integrator.max_order=12', &
      'integrator.contact_entry=root', 'integrator.absolute_tolerance=0', &
      'integrator.relative_tolerance='//tolerances(findloc(levels == level, .true., 1))]
    all(n_keys + 1:) = overrides
  end function with_preset
end module accuracy_presets
