#include "harness/compare/compare_rows.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace attest {
namespace {

// The rows of a golden, and the ticks of a flown trace that they are compared with.
struct Rows {
  Trace got, want;
  std::vector<std::size_t> ticks;  // in the flown trace
  std::string mismatch;
};

std::size_t tick_at(const Trace& trace, std::uint64_t timestamp) {
  const auto found = std::lower_bound(
      trace.samples.begin(), trace.samples.end(), timestamp,
      [](const Sample& sample, std::uint64_t time) { return sample.in.timestamp < time; });
  return static_cast<std::size_t>(found - trace.samples.begin());
}

// Adds the parameter changes of the flight, with the index of the row instead of the tick.
void take_parameters(const Trace& flown, Rows& rows) {
  for (const ParameterChange& change : flown.parameters) {
    const auto row = std::lower_bound(rows.ticks.begin(), rows.ticks.end(), change.tick);
    rows.want.parameters.push_back(
        {static_cast<std::size_t>(row - rows.ticks.begin()), change.name, change.value});
  }
}

Rows rows_of(const Trace& flown, const Trace& golden, double horizon_s) {
  Rows rows;
  rows.got.present = flown.present;
  rows.want.present = golden.present & flown.present;  // without what the port lacks
  constexpr double us = 1e-6;
  const std::uint64_t begin = golden.samples.front().in.timestamp;
  for (const Sample& sample : golden.samples) {
    const std::uint64_t timestamp = sample.in.timestamp;
    if (static_cast<double>(timestamp - begin) * us > horizon_s) break;
    const std::size_t tick = tick_at(flown, timestamp);
    if (tick == flown.samples.size()) break;
    if (flown.samples[tick].in.timestamp != timestamp) {
      rows.mismatch = fmt::format(
          "the golden has a row at {} us, where the flight has no tick; "
          "bless it anew",
          timestamp);
      break;
    }
    rows.ticks.push_back(tick);
    rows.got.samples.push_back(flown.samples[tick]);
    // The inputs decide how wide a tolerance is. Those of the golden are not stored.
    rows.want.samples.push_back(flown.samples[tick]);
    rows.want.samples.back().copy_outputs(sample);
    // A row holds the setpoint in force, which may have been published at an earlier tick.
    rows.want.samples.back().in.updated |= ATTEST_UPDATED_VEHICLE_ATTITUDE_SETPOINT;
  }
  take_parameters(flown, rows);
  return rows;
}

}  // namespace

Comparison compare_rows(const Trace& got, const Trace& want, double horizon_s,
                        const Tolerances& tolerances) {
  const Rows rows = rows_of(got, want, horizon_s);
  Comparison comparison;
  comparison.mismatch = rows.mismatch;
  if (!rows.mismatch.empty() || rows.ticks.empty()) return comparison;
  comparison = compare(rows.got, rows.want, tolerances);
  if (comparison.first) comparison.first->tick = rows.ticks[comparison.first->tick];
  if (comparison.worst) comparison.worst->tick = rows.ticks[comparison.worst->tick];
  if (comparison.tightest) comparison.tightest->tick = rows.ticks[comparison.tightest->tick];
  return comparison;
}

}  // namespace attest
