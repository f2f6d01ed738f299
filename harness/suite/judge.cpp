#include "harness/suite/judge.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace attest {

Tolerances tolerances_of(const Case& the_case, Level level, std::optional<int> fraction_bits) {
  Tolerances tolerances(level);
  for (const auto& [prefix, tolerance] : the_case.tolerances) tolerances.set(prefix, tolerance);
  if (fraction_bits) tolerances.allow_lsb(*fraction_bits);
  return tolerances;
}

bool declines(const Port& port, CaseResult& result) {
  const std::vector<std::string> declined = port.unsupported_groups();
  if (std::find(declined.begin(), declined.end(), result.group) == declined.end()) return false;
  result.verdict = Verdict::unsupported;
  result.reason = fmt::format("the port declares that it does not do {}", result.group);
  return true;
}

std::unique_ptr<Unit> create_unit(Port& port, const std::string& profile, CaseResult& result) {
  if (declines(port, result)) return nullptr;
  std::unique_ptr<Unit> unit = port.create(profile);
  if (!unit) {
    result.verdict = Verdict::skip;
    result.reason = fmt::format("the port does not support profile {}", profile);
  }
  return unit;
}

void judge(const PortFault& fault, CaseResult& result) {
  result.reason = fault.what;
  switch (fault.kind) {
    case PortFault::Kind::profile:
      result.verdict = Verdict::skip;
      return;
    case PortFault::Kind::unsupported:
      result.verdict = Verdict::unsupported;
      return;
    case PortFault::Kind::protocol:
      result.verdict = Verdict::protocol;
      return;
    default:
      result.verdict = Verdict::fail;
  }
}

void judge(const Comparison& comparison, CaseResult& result) {
  result.ticks = comparison.ticks;
  result.deviating_ticks = comparison.deviating_ticks;
  result.first = comparison.first;
  result.tightest = comparison.tightest;
  result.reason = comparison.mismatch.empty() ? comparison.event : comparison.mismatch;
  if (comparison.agrees()) return;
  result.verdict = comparison.got_non_finite ? Verdict::non_finite : Verdict::fail;
}

}  // namespace attest
