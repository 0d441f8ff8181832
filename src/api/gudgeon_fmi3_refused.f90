!> The functions of FMI 3.0 that a unit does not offer; they return an error, and ignore their arguments.
module gudgeon_fmi3_refused
  use, intrinsic :: iso_c_binding, only: c_int
  use fmi_instance, only: fmi_error
  implicit none
  private

contains

  integer(c_int) function enter_event_mode() bind(c, name='fmi3EnterEventMode') result(no)
    no = fmi_error
  end function enter_event_mode

  integer(c_int) function get_float32() bind(c, name='fmi3GetFloat32') result(no)
    no = fmi_error
  end function get_float32

  integer(c_int) function get_int8() bind(c, name='fmi3GetInt8') result(no)
    no = fmi_error
  end function get_int8

  integer(c_int) function getuint8() bind(c, name='fmi3GetUInt8') result(no)
    no = fmi_error
  end function getuint8

  integer(c_int) function get_int16() bind(c, name='fmi3GetInt16') result(no)
    no = fmi_error
  end function get_int16

  integer(c_int) function getuint16() bind(c, name='fmi3GetUInt16') result(no)
    no = fmi_error
  end function getuint16

  integer(c_int) function getuint32() bind(c, name='fmi3GetUInt32') result(no)
    no = fmi_error
  end function getuint32

  integer(c_int) function get_int64() bind(c, name='fmi3GetInt64') result(no)
    no = fmi_error
  end function get_int64

  integer(c_int) function getuint64() bind(c, name='fmi3GetUInt64') result(no)
    no = fmi_error
  end function getuint64

  integer(c_int) function get_string() bind(c, name='fmi3GetString') result(no)
    no = fmi_error
  end function get_string

  integer(c_int) function get_binary() bind(c, name='fmi3GetBinary') result(no)
    no = fmi_error
  end function get_binary

  integer(c_int) function get_clock() bind(c, name='fmi3GetClock') result(no)
    no = fmi_error
  end function get_clock

  integer(c_int) function set_float32() bind(c, name='fmi3SetFloat32') result(no)
    no = fmi_error
  end function set_float32

  integer(c_int) function set_int8() bind(c, name='fmi3SetInt8') result(no)
    no = fmi_error
  end function set_int8

  integer(c_int) function setuint8() bind(c, name='fmi3SetUInt8') result(no)
    no = fmi_error
  end function setuint8

  integer(c_int) function set_int16() bind(c, name='fmi3SetInt16') result(no)
    no = fmi_error
  end function set_int16

  integer(c_int) function setuint16() bind(c, name='fmi3SetUInt16') result(no)
    no = fmi_error
  end function setuint16

  integer(c_int) function setuint32() bind(c, name='fmi3SetUInt32') result(no)
    no = fmi_error
  end function setuint32

  integer(c_int) function set_int64() bind(c, name='fmi3SetInt64') result(no)
    no = fmi_error
  end function set_int64

  integer(c_int) function setuint64() bind(c, name='fmi3SetUInt64') result(no)
    no = fmi_error
  end function setuint64

  integer(c_int) function set_string() bind(c, name='fmi3SetString') result(no)
    no = fmi_error
  end function set_string

  integer(c_int) function set_binary() bind(c, name='fmi3SetBinary') result(no)
    no = fmi_error
  end function set_binary

  integer(c_int) function set_clock() bind(c, name='fmi3SetClock') result(no)
    no = fmi_error
  end function set_clock

  integer(c_int) function get_number_of_variable_dependencies() bind(c, name='fmi3GetNumberOfVariableDependencies') result(no)
    no = fmi_error
  end function get_number_of_variable_dependencies

  integer(c_int) function get_variable_dependencies() bind(c, name='fmi3GetVariableDependencies') result(no)
    no = fmi_error
  end function get_variable_dependencies

  integer(c_int) function serialized_state_size() bind(c, name='fmi3SerializedFMUStateSize') result(no)
    no = fmi_error
  end function serialized_state_size

  integer(c_int) function serialize_state() bind(c, name='fmi3SerializeFMUState') result(no)
    no = fmi_error
  end function serialize_state

  integer(c_int) function deserialize_state() bind(c, name='fmi3DeserializeFMUState') result(no)
    no = fmi_error
  end function deserialize_state

  integer(c_int) function get_directional_derivative() bind(c, name='fmi3GetDirectionalDerivative') result(no)
    no = fmi_error
  end function get_directional_derivative

  integer(c_int) function get_adjoint_derivative() bind(c, name='fmi3GetAdjointDerivative') result(no)
    no = fmi_error
  end function get_adjoint_derivative

  integer(c_int) function enter_configuration_mode() bind(c, name='fmi3EnterConfigurationMode') result(no)
    no = fmi_error
  end function enter_configuration_mode

  integer(c_int) function exit_configuration_mode() bind(c, name='fmi3ExitConfigurationMode') result(no)
    no = fmi_error
  end function exit_configuration_mode

  integer(c_int) function get_interval_decimal() bind(c, name='fmi3GetIntervalDecimal') result(no)
    no = fmi_error
  end function get_interval_decimal

  integer(c_int) function get_interval_fraction() bind(c, name='fmi3GetIntervalFraction') result(no)
    no = fmi_error
  end function get_interval_fraction

  integer(c_int) function get_shift_decimal() bind(c, name='fmi3GetShiftDecimal') result(no)
    no = fmi_error
  end function get_shift_decimal

  integer(c_int) function get_shift_fraction() bind(c, name='fmi3GetShiftFraction') result(no)
    no = fmi_error
  end function get_shift_fraction

  integer(c_int) function set_interval_decimal() bind(c, name='fmi3SetIntervalDecimal') result(no)
    no = fmi_error
  end function set_interval_decimal

  integer(c_int) function set_interval_fraction() bind(c, name='fmi3SetIntervalFraction') result(no)
    no = fmi_error
  end function set_interval_fraction

  integer(c_int) function set_shift_decimal() bind(c, name='fmi3SetShiftDecimal') result(no)
    no = fmi_error
  end function set_shift_decimal

  integer(c_int) function set_shift_fraction() bind(c, name='fmi3SetShiftFraction') result(no)
    no = fmi_error
  end function set_shift_fraction

  integer(c_int) function evaluate_discrete_states() bind(c, name='fmi3EvaluateDiscreteStates') result(no)
    no = fmi_error
  end function evaluate_discrete_states

  integer(c_int) function update_discrete_states() bind(c, name='fmi3UpdateDiscreteStates') result(no)
    no = fmi_error
  end function update_discrete_states

  integer(c_int) function enter_continuous_time_mode() bind(c, name='fmi3EnterContinuousTimeMode') result(no)
    no = fmi_error
  end function enter_continuous_time_mode

  integer(c_int) function completed_integrator_step() bind(c, name='fmi3CompletedIntegratorStep') result(no)
    no = fmi_error
  end function completed_integrator_step

  integer(c_int) function set_time() bind(c, name='fmi3SetTime') result(no)
    no = fmi_error
  end function set_time

  integer(c_int) function set_continuous_states() bind(c, name='fmi3SetContinuousStates') result(no)
    no = fmi_error
  end function set_continuous_states

  integer(c_int) function get_continuous_state_derivatives() bind(c, name='fmi3GetContinuousStateDerivatives') result(no)
    no = fmi_error
  end function get_continuous_state_derivatives

  integer(c_int) function get_event_indicators() bind(c, name='fmi3GetEventIndicators') result(no)
    no = fmi_error
  end function get_event_indicators

  integer(c_int) function get_continuous_states() bind(c, name='fmi3GetContinuousStates') result(no)
    no = fmi_error
  end function get_continuous_states

  integer(c_int) function get_nominals_of_continuous_states() bind(c, name='fmi3GetNominalsOfContinuousStates') result(no)
    no = fmi_error
  end function get_nominals_of_continuous_states

  integer(c_int) function get_number_of_event_indicators() bind(c, name='fmi3GetNumberOfEventIndicators') result(no)
    no = fmi_error
  end function get_number_of_event_indicators

  integer(c_int) function get_number_of_continuous_states() bind(c, name='fmi3GetNumberOfContinuousStates') result(no)
    no = fmi_error
  end function get_number_of_continuous_states

  integer(c_int) function enter_step_mode() bind(c, name='fmi3EnterStepMode') result(no)
    no = fmi_error
  end function enter_step_mode

  integer(c_int) function get_output_derivatives() bind(c, name='fmi3GetOutputDerivatives') result(no)
    no = fmi_error
  end function get_output_derivatives

  integer(c_int) function activate_model_partition() bind(c, name='fmi3ActivateModelPartition') result(no)
    no = fmi_error
  end function activate_model_partition
end module gudgeon_fmi3_refused
