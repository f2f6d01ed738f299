#include "harness/verify/fixed_step.hpp"

#include <string>
#include <vector>

#include <fmt/format.h>

#include "harness/casefile/stimulus.hpp"
#include "harness/golden/recorded.hpp"

namespace attest {
namespace {

bool is_unsupported(const Rate& step, const std::string& what, VectorResult& result) {
  result.verdict = Verdict::unsupported;
  result.reason =
      fmt::format("the port has a fixed step of {} Hz, and this {}", step.to_string(), what);
  return true;
}

// Whether tick k and its sample are at k + 1 periods. `first_tick`: that of `trace`.
bool is_at_steps(const Trace& trace, const Rate& step, Module module, std::size_t first_tick = 0) {
  for (std::size_t i = 0; i < trace.samples.size(); ++i) {
    const auto k = static_cast<std::int64_t>(first_tick + i);
    const std::uint64_t due_us = timestamp_us(step.tick(k + 1));
    const Sample& sample = trace.samples[i];
    if (sample.in.timestamp != due_us || info_of(module).sampled_us(sample) != due_us) return false;
  }
  return true;
}

bool is_periodic(const std::vector<Nanoseconds>& begins, const Rate& step) {
  for (std::size_t k = 0; k < begins.size(); ++k) {
    if (begins[k] != step.tick(static_cast<std::int64_t>(k))) return false;
  }
  return true;
}

std::vector<Nanoseconds> begins_of(const LoopTiming& timing) {
  std::vector<Nanoseconds> begins;
  for (const LoopTick& tick : timing) begins.push_back(tick.begins);
  return begins;
}

bool has_other_steps(const Declarations& port, const Case& the_case, const Rate& rate,
                     const std::vector<Nanoseconds>& begins, VectorResult& result) {
  const Rate step = *port.fixed_step;
  if (rate != step) return is_unsupported(step, "runs at another rate", result);
  const UnitTiming usual;
  const bool starts_as_usual =
      the_case.unit.start.amount == usual.start.amount && the_case.unit.start.in == usual.start.in;
  if (!starts_as_usual) return is_unsupported(step, "has a start_s of its own", result);
  if (!is_periodic(begins, step)) {
    return is_unsupported(step, "has late or missing ticks", result);
  }
  return false;
}

}  // namespace

bool has_fixed_step(const Declarations& port, const Case& the_case) {
  return info_of(the_case.module).is_unit() && port.fixed_step.has_value();
}

Trace inputs_for(const Declarations& port, const Case& the_case, const Rate& rate,
                 const std::vector<ParameterChange>& parameters) {
  Trace inputs =
      stimulate(has_fixed_step(port, the_case) ? the_case.from_one_period_on() : the_case, rate);
  for (const ParameterChange& parameter : parameters) {
    if (check_parameter(subject_of(the_case), parameter)) override_parameter(parameter, inputs);
  }
  return inputs;
}

bool has_other_steps(const Declarations& port, const Case& the_case, const Rate& rate,
                     VectorResult& result) {
  if (!has_fixed_step(port, the_case)) return false;
  if (has_other_steps(port, the_case, rate, unit_ticks(the_case, rate), result)) return true;
  if (is_at_steps(inputs_for(port, the_case, rate), rate, the_case.module)) return false;
  return is_unsupported(rate, "has samples that were taken at other times", result);
}

bool has_other_steps(const Declarations& port, const Case& the_case, const Rate& rate,
                     const FlightTiming& timing, VectorResult& result) {
  if (!has_fixed_step(port, the_case)) return false;
  const bool is_of_cascade = !timing.attitude_unit.empty();
  const Rate step = *port.fixed_step;
  if (is_of_cascade && (rate != step || !is_periodic(begins_of(timing.attitude_unit), step))) {
    return is_unsupported(step, "does not run both units at each of these steps", result);
  }
  return has_other_steps(port, the_case, rate, begins_of(timing.unit), result);
}

bool has_other_steps(const Declarations& port, const Trace& recorded, Module module,
                     VectorResult& result, std::size_t first_tick) {
  const auto step = port.fixed_step;
  if (!step || !info_of(module).is_unit() || is_at_steps(recorded, *step, module, first_tick))
    return false;
  return is_unsupported(*step, "was not recorded at its steps from one period after zero on",
                        result);
}

}  // namespace attest
