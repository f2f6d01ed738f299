#include "harness/host/smoke_inputs.hpp"

#include <limits>
#include <string_view>

#include "harness/casefile/baseline.hpp"
#include "harness/core/ticks.hpp"
#include "harness/core/time.hpp"

namespace attest {
namespace {

// A law has no topics: all its inputs are new.
bool is_new_in_every_step(const Channel& channel) {
  const ModuleInfo& info = info_of(channel.module);
  return info.is_law() || channel.topic() == info.step_topic;
}

double shaking(std::size_t tick, std::size_t channel) {
  const std::size_t period = 3 + channel % 5;
  const auto half = static_cast<double>(period - 1) / 2;
  return 0.04 * (static_cast<double>(tick % period) - half);
}

double input_at(std::size_t tick, std::size_t index, double timestamp) {
  const Channel& channel = channels()[index];
  if (channel.type == ChannelType::u64) return timestamp;
  if (channel.type == ChannelType::bit) return tick == 0 ? 1 : 0;
  const double value = baseline(channel);
  const bool moves = is_new_in_every_step(channel) &&
                     (channel.quantity == Quantity::rate || channel.name.ends_with(".q[1]"));
  return moves ? value + shaking(tick, index) : value;
}

}  // namespace

Trace shaken_vehicle(Module module, const Rate& rate, std::size_t steps) {
  Trace trace;
  trace.present = channels_of(module);
  const ChannelSet inputs = channels_of(module, "in/");
  for (std::size_t tick = 0; tick < steps; ++tick) {
    Sample sample;
    sample.in.timestamp = timestamp_us(rate.tick(static_cast<std::int64_t>(tick) + 1));
    for (std::size_t i = 0; i < channels().size(); ++i) {
      if (!inputs[i]) continue;
      set_value(channels()[i], sample, input_at(tick, i, static_cast<double>(sample.in.timestamp)));
    }
    trace.samples.push_back(sample);
  }
  return trace;
}

Trace without_numbers(Trace trace, Module module) {
  const ChannelSet inputs = channels_of(module, "in/");
  for (std::size_t i = 0; i < channels().size(); ++i) {
    const Channel& channel = channels()[i];
    if (!inputs[i] || channel.type != ChannelType::f32 || !is_new_in_every_step(channel)) continue;
    const double value = i % 3 == 0 ? std::numeric_limits<double>::infinity()
                                    : std::numeric_limits<double>::quiet_NaN();
    for (Sample& sample : trace.samples) set_value(channel, sample, value);
  }
  return trace;
}

std::vector<std::string> expected_topics(Module module) {
  switch (module) {
    case Module::attitude_unit:
    case Module::attitude_law:
      return {"vehicle_rates_setpoint"};
    case Module::rate_law:
      return {"vehicle_torque_setpoint", "rate_ctrl_status"};
    case Module::rate_unit:
      return {"vehicle_torque_setpoint", "vehicle_thrust_setpoint"};
    default:
      return {"vehicle_rates_setpoint", "actuator_controls_0"};
  }
}

std::string known_parameter(Module module) {
  return module == Module::rate_unit ? "MC_ROLLRATE_P" : "MC_ROLL_P";
}

}  // namespace attest
