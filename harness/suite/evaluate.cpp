#include "harness/suite/evaluate.hpp"

#include <chrono>
#include <utility>

#include <fmt/format.h>

#include "harness/casefile/stimulus.hpp"
#include "harness/core/float_environment.hpp"
#include "harness/run/open_loop.hpp"

namespace attest {
namespace {

Tolerances tolerances_of(const Case& the_case, Level level) {
  Tolerances tolerances(level);
  for (const auto& [prefix, tolerance] : the_case.tolerances) tolerances.set(prefix, tolerance);
  return tolerances;
}

Verdict verdict_of(PortFault::Kind kind) {
  switch (kind) {
    case PortFault::Kind::unsupported:
      return Verdict::unsupported;
    case PortFault::Kind::protocol:
      return Verdict::protocol;
    default:
      return Verdict::fail;
  }
}

void judge(const Comparison& comparison, CaseResult& result) {
  result.ticks = comparison.ticks;
  result.deviating_ticks = comparison.deviating_ticks;
  result.first = comparison.first;
  result.tightest = comparison.tightest;
  result.reason = comparison.mismatch;
  if (comparison.agrees()) return;
  result.verdict = comparison.got_non_finite ? Verdict::non_finite : Verdict::fail;
}

// Drives a fresh unit through `answered`, whose inputs are those of `want`, and compares.
void run_and_judge(Trace& answered, const Trace& want, const std::string& profile, Port& port,
                   const Tolerances& tolerances, CaseResult& result) {
  const std::unique_ptr<Unit> unit = port.create(profile);
  if (!unit) {
    result.verdict = Verdict::skip;
    result.reason = fmt::format("the port does not support profile {}", profile);
    return;
  }
  if (const auto fault = drive(*unit, answered)) {
    result.verdict = verdict_of(fault->kind);
    result.reason = fault->what;
    return;
  }
  const DefaultFloatEnvironment environment;
  judge(compare(answered, want, tolerances), result);
}

// What the case gives the unit, and what the reference answered to just that.
struct Prepared {
  Trace answered;  // inputs only, so far
  Trace want;
};

Result<Prepared> prepare(const Case& the_case, const Rate& rate, const Golden& golden) {
  const DefaultFloatEnvironment environment;
  auto want = golden.read(rate);
  if (!want) return tl::unexpected(want.error());
  Trace made = stimulate(the_case, rate);
  if (const auto tick = first_input_difference(made, *want)) {
    return fail_at(want->source,
                   fmt::format("at tick {} the golden's inputs are not those that {} makes; bless "
                               "it anew, or restore it from version control",
                               *tick, the_case.file.string()));
  }
  return Prepared{std::move(made), std::move(*want)};
}

class Stopwatch {
 public:
  double elapsed_s() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
  }

 private:
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

}  // namespace

CaseResult unjudged(const Case& the_case, const Rate& rate) {
  CaseResult result;
  result.profile = the_case.profile;
  result.group = the_case.group;
  result.name = the_case.name;
  result.rate = rate;
  return result;
}

CaseResult unjudged(const Trace& recorded, const std::string& profile) {
  CaseResult result;
  result.profile = profile;
  result.name = recorded.source;
  return result;
}

Result<CaseResult> evaluate_case(const Case& the_case, const Rate& rate, const Golden& golden,
                                 Port& port, Level level) {
  const Stopwatch stopwatch;
  CaseResult result = unjudged(the_case, rate);
  if (the_case.exact_only && level != Level::exact) {
    result.verdict = Verdict::skip;
    result.reason = "on a threshold of the law: compared at the exact level only";
    return result;
  }
  auto prepared = prepare(the_case, rate, golden);
  if (!prepared) return tl::unexpected(prepared.error());
  run_and_judge(prepared->answered, prepared->want, the_case.profile, port,
                tolerances_of(the_case, level), result);
  result.elapsed_s = stopwatch.elapsed_s();
  return result;
}

CaseResult evaluate_trace(const Trace& recorded, const std::string& profile, Port& port,
                          const Tolerances& tolerances) {
  const Stopwatch stopwatch;
  CaseResult result = unjudged(recorded, profile);
  Trace answered = recorded;
  for (Sample& sample : answered.samples) sample.out = {};
  run_and_judge(answered, recorded, profile, port, tolerances, result);
  result.elapsed_s = stopwatch.elapsed_s();
  return result;
}

}  // namespace attest
