#include "harness/ulog/own_topics.hpp"

namespace attest::ulog {
namespace {

bool runs(const attest_attitude_inputs& in) {
  const bool flies_as_multicopter =
      (in.vehicle_status.is_rotary_wing != 0 && in.vehicle_status.in_transition_mode == 0) ||
      (in.vehicle_status.is_vtol_tailsitter != 0 && in.vehicle_status.in_transition_mode != 0);
  return in.vehicle_control_mode.flag_control_attitude_enabled != 0 && flies_as_multicopter;
}

bool is_acro(const attest_rate_inputs& in) {
  return in.vehicle_control_mode.flag_control_manual_enabled != 0 &&
         in.vehicle_control_mode.flag_control_attitude_enabled == 0;
}

}  // namespace

bool is_of_sticks(const Sample& sample) {
  const auto& mode = sample.attitude_in.vehicle_control_mode;
  return runs(sample.attitude_in) && mode.flag_control_manual_enabled != 0 &&
         mode.flag_control_altitude_enabled == 0 && mode.flag_control_velocity_enabled == 0 &&
         mode.flag_control_position_enabled == 0;
}

bool publishes(Module module, std::string_view topic, const Sample& sample) {
  if (module == Module::attitude_unit) {
    return topic == "vehicle_attitude_setpoint" ? is_of_sticks(sample) : runs(sample.attitude_in);
  }
  if (module == Module::rate_unit && topic == "vehicle_rates_setpoint") {
    return is_acro(sample.rate_in);
  }
  return true;
}

bool is_in_flight(Module module, const Sample& sample) {
  if (module == Module::attitude_unit) {
    const auto& in = sample.attitude_in;
    return in.vehicle_status.armed != 0 && in.vehicle_land_detected.landed == 0;
  }
  if (module == Module::rate_unit) {
    const auto& in = sample.rate_in;
    return in.vehicle_control_mode.flag_armed != 0 && in.vehicle_land_detected.landed == 0 &&
           in.vehicle_land_detected.maybe_landed == 0;
  }
  return false;
}

}  // namespace attest::ulog
