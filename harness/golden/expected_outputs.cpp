#include "harness/golden/expected_outputs.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "harness/casefile/stimulus.hpp"
#include "harness/compare/compare.hpp"
#include "harness/golden/reference.hpp"

namespace attest {
namespace {

constexpr const char* how_to_mend = "bless it anew, or restore it from version control";

// Errors: the golden has other ticks than the case makes, or lacks an output.
Result<void> check_extent(const GoldenTrace& golden, const Trace& inputs, bool is_whole) {
  const std::size_t ticks = inputs.samples.size();
  const bool has_others = golden.ticks.back() >= ticks;
  if (has_others || (is_whole && golden.ticks.size() != ticks)) {
    return fail_at(golden.outputs.source,
                   fmt::format("at {}, has {} ticks up to {}, but the case makes {}; {}",
                               golden.configurations.front(), golden.ticks.size(),
                               golden.ticks.back(), ticks, how_to_mend));
  }
  const ChannelSet missing =
      inputs.present & channels_of(module_of(inputs.present), "out/") & ~golden.outputs.present;
  if (missing.none()) return {};
  return fail_at(golden.outputs.source,
                 fmt::format("has no {}; {}", channels()[missing._Find_first()].name, how_to_mend));
}

void put_outputs(const GoldenTrace& golden, Trace& trace) {
  for (std::size_t k = 0; k < golden.ticks.size(); ++k) {
    trace.samples[golden.ticks[k]].copy_outputs(golden.outputs.samples[k]);
  }
}

// The ticks of the golden, from a trace with all ticks.
Trace at_ticks_of(const GoldenTrace& golden, const Trace& all) {
  Trace chosen;
  chosen.present = all.present;
  for (const std::size_t tick : golden.ticks) chosen.samples.push_back(all.samples[tick]);
  for (ParameterChange change : all.parameters) {
    const auto next = std::lower_bound(golden.ticks.begin(), golden.ticks.end(), change.tick);
    change.tick = static_cast<std::size_t>(next - golden.ticks.begin());
    chosen.parameters.push_back(std::move(change));
  }
  return chosen;
}

// Compares the reference with the golden. Errors: they differ by more than the tolerances.
Result<ExpectedOutputs> confirmed(Trace computed, const GoldenTrace& golden, const Case& the_case) {
  const Trace chosen = at_ticks_of(golden, computed);
  Trace stored = chosen;
  for (std::size_t k = 0; k < golden.ticks.size(); ++k) {
    stored.samples[k].copy_outputs(golden.outputs.samples[k]);
  }
  if (compare(chosen, stored, Tolerances(Level::exact)).agrees()) {
    return ExpectedOutputs{std::move(computed)};
  }
  const auto tolerances = tolerances_of(the_case, Level::numeric, {}, computed.samples.size());
  const Comparison comparison = compare(chosen, stored, tolerances);
  if (comparison.agrees()) {
    put_outputs(golden, computed);
    return ExpectedOutputs{std::move(computed), false};
  }
  const Deviation& first = *comparison.first;
  return fail_at(golden.outputs.source,
                 fmt::format("at {}, tick {}, the reference of this build answers another {}; {}",
                             golden.configurations.front(), golden.ticks[first.tick],
                             channels()[first.channel].name, how_to_mend));
}

// The error of a golden of a flight; empty if it can judge one.
std::string complaint_about(const GoldenTrace& golden, const Case& the_case) {
  const ChannelSet needed =
      channels_of(the_case.module, "out/") | ChannelSet().set(timestamp_channel);
  if (const ChannelSet missing = needed & ~golden.outputs.present; missing.any()) {
    return fmt::format("has no column {}", channels()[missing._Find_first()].name);
  }
  if (!golden.horizon_s || !std::isfinite(*golden.horizon_s) || *golden.horizon_s < 0) {
    return "has no horizon_s that is a time";
  }
  for (const Metric& metric : the_case.flight->metrics) {
    if (!golden.metrics.contains(metric.name)) return "has no metric/" + metric.name;
  }
  const auto& samples = golden.outputs.samples;
  const bool increase = std::is_sorted(
      samples.begin(), samples.end(),
      [](const Sample& a, const Sample& b) { return a.in.timestamp <= b.in.timestamp; });
  return increase ? "" : "has timestamps that do not increase";
}

}  // namespace

Result<ExpectedOutputs> expected_outputs(const Case& the_case, const Rate& rate,
                                         const Golden& golden) {
  const RunConfiguration configuration{rate, std::nullopt};
  const auto stored = golden.trace(configuration);
  if (!stored) return tl::unexpected(stored.error());
  Trace inputs = stimulate(the_case, rate);
  const bool is_whole = golden.is_of_port() || keeps_every_tick(inputs.samples.size());
  if (auto fits = check_extent(**stored, inputs, is_whole); !fits) {
    return tl::unexpected(fits.error());
  }
  if (golden.is_of_port()) {
    if (auto same = golden.check_inputs(inputs, configuration); !same) {
      return tl::unexpected(same.error());
    }
    put_outputs(**stored, inputs);
    return ExpectedOutputs{std::move(inputs)};
  }
  auto computed = reference_outputs(subject_of(the_case), std::move(inputs));
  if (!computed) return tl::unexpected(computed.error());
  return confirmed(*std::move(computed), **stored, the_case);
}

Result<ReferenceFlight> expected_flight(const Case& the_case, const RunConfiguration& configuration,
                                        const Vehicle& vehicle, const Golden& golden) {
  if (auto same = golden.check_vehicle(vehicle); !same) return tl::unexpected(same.error());
  const auto trace = golden.trace(configuration);
  if (!trace) return tl::unexpected(trace.error());
  if (const std::string wrong = complaint_about(**trace, the_case); !wrong.empty()) {
    return fail_at(golden.file().string(),
                   fmt::format("at {}, {}; {}", configuration.label(), wrong, how_to_mend));
  }
  return ReferenceFlight{(*trace)->outputs, *(*trace)->horizon_s, (*trace)->metrics};
}

}  // namespace attest
