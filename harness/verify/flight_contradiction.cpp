#include "harness/verify/flight_contradiction.hpp"

#include <algorithm>
#include <cstring>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "harness/casefile/stimulus.hpp"
#include "harness/core/agreement.hpp"
#include "harness/core/delay_line.hpp"
#include "harness/loop/unit_task.hpp"
#include "harness/trace/channels.hpp"

namespace attest {
namespace {

constexpr const char* rates_setpoint = "vehicle_rates_setpoint";

bool scripts(const Case& part, std::string_view name) {
  return std::ranges::any_of(part.topics, [&](const auto& topic) { return topic.topic == name; });
}

// The inputs of a unit that only the case sets.
struct Scripted {
  std::vector<std::size_t> channels;
  std::uint32_t updated = ATTEST_UPDATED_PARAMETER_UPDATE;
};

Scripted scripted_in(const Case& part) {
  Scripted scripted;
  for (const TopicStimulus& topic : part.topics) {
    if (part.attitude_loop && topic.topic == rates_setpoint) continue;  // attitude unit sends it
    scripted.updated |= topic.updated_bit;
    for (const FieldStimulus& field : topic.fields) scripted.channels.push_back(field.channel);
    for (const AttitudeStimulus& attitude : topic.attitudes) {
      for (std::size_t i = 0; i < 4; ++i) scripted.channels.push_back(attitude.channel + i);
    }
  }
  return scripted;
}

// The name of the first input that differs from the script; empty if there is none.
std::string_view first_other(const Scripted& scripted, const Sample& flown, const Sample& want) {
  if (flown.in.timestamp != want.in.timestamp) return "timestamp";
  if (((flown.in.updated ^ want.in.updated) & scripted.updated) != 0) return "an updated bit";
  for (const std::size_t channel : scripted.channels) {
    const Channel& input = channels()[channel];
    if (!same_bits(input, flown, want)) return input.name;
  }
  return "";
}

bool same(const ParameterChange& a, const ParameterChange& b) {
  return a.tick == b.tick && a.name == b.name && same_bits(a.value, b.value);
}

// The first contradiction in the trace of one unit. `part`: the case of that unit
// (Case::of_module).
std::string contradicts_case(const Case& part, const Rate& rate, const LoopTiming& timing,
                             const Trace& trace) {
  const std::string_view unit = info_of(part.module).title;
  const Scripted scripted = scripted_in(part);
  Stimulus stimulus(part, rate);
  Sample want{};
  std::vector<ParameterChange> changes;
  for (std::size_t tick = 0; tick < trace.samples.size(); ++tick) {
    stimulus.tick(tick, timing[tick].begins, want, changes);
    const std::string_view other = first_other(scripted, trace.samples[tick], want);
    if (other.empty()) continue;
    return fmt::format("{} at tick {} of the {} is not that of the case", other, tick, unit);
  }
  if (std::ranges::equal(changes, trace.parameters, same)) return "";
  return fmt::format("the parameters of the {} are not those of the case", unit);
}

std::string contradicts_attitude_unit(const FlightTiming& timing, const Flown& flown) {
  const auto& attitude = flown.attitude_trace->samples;
  DelayLine<RatesSetpoint> setpoints(Nanoseconds(0), attitude.size());
  RatesSetpoint want{};
  for (std::size_t tick = 0, sent = 0; tick < flown.trace.samples.size(); ++tick) {
    const Nanoseconds now = timing.unit[tick].begins;
    // At the same instant the rate unit runs before the attitude unit (closed_loop.hpp).
    for (; sent < attitude.size() && timing.attitude_unit[sent].begins < now; ++sent) {
      const auto& arrives = timing.attitude_unit[sent].commanded;
      const auto setpoint = rates_setpoint_of(attitude[sent].attitude_out);
      if (arrives && setpoint) setpoints.send_for(*arrives, *setpoint);
    }
    const auto arrived = setpoints.receive(now);
    if (arrived) want = *arrived;
    const attest_rate_inputs& in = flown.trace.samples[tick].rate_in;
    const bool is_new = (in.updated & ATTEST_RATE_UPDATED_VEHICLE_RATES_SETPOINT) != 0;
    const bool is_same = std::memcmp(&in.vehicle_rates_setpoint, &want, sizeof want) == 0;
    if (is_new == arrived.has_value() && is_same) continue;
    return fmt::format("{} at tick {} of the rate unit is not the attitude unit's output",
                       rates_setpoint, tick);
  }
  return "";
}

bool is_whole(const Trace& trace, const LoopTiming& timing, bool ended_early) {
  return ended_early ? trace.samples.size() <= timing.size()
                     : trace.samples.size() == timing.size();
}

}  // namespace

std::string flight_contradiction(const Course& course, const FlightPlan& plan, const Flown& flown) {
  const Case scripted = bound_to_vehicle(*course.the_case, course.vehicle_model->vehicle());
  const Rate& rate = plan.configuration.rate.motor_unit;
  const bool ended_early = flown.fault || flown.divergence;
  static const Trace none;
  const Trace& attitude = flown.attitude_trace ? *flown.attitude_trace : none;
  if (!is_whole(flown.trace, plan.timing.unit, ended_early) ||
      !is_whole(attitude, plan.timing.attitude_unit, ended_early)) {
    return "the number of ticks is not that of the flight";
  }
  std::string found =
      contradicts_case(scripted.of_module(scripted.module), rate, plan.timing.unit, flown.trace);
  if (!flown.attitude_trace || !found.empty()) return found;
  found = contradicts_case(scripted.of_module(Module::attitude_unit), rate,
                           plan.timing.attitude_unit, attitude);
  if (!found.empty() || scripts(scripted, rates_setpoint)) return found;
  return contradicts_attitude_unit(plan.timing, flown);
}

}  // namespace attest
