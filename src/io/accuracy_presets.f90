!> The accuracy levels of the command line, as values of the case. Defined by measurement: scripts/measure_tradeoff.py --presets
!> tells the error that each really gives in every shipped case (data/measured/presets.md).
module accuracy_presets
  implicit none
  private
  public :: with_preset, preset_length

  integer, parameter :: preset_length = 40

contains

  !> The overrides of the command line with those of an accuracy level before them, so that what is set by hand wins. The method is
  !> `auto`: what a level costs would otherwise depend more on the case's method than on the level. What the models
  !> do by quadrature (the oscillating film, the gas tables) follows the tolerance by itself. An empty level adds nothing.
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
