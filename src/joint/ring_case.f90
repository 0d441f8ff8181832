!> The rings of a piston in a case: each ring, their oil, and the rough surfaces of rings and bore.
module ring_case
  use kinds, only: dp
  use model_parameters, only: has_parameters_t, parameter_list_t
  use wall_oil, only: wall_oil_t
  use asperities, only: asperities_t
  implicit none
  private
  public :: ring_case_t, ring_pack_t, visit_rings, most_piston_rings

  integer, parameter :: most_piston_rings = 6
  character(len=*), parameter :: closed_form = 'closed_form', film = 'film'   !! the models

  type, extends(has_parameters_t) :: ring_case_t
    logical :: is_first = .false.          !! from the top: by default the gas of the cylinder acts on it
    character(len=:), allocatable :: model
    real(dp) :: height = 0                 !! of the running face, along the axis [m]
    real(dp) :: crown = 0                  !! relief of the face at its edges [m]
    real(dp) :: tension = 0                !! tangential force that closes its gap [N]
    real(dp) :: gas_above = 0, gas_behind = 0, gas_below = 0   !! pressures there, over that of the cylinder; both above the
                                                               !! crankcase
    real(dp) :: crown_offset = 0           !! of the crown above the middle of the face [m]
    real(dp) :: start_film = 0             !! least gap at t = 0 [m]
  contains
    procedure :: parameters => ring_parameters
    procedure :: has_film
  end type ring_case_t

  type, extends(wall_oil_t) :: ring_oil_t
    integer :: along = 0   !! intervals of a face with a film
  contains
    procedure :: parameters => oil_parameters
  end type ring_oil_t

  !> All rings of the piston.
  type :: ring_pack_t
    type(ring_case_t), allocatable :: rings(:)         !! from the top; not allocated: the piston has none
    type(ring_oil_t) :: oil
    type(asperities_t), allocatable :: asperities      !! not allocated: smooth surfaces
  end type ring_pack_t

contains

  !> Declare the groups of the rings to a visitor.
  subroutine visit_rings(pack, list)
    type(ring_pack_t), intent(inout) :: pack
    class(parameter_list_t), intent(inout) :: list
    type(ring_case_t) :: found(most_piston_rings), one
    type(asperities_t) :: asperities
    integer :: i, n
    n = 0
    do i = 1, merge(most_piston_rings, 1, list%repeats)
      call list%group('ring', 'Piston rings, a group for each ring from the top: their friction on the bore. Without this '// &
        'group there are none', .true., number=i)
      one%is_first = i == 1
      call one%parameters(list)
      if (.not. (list%sets .and. list%is_present)) cycle
      n = n + 1
      found(n) = one
    end do
    if (list%sets) then
      if (allocated(pack%rings)) deallocate (pack%rings)
      if (n > 0) allocate (pack%rings, source=found(:n))
    end if
    call list%group('rings.lubrication', 'Oil of the piston rings, required with &ring', .true.)
    call pack%oil%parameters(list)
    if (list%sets) call pack%oil%oil%read_name()
    call list%group('rings.asperities', 'Rough surfaces of piston rings and bore. Without this group they are smooth', .true.)
    call asperities%parameters(list)
    if (list%sets) pack%asperities = asperities
    if (list%is_absent()) deallocate (pack%asperities)
  end subroutine visit_rings

  subroutine ring_parameters(self, list)
    class(ring_case_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    character(len=3) :: whole
    whole = merge('1.0', '0.0', self%is_first)
    call list%word('model', self%model, closed_form//', '//film, closed_form, &
      'closed_form: friction of a parabolic face under its load at every instant; film: its film that is squeezed, with a state')
    call list%add('height', self%height, 'axial height of the running face', 'm', '> 0', example='1.2e-3', usual='2e-4 to 1e-2')
    call list%add('crown', self%crown, 'relief of the running face at its edges', 'm', '> 0', example='6.0e-6', &
      usual='1e-6 to 1e-4')
    call list%add('tension', self%tension, 'tangential force that closes the gap of the ring', 'N', '> 0', example='8.0', &
      usual='0.5 to 100')
    call list%add('gas_above', self%gas_above, 'pressure above the ring over that of the cylinder, both less that of the '// &
      'crankcase; default 1 in the first ring, else 0', range='>= 0 and <= 1', default=whole, usual='1e-3 to 1')
    call list%add('gas_behind', self%gas_behind, 'the same behind the ring', range='>= 0 and <= 1', default=whole, &
      usual='1e-3 to 1')
    call list%add('gas_below', self%gas_below, 'the same below the ring', range='>= 0 and <= 1', default='0.0', usual='1e-3 to 1')
    call list%add('crown_offset', self%crown_offset, 'film: crown of the face above its middle, shorter than half its height', &
      'm', default='0.0', usual='1e-6 to 5e-3')
    call list%add('start_film', self%start_film, 'film: smallest film thickness at the start', 'm', '> 0', default='3.0e-6', &
      usual='1e-7 to 1e-4')
  end subroutine ring_parameters

  !> Whether the ring has a film with a state.
  pure logical function has_film(self)
    class(ring_case_t), intent(in) :: self
    has_film = self%model == film
  end function has_film

  subroutine oil_parameters(self, list)
    class(ring_oil_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call self%wall_oil_t%parameters(list)
    call list%add('along', self%along, 'intervals along the face of a ring with model = ''film''', '>= 8 and <= 128', '20')
  end subroutine oil_parameters
end module ring_case
