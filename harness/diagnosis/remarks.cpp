#include "harness/diagnosis/remarks.hpp"

#include <algorithm>
#include <map>
#include <set>

#include <fmt/format.h>

namespace attest {
namespace {

// With fewer cases, a rate may be the only one that passes by chance, or the cases of several
// instances the only ones that fail, because of a mistake that others do not show.
constexpr std::size_t least_cases = 3;

bool is_of_instances(const VectorResult& result) { return result.group == "instances"; }

bool failed(const VectorResult& result) { return fails_a_run(result.verdict); }

void add_shared_state(const std::vector<VectorResult>& results, std::vector<std::string>& remarks) {
  std::size_t failing = 0, of_instances = 0, after_others = 0, others_passing = 0;
  for (const VectorResult& result : results) {
    others_passing += result.verdict == Verdict::pass && !is_of_instances(result) ? 1 : 0;
    if (!failed(result)) continue;
    ++failing;
    of_instances += is_of_instances(result) ? 1 : 0;
    after_others += passes_alone(result) ? 1 : 0;
  }
  if (after_others > 0) {
    remarks.push_back(
        fmt::format("its instances share state, such as a static variable: {} of the failing "
                    "vectors pass when they run alone",
                    after_others));
  } else if (failing > 0 && failing == of_instances && others_passing >= least_cases) {
    remarks.emplace_back(
        "its instances share state, such as a static variable: only cases with several instances "
        "fail");
  }
}

// A case that passes at one rate and fails at all others.
void add_fixed_step(const std::vector<VectorResult>& results, std::vector<std::string>& remarks) {
  struct OfCase {
    std::set<std::string> passing, failing;
  };
  std::map<std::string, OfCase> cases;
  for (const VectorResult& result : results) {
    if (result.plant_configuration) continue;
    OfCase& one = cases[result.case_id()];
    const std::string rate = result.rate.motor_unit.to_string();
    if (failed(result)) one.failing.insert(rate);
    if (result.verdict == Verdict::pass) one.passing.insert(rate);
  }
  std::map<std::string, std::size_t> only_rate;
  std::size_t several_rates = 0;
  for (const auto& [id, one] : cases) {
    if (one.failing.size() < 3) continue;
    ++several_rates;
    if (one.passing.size() == 1) ++only_rate[*one.passing.begin()];
  }
  for (const auto& [rate, count] : only_rate) {
    if (count < least_cases || 2 * count < several_rates) continue;
    remarks.push_back(
        fmt::format("it has the time step of {} Hz at every rate: {} cases pass at that rate only",
                    rate, count));
  }
}

// With -ffast-math a compiler takes isfinite() for true. The cases with NaN then give NaN.
void add_missing_checks(const std::vector<VectorResult>& results,
                        std::vector<std::string>& remarks) {
  constexpr std::ptrdiff_t least = 10;  // fewer can be a single check that the port forgot
  const auto failing = std::ranges::count_if(results, failed);
  const auto non_finite = std::ranges::count(results, Verdict::non_finite, &VectorResult::verdict);
  if (non_finite < least || 2 * non_finite < failing) return;
  remarks.push_back(fmt::format(
      "{} of {} failing vectors give NaN or infinity where the law gives a number: is the port "
      "built with -ffast-math or -Ofast, which remove checks such as isfinite()?",
      non_finite, failing));
}

void add_flights_only(const std::vector<VectorResult>& results, std::vector<std::string>& remarks) {
  const auto is_open_loop = [](const VectorResult& one) { return !one.plant_configuration; };
  const bool flights_fail = std::any_of(results.begin(), results.end(), [&](const auto& one) {
    return failed(one) && !is_open_loop(one);
  });
  const bool others_fail = std::any_of(results.begin(), results.end(), [&](const auto& one) {
    return failed(one) && is_open_loop(one);
  });
  const bool others_pass = std::any_of(results.begin(), results.end(), [&](const auto& one) {
    return one.verdict == Verdict::pass && is_open_loop(one);
  });
  if (!flights_fail || others_fail) return;
  remarks.emplace_back(
      others_pass ? "only flights fail, which the diagnosis does not examine: look at what passes "
                    "between the loops, such as a rates setpoint that is one step late"
                  : "only flights were judged, which the diagnosis does not examine: run the cases "
                    "in open loop, too, for example with --exclude 'flight*/*'");
}

}  // namespace

bool passes_alone(const VectorResult& failed) {
  return !failed.after.empty() && failed.verdict != Verdict::timeout;
}

std::vector<std::string> remarks_on(const std::vector<VectorResult>& results) {
  std::vector<std::string> remarks;
  add_shared_state(results, remarks);
  add_fixed_step(results, remarks);
  add_missing_checks(results, remarks);
  add_flights_only(results, remarks);
  return remarks;
}

}  // namespace attest
