!> The cycles of the gas that a case can name. A new one needs a `use` line and a line with its name below.
module gas_laws
  use model_parameters, only: parameter_list_t
  use four_stroke, only: four_stroke_t
  use two_stroke, only: two_stroke_t
  use compressor, only: compressor_t
  implicit none
  private
  public :: offer_gas_cycles

contains

  !> Declare all cycles to a visitor, in the order of the template.
  subroutine offer_gas_cycles(list)
    class(parameter_list_t), intent(inout) :: list
    call list%law('four_stroke', four_stroke_t())
    call list%law('two_stroke', two_stroke_t())
    call list%law('compressor', compressor_t())
  end subroutine offer_gas_cycles
end module gas_laws
