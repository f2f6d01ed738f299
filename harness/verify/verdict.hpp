// The verdict on one case at one rate. It does not depend on the catalogue of wrong controllers.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "harness/casefile/run_configuration.hpp"
#include "harness/compare/compare.hpp"
#include "harness/compare/metric.hpp"
#include "harness/schedule/rate.hpp"

namespace attest {

// Only pass counts as conformant. pass, unsupported, skip and xfail do not fail a run; all others
// do.
enum class Verdict {
  pass,
  fail,         // an output differs, or the port reported a failure
  crash,        // the port's process died
  timeout,      // no answer in time
  protocol,     // the port broke the rules of the ABI
  non_finite,   // NaN or Inf where the golden has a number
  unsupported,  // the port declared that it does not support this
  skip,         // not run, with a reason (profile not supported, exact-level case)
  xfail,        // failed, as expected
  xpass,        // passed although expected to fail
};

inline constexpr int verdict_count = 10;

// The reason of the only kind of skip that a conformant run may have.
inline constexpr std::string_view exact_level_only =
    "on a threshold of the law: compared at the exact level only";

std::string_view name_of(Verdict verdict);  // "non-finite"
std::optional<Verdict> parse_verdict(std::string_view name);
bool fails_a_run(Verdict verdict);

// A metric of a flight, with its bounds.
struct MetricResult {
  std::string name;  // as the case calls it
  Measure measure = Measure::settling_time_s;
  double value = 0;
  double reference = 0;  // of the golden
  double tolerance = 0;  // allowed |value - reference|
  double min = 0, max = 0;

  // Infinite values agree with each other; NaN agrees with no value.
  bool within() const;
};

struct CaseResult {
  std::string profile;  // "px4-v1.5.5"
  std::string group;    // "attitude"
  std::string name;     // "roll_30": with profile and group, the stem in cases/ and golden/
  LoopRate rate;
  std::optional<PlantConfiguration> plant_configuration;  // of a flight
  Verdict verdict = Verdict::pass;
  std::string reason;     // one line; empty for a plain pass
  std::size_t ticks = 0;  // compared
  std::size_t deviating_ticks = 0;
  std::optional<Deviation> first, worst;
  std::optional<Headroom> tightest;
  std::vector<MetricResult> metrics;  // of a flight without fault and early end
  double elapsed_s = 0;  // of wall time, for JUnit only: everything else is deterministic

  std::string case_id() const { return profile + "/" + group + "/" + name; }
  RunConfiguration configuration() const { return {rate, plant_configuration}; }
  // "px4-v1.5.5/attitude/roll_30@250hz", "px4-v1.5.5/flight/hover@250hz-iris-ode": what --filter
  // matches and what a report names.
  std::string id() const { return case_id() + "@" + configuration().label(); }
};

}  // namespace attest
