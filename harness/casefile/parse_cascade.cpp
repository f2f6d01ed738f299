#include "harness/casefile/parse_cascade.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "harness/casefile/parse_signal.hpp"

namespace attest {
namespace {

// The firmware's allocator publishes its status at most every 5 ms.
const Rate allocator_status_rate = Rate::hz(200);

std::optional<EstimatorReset> parse_reset(const TomlTable& flight) {
  constexpr const char* key = "reset";
  if (!flight.has("estimator")) return std::nullopt;
  const TomlTable estimator = flight.table("estimator");
  if (!estimator.has(key)) return std::nullopt;
  const TomlTable table = estimator.table(key);
  const auto [by, keys] = angle_keys(table);
  std::array<double, 3> angles_deg{};
  for (std::size_t i = 0; i < angles_deg.size(); ++i) {
    angles_deg[i] = table.number(keys[i], 0);
    if (!std::isfinite(angles_deg[i])) table.error(keys[i], "must be finite");
  }
  return EstimatorReset{parse_span(table, "at"), attitude_from(by, angles_deg)};
}

// With a floor the plant determines vehicle_land_detected, so the case must not script it.
void leave_out_land_detection(const TomlTable& root, Case& parsed) {
  constexpr const char* topic = "vehicle_land_detected";
  if (root.has(topic)) {
    root.table(topic);
    root.error(topic, "comes from the plant in a flight with a floor; leave it out");
  }
  for (auto* topics : {&parsed.topics, &parsed.attitude_loop->topics}) {
    std::erase_if(*topics, [&](const TopicStimulus& one) { return one.topic == topic; });
  }
}

}  // namespace

TaskTiming parse_timing(const TomlTable& table, TaskTiming timing) {
  if (table.has("rate_hz")) {
    const auto rate = Rate::parse(fmt::format("{}", table.number("rate_hz")));
    if (!rate) table.error("rate_hz", rate.error().message);
    if (rate) timing.rate = *rate;
  }
  timing.phase = parse_optional_span(table, "phase").value_or(timing.phase);
  timing.delay = parse_optional_span(table, "delay").value_or(timing.delay);
  timing.jitter = table.number("jitter", 0);
  if (!(timing.jitter >= 0 && timing.jitter < 1)) {
    table.error("jitter", "is a fraction of a period: must be 0 or more, and less than 1");
  }
  timing.seed = static_cast<std::uint64_t>(table.integer("seed", 1));
  if (table.has("drop_ticks")) timing.drop_ticks = table.integers("drop_ticks");
  return timing;
}

void parse_cascade_flight(const TomlTable& root, const TomlTable& flight, Case& parsed) {
  Flight& result = *parsed.flight;
  result.saturation = task_at(allocator_status_rate);
  constexpr const char* status = "allocator_status";
  if (flight.has(status)) {
    result.saturation = parse_timing(flight.table(status), result.saturation);
  }
  parsed.attitude_loop->delay =
      parse_optional_span(flight, "rates_setpoint_delay").value_or(Span{0, Span::In::seconds});
  result.estimator.reset = parse_reset(flight);
  if (result.floor) leave_out_land_detection(root, parsed);
}

}  // namespace attest
