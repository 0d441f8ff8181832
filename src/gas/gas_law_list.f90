!> The cycles of the gas that a case can name. A new one needs a `use` line and a line in `offer_gas_cycles`.
submodule (gas_laws) gas_law_list
  use four_stroke, only: four_stroke_t
  use two_stroke, only: two_stroke_t
  use compressor, only: compressor_t
  implicit none

contains

  module subroutine offer_gas_cycles(list)
    class(parameter_list_t), intent(inout) :: list
    call list%law(four_stroke_t())
    call list%law(two_stroke_t())
    call list%law(compressor_t())
  end subroutine offer_gas_cycles
end submodule gas_law_list
