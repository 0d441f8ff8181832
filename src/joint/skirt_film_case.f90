!> The film between skirt and bore in a case: its oil and grid, and the rough surfaces.
module skirt_film_case
  use model_parameters, only: parameter_list_t
  use wall_oil, only: wall_oil_t
  use asperities, only: asperities_t
  implicit none
  private
  public :: skirt_film_case_t, visit_skirt_film

  character(len=*), parameter :: reynolds = 'reynolds', gumbel = 'gumbel'

  type, extends(wall_oil_t) :: skirt_oil_t
    character(len=:), allocatable :: cavitation
    integer :: around = 0, along = 0     !! cells of half of a face, intervals along it
  contains
    procedure :: parameters
  end type skirt_oil_t

  type :: skirt_film_case_t
    type(skirt_oil_t) :: oil
    type(asperities_t), allocatable :: asperities
  contains
    procedure :: cuts_suction
  end type skirt_film_case_t

contains

  !> Declare the groups of the film to a visitor.
  subroutine visit_skirt_film(film, list)
    type(skirt_film_case_t), intent(inout) :: film
    class(parameter_list_t), intent(inout) :: list
    type(asperities_t) :: asperities
    call list%group('guide.lubrication', 'Oil film of the skirt, required with &guide kind = ''lubricated''', .true.)
    call film%oil%parameters(list)
    if (list%sets) call film%oil%oil%read_name()
    call list%group('guide.asperities', 'Rough surfaces of skirt and bore, required with &guide kind = ''lubricated''', .true.)
    call asperities%parameters(list)
    if (list%sets) film%asperities = asperities
    if (list%is_absent()) deallocate (film%asperities)
  end subroutine visit_skirt_film

  subroutine parameters(self, list)
    class(skirt_oil_t), intent(inout) :: self
    class(parameter_list_t), intent(inout) :: list
    call self%wall_oil_t%parameters(list)
    call list%word('cavitation', self%cavitation, reynolds//', '//gumbel, reynolds, &
      'where the film ruptures: reynolds: no suction; gumbel: negative pressures are cut off, cheaper, films half as thick')
    call list%add('around', self%around, 'cells of half of a face around the piston', '>= 3 and <= 32', '6')
    call list%add('along', self%along, 'intervals along a face', '>= 8 and <= 128', '24')
  end subroutine parameters

  pure logical function cuts_suction(self)
    class(skirt_film_case_t), intent(in) :: self
    cuts_suction = self%oil%cavitation == gumbel
  end function cuts_suction
end module skirt_film_case
