#include "harness/verify/fixed_step.hpp"

#include <string>
#include <vector>

#include <fmt/format.h>

#include "harness/casefile/stimulus.hpp"

namespace attest {
namespace {

bool is_unsupported(const Rate& step, const std::string& what, CaseResult& result) {
  result.verdict = Verdict::unsupported;
  result.reason =
      fmt::format("the port has a fixed step of {} Hz, and this {}", step.to_string(), what);
  return true;
}

bool has_other_steps(const PortSays& port, const Case& the_case, const Rate& rate,
                     const std::vector<Nanoseconds>& begins, CaseResult& result) {
  if (!has_fixed_step(port, the_case)) return false;
  const Rate step = *port.fixed_step;
  if (rate != step) return is_unsupported(step, "runs at another rate", result);
  const UnitTiming usual;
  const bool starts_as_usual =
      the_case.unit.start.amount == usual.start.amount && the_case.unit.start.in == usual.start.in;
  if (!starts_as_usual) return is_unsupported(step, "has a start_s of its own", result);
  for (std::size_t k = 0; k < begins.size(); ++k) {
    if (begins[k] == rate.tick(static_cast<std::int64_t>(k))) continue;
    return is_unsupported(step, "has late or missing ticks", result);
  }
  return false;
}

}  // namespace

bool has_fixed_step(const PortSays& port, const Case& the_case) {
  return the_case.module == Module::mc_att_control && port.fixed_step.has_value();
}

Trace inputs_for(const PortSays& port, const Case& the_case, const Rate& rate) {
  return stimulate(has_fixed_step(port, the_case) ? the_case.from_one_period_on() : the_case, rate);
}

bool has_other_steps(const PortSays& port, const Case& the_case, const Rate& rate,
                     CaseResult& result) {
  return has_other_steps(port, the_case, rate, unit_ticks(the_case, rate), result);
}

bool has_other_steps(const PortSays& port, const Case& the_case, const Rate& rate,
                     const FlightTiming& timing, CaseResult& result) {
  std::vector<Nanoseconds> begins;
  for (const LoopTick& tick : timing.unit) begins.push_back(tick.begins);
  return has_other_steps(port, the_case, rate, begins, result);
}

bool has_other_steps(const PortSays& port, const Trace& recorded, CaseResult& result) {
  const auto step = port.fixed_step;
  if (!step) return false;
  for (std::size_t k = 0; k < recorded.samples.size(); ++k) {
    const Nanoseconds due = step->tick(static_cast<std::int64_t>(k) + 1);
    if (recorded.samples[k].in.timestamp == timestamp_us(due)) continue;
    return is_unsupported(*step, "was not recorded at its steps from one period after zero on",
                          result);
  }
  return false;
}

}  // namespace attest
