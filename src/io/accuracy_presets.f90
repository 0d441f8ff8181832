!> The accuracy levels of the command line, as values of keys of the case. They were chosen by measurement:
!> scripts/measure_tradeoff.py --presets reports the errors that each level has in shipped cases; scripts/record.py writes them to
!> data/measured/presets.md.
module accuracy_presets
  implicit none
  private
  public :: with_preset, preset_length

  integer, parameter :: preset_length = 40

contains

  !> The keys of an accuracy level, followed by the overrides of the command line, so that explicit values take precedence. The
  !> method is `auto`; otherwise the cost of a level would depend more on the method of the case than on the level. The accuracy of
  !> quadratures inside the models (the oscillating film, the gas tables) follows the tolerance. An empty level adds nothing.
  pure function with_preset(level, overrides) result(all)
    character(len=*), intent(in) :: level           !! draft, standard, reference or empty
    character(len=*), intent(in) :: overrides(:)    !! GROUP.KEY=VALUE
    character(len=:), allocatable :: all(:)
    character(len=preset_length) :: preset(5)
    integer :: i, n

    preset = [character(len=preset_length) :: 'integrator.method=auto', 'integrator.max_order=12', &
      'integrator.contact_entry=root', 'integrator.absolute_tolerance=0', '']
    select case (level)
    case ('draft')
      preset(5) = 'integrator.relative_tolerance=1e-4'
    case ('standard')
      preset(5) = 'integrator.relative_tolerance=1e-6'
    case ('reference')
      preset(5) = 'integrator.relative_tolerance=1e-10'
    end select
    n = merge(size(preset), 0, level /= '')
    allocate (character(len=max(preset_length, len(overrides))) :: all(n + size(overrides)))
    do i = 1, n
      all(i) = preset(i)
    end do
    do i = 1, size(overrides)
      all(n + i) = overrides(i)
    end do
  end function with_preset
end module accuracy_presets
