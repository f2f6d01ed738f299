#include "tests/harness/compare/sample_trace.hpp"

#include <cstdlib>

namespace attest {

std::size_t channel(std::string_view name) {
  const auto found = find_channel(Module::mc_att_control, name);
  if (!found) std::abort();
  return *found;
}

void set(Trace& trace, std::size_t tick, std::string_view name, double value) {
  set_value(channels()[channel(name)], trace.samples[tick], value);
}

Trace sample_trace(std::size_t ticks) {
  Trace trace;
  trace.present = channels_of(Module::mc_att_control);
  const auto table = channels();
  for (std::size_t tick = 0; tick < ticks; ++tick) {
    Sample sample{};
    sample.in.timestamp = 4000 * (tick + 1);
    sample.in.control_state.q[0] = 1;
    sample.in.vehicle_attitude_setpoint.q_d[0] = 1;
    sample.in.vehicle_control_mode.flag_control_attitude_enabled = 1;
    if (tick == 0) sample.in.updated = ATTEST_UPDATED_VEHICLE_ATTITUDE_SETPOINT;
    for (std::size_t i = 0; i < table.size(); ++i) {
      if (!table[i].is_output() || !trace.present[i]) continue;
      const bool is_flag = table[i].type == ChannelType::u8;
      const double value = 0.01 * static_cast<double>(i) - 0.001 * static_cast<double>(tick);
      set_value(table[i], sample, is_flag ? 1 : value);
    }
    trace.samples.push_back(sample);
  }
  return trace;
}

}  // namespace attest
