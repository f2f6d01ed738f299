#include "harness/host/first_steps.hpp"

#include "harness/loop/open_loop.hpp"
#include "harness/trace/channels.hpp"

namespace attest {
namespace {

Trace level_vehicle(const Rate& rate) {
  Trace trace;
  trace.present = channels_of(Module::mc_att_control);
  for (std::size_t tick = 0; tick < first_steps; ++tick) {
    Sample sample{};
    sample.in.timestamp = timestamp_us(rate.tick(static_cast<std::int64_t>(tick) + 1));
    sample.in.control_state.q[0] = 1;
    sample.in.vehicle_attitude_setpoint.q_d[0] = 1;
    sample.in.vehicle_attitude_setpoint.thrust = 0.5f;
    sample.in.vehicle_control_mode.flag_control_attitude_enabled = 1;
    sample.in.vehicle_control_mode.flag_control_rates_enabled = 1;
    sample.in.vehicle_status.is_rotary_wing = 1;
    sample.in.actuator_armed.armed = 1;
    sample.in.battery_status.scale = 1;
    trace.samples.push_back(sample);
  }
  // At the first step all topics are new; at the others only the state.
  for (const Channel& channel : channels()) {
    if (channel.type == ChannelType::bit) set_value(channel, trace.samples[0], 1);
  }
  return trace;
}

}  // namespace

std::string wrong_in_first_steps(const HostOptions& options, const std::string& profile) {
  const auto host = start_host(options);
  if (!host) return host.error().to_string();
  Trace trace = level_vehicle((*host)->says().fixed_step.value_or(Rate::hz(250)));
  const auto fault = (*host)->drive({profile}, trace);
  if (!fault || fault->kind == PortFault::Kind::unsupported) return "";
  return fault->what;
}

}  // namespace attest
