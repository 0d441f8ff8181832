!> Oils by name. A grade is a window of viscosities and not an oil: each name stands for a typical oil of its grade.
!>
!> ISO VG (ISO 3448): the kinematic viscosity at 40 degrees C is the number, within 10 %; that at 100 degrees C is of a typical
!> mineral oil. SAE single grades have the viscosities of the ISO grades that public tables of equivalents name beside them.
!> Multigrades, and all densities, are typical of data sheets. Each SAE grade is within SAE J300 (2015) at 100 degrees C.
module named_oils
  use kinds, only: dp
  use text_tools, only: lowercase, likely_word
  implicit none
  private
  public :: named_oil_t, oils, sources, known_temperatures, find_oil, unknown_oil

  real(dp), parameter :: known_temperatures(2) = [313.15_dp, 373.15_dp]   !! 40 and 100 degrees C [K]

  integer, parameter :: of_grade = 1, of_equivalent = 2, of_sheet = 3
  !> Where the viscosities come from.
  character(len=*), parameter :: sources(3) = [character(len=60) :: 'ISO 3448; at 100 degrees C a typical mineral oil', &
    'that of the ISO grade in tables of equivalents', 'typical of data sheets, in the window of SAE J300']

  type :: named_oil_t
    character(len=10) :: name = ''
    real(dp) :: viscosities(2) = 0      !! kinematic, at `known_temperatures` [m^2/s]
    real(dp) :: density = 0             !! at 15 degrees C [kg/m^3]
    integer :: source = 0               !! index into `sources`
  end type named_oil_t

  type(named_oil_t), parameter :: oils(*) = [ &
    named_oil_t('ISO VG 10', [10.0e-6_dp, 2.5e-6_dp], 860.0_dp, of_grade), &
    named_oil_t('ISO VG 15', [15.0e-6_dp, 3.5e-6_dp], 862.0_dp, of_grade), &
    named_oil_t('ISO VG 22', [22.0e-6_dp, 4.5e-6_dp], 865.0_dp, of_grade), &
    named_oil_t('ISO VG 32', [32.0e-6_dp, 5.5e-6_dp], 870.0_dp, of_grade), &
    named_oil_t('ISO VG 46', [46.0e-6_dp, 6.5e-6_dp], 875.0_dp, of_grade), &
    named_oil_t('ISO VG 68', [68.0e-6_dp, 8.5e-6_dp], 880.0_dp, of_grade), &
    named_oil_t('ISO VG 100', [100.0e-6_dp, 11.4e-6_dp], 885.0_dp, of_grade), &
    named_oil_t('ISO VG 150', [150.0e-6_dp, 14.5e-6_dp], 890.0_dp, of_grade), &
    named_oil_t('ISO VG 220', [220.0e-6_dp, 19.0e-6_dp], 894.0_dp, of_grade), &
    named_oil_t('ISO VG 320', [320.0e-6_dp, 24.5e-6_dp], 898.0_dp, of_grade), &
    named_oil_t('ISO VG 460', [460.0e-6_dp, 32.0e-6_dp], 902.0_dp, of_grade), &
    named_oil_t('ISO VG 680', [680.0e-6_dp, 42.0e-6_dp], 906.0_dp, of_grade), &
    named_oil_t('SAE 10W', [32.0e-6_dp, 5.5e-6_dp], 870.0_dp, of_equivalent), &
    named_oil_t('SAE 20', [68.0e-6_dp, 8.5e-6_dp], 880.0_dp, of_equivalent), &
    named_oil_t('SAE 30', [100.0e-6_dp, 11.4e-6_dp], 885.0_dp, of_equivalent), &
    named_oil_t('SAE 40', [150.0e-6_dp, 14.5e-6_dp], 890.0_dp, of_equivalent), &
    named_oil_t('SAE 50', [220.0e-6_dp, 19.0e-6_dp], 894.0_dp, of_equivalent), &
    named_oil_t('SAE 60', [320.0e-6_dp, 24.5e-6_dp], 898.0_dp, of_equivalent), &
    named_oil_t('SAE 0W-20', [44.0e-6_dp, 8.3e-6_dp], 846.0_dp, of_sheet), &
    named_oil_t('SAE 0W-30', [62.0e-6_dp, 11.6e-6_dp], 848.0_dp, of_sheet), &
    named_oil_t('SAE 5W-20', [48.0e-6_dp, 8.5e-6_dp], 852.0_dp, of_sheet), &
    named_oil_t('SAE 5W-30', [66.0e-6_dp, 11.2e-6_dp], 855.0_dp, of_sheet), &
    named_oil_t('SAE 5W-40', [85.0e-6_dp, 14.0e-6_dp], 855.0_dp, of_sheet), &
    named_oil_t('SAE 10W-30', [69.0e-6_dp, 10.7e-6_dp], 870.0_dp, of_sheet), &
    named_oil_t('SAE 10W-40', [95.0e-6_dp, 14.2e-6_dp], 868.0_dp, of_sheet), &
    named_oil_t('SAE 15W-40', [110.0e-6_dp, 14.6e-6_dp], 880.0_dp, of_sheet), &
    named_oil_t('SAE 20W-50', [165.0e-6_dp, 18.5e-6_dp], 886.0_dp, of_sheet)]

contains

  !> The oil of a name in any case, with or without blanks, hyphens, ISO and, before a multigrade, SAE; one without name if there is
  !> none.
  pure type(named_oil_t) function find_oil(name) result(oil)
    character(len=*), intent(in) :: name
    character(len=:), allocatable :: wanted, known
    integer :: i
    wanted = plain(name)
    do i = 1, size(oils)
      oil = oils(i)
      known = plain(oil%name)
      if (wanted == known) return
      if (wanted == known(4:) .and. verify(wanted, '0123456789') > 0) return   ! VG46, 10W40
    end do
    oil = named_oil_t()
  end function find_oil

  !> What is wrong with a name that no oil has.
  pure function unknown_oil(name) result(wanted)
    character(len=*), intent(in) :: name
    character(len=:), allocatable :: wanted, names
    integer :: i
    wanted = 'unknown oil; one of ISO VG 10 to 680, SAE 10W, 20 to 60, 0W-20 to 20W-50 (gudgeon --reference oils)'
    names = ''
    do i = 1, size(oils)
      names = names//plain(oils(i)%name)//' '
    end do
    names = likely_word(plain(name), names)
    if (names == '') return
    i = findloc([(index(names, ' '//plain(oils(i)%name)//'?') > 0, i=1, size(oils))], .true., 1)
    wanted = wanted//'; did you mean '//trim(oils(i)%name)//'?'
  end function unknown_oil

  !> A name in lower case without blanks and hyphens.
  pure function plain(name)
    character(len=*), intent(in) :: name
    character(len=:), allocatable :: plain
    integer :: i
    plain = ''
    do i = 1, len(name)
      if (name(i:i) /= ' ' .and. name(i:i) /= '-') plain = plain//lowercase(name(i:i))
    end do
  end function plain
end module named_oils
