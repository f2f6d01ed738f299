#include "harness/compare/followed_setpoint.hpp"

namespace attest {
namespace {

AttitudeQuaternion quaternion(const float (&q)[4]) { return {q[0], q[1], q[2], q[3]}; }

// The setpoint, if it is new at this tick or this is the first tick; otherwise null.
const float (*new_setpoint(const Sample& tick, Module module, bool is_first))[4] {
  if (module == Module::mc_att_control) {
    const bool is_new = (tick.in.updated & ATTEST_UPDATED_VEHICLE_ATTITUDE_SETPOINT) != 0;
    return is_new || is_first ? &tick.in.vehicle_attitude_setpoint.q_d : nullptr;
  }
  const auto& own = tick.attitude_out.vehicle_attitude_setpoint;
  if (own.published != 0) return &own.q_d;
  const bool is_new = (tick.in.updated & ATTEST_ATTITUDE_UPDATED_VEHICLE_ATTITUDE_SETPOINT) != 0;
  return is_new || is_first ? &tick.attitude_in.vehicle_attitude_setpoint.q_d : nullptr;
}

}  // namespace

bool follows_attitude(Module module) {
  return module == Module::mc_att_control || module == Module::attitude_unit;
}

AttitudeQuaternion attitude_at(const Sample& tick, Module module) {
  return quaternion(module == Module::mc_att_control ? tick.in.control_state.q
                                                     : tick.attitude_in.vehicle_attitude.q);
}

bool uses_attitude_law(const Sample& tick, Module module) {
  return module == Module::mc_att_control
             ? tick.in.vehicle_control_mode.flag_control_attitude_enabled != 0
             : tick.attitude_out.vehicle_rates_setpoint.published != 0;
}

void FollowedSetpoint::next(const Sample& want) {
  if (const auto* q_d = new_setpoint(want, module_, is_first_)) q_d_ = quaternion(*q_d);
  is_first_ = false;
}

}  // namespace attest
