// The verdict on one vector: a case in one run configuration. And all words with which reports
// judge: docs/verdicts.md explains them, and a test compares it with the tables of verdict.cpp.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "harness/casefile/run_configuration.hpp"
#include "harness/compare/compare.hpp"
#include "harness/compare/metric.hpp"
#include "harness/core/rate.hpp"

namespace attest {

// pass, unsupported, skip and xfail do not fail a run; all others do.
enum class Verdict {
  pass,
  fail,         // an output or a metric is wrong, or the port reported a failure
  crash,        // the port's process died
  timeout,      // no answer in time
  protocol,     // the port broke the rules of the ABI
  non_finite,   // NaN or Inf where the expected output is a number
  unsupported,  // excluded by a declaration of the port, or by ATTEST_UNSUPPORTED
  skip,         // not judged, for the given reason (profile not supported, exact-level case)
  xfail,        // failed as expected (expected_failures.hpp)
  xpass,        // passed although expected to fail
};

inline constexpr int verdict_count = 10;

// The reason of a skipped case that is compared at the exact level only, for people.
// VectorResult::exact_only is set for such a case.
inline constexpr std::string_view exact_level_only =
    "on a threshold of the law: compared at the exact level only";

std::string_view name_of(Verdict verdict);     // "non-finite"
std::string_view meaning_of(Verdict verdict);  // for a result without a reason
std::optional<Verdict> parse_verdict(std::string_view name);
bool fails_a_run(Verdict verdict);
bool is_judged(Verdict verdict);  // all but skip and unsupported

// The judgement on a run, or on what else a command examined.
enum class Conclusion {
  pass,
  fail,
  partial,   // some rates passed, and the others were not judged
  none,      // no vector passed, and none failed
  measured,  // the command had no bound to judge by
  stopped,   // the run ended before all vectors were run, and no vector failed
};
inline constexpr int conclusion_count = 6;
std::string_view name_of(Conclusion conclusion);
Verdict verdict_of(Conclusion conclusion);  // the verdict with the same colour and symbol
Conclusion conclusion_of(Verdict verdict);  // pass, fail or none

// The judgement on one signal, topic or metric in a table.
enum class RowVerdict { agrees, differs, within, missed, not_judged };
inline constexpr int row_verdict_count = 5;
std::string_view name_of(RowVerdict verdict);

struct MetricResult {
  std::string name;  // its key in the case
  Measure measure = Measure::settling_time_s;
  double value = 0;
  double reference = 0;  // the value of the reference's flight
  double tolerance = 0;  // allowed |value - reference|
  double min = 0, max = 0;

  // Whether `value` is from `min` to `max`, and within the tolerance of the reference. Infinities
  // of the same sign are within the tolerance; NaN never is.
  bool within() const;
};

struct VectorResult {
  std::string profile;  // "px4-v1.5.5"
  std::string group;    // "attitude"
  std::string name;     // "roll_30": with profile and group, the stem in cases/ and golden/
  LoopRate rate;
  std::optional<PlantConfiguration> plant_configuration;  // of a flight
  Verdict verdict = Verdict::pass;
  std::string reason;  // one line; may be empty for a pass, or if `first` shows the failure
  // A skip that a claim of conformance counts like a pass: the case is compared at the exact level
  // only, and the run has another level. The judge sets it from the case. An answer of the port
  // cannot set it, not even with the same reason.
  bool exact_only = false;
  // False: the port has no such module or profile, so the vector is skipped or unsupported.
  bool applies = true;
  // The reference has other bits on this machine than the golden, within the tolerances. The
  // golden's values decided.
  bool by_golden = false;
  // The suite has no golden of the case. The reference alone decided.
  bool no_golden = false;
  std::optional<Level> compared;  // the level at which outputs were compared; empty: they were not
  std::size_t ticks = 0;          // compared
  std::size_t deviating_ticks = 0;
  std::optional<Deviation> first, worst;
  std::optional<Headroom> tightest;
  std::vector<Largest> largest;
  std::vector<MetricResult> metrics;  // of a flight without a fault that did not end early
  double elapsed_s = 0;               // wall time; no verdict depends on it
  // The vectors that the same process of the port ran before, if this failure may depend on them:
  // it does not occur alone, or it is a timeout, which is not repeated.
  std::vector<std::string> after;
  // Declared lacks (declared_lacks.hpp): the features, or the parameter, because of which the
  // vector is unsupported, and what the port has although it declares that it lacks it.
  std::vector<std::string> lacking, has_after_all;
  // Topics as "rate_unit/rate_ctrl_status" that the golden publishes (silent_topics.hpp): those
  // that the port publishes too, and those that it does not publish at any tick. The latter were
  // not compared.
  std::vector<std::string> published, silent;
  std::optional<Deviation> first_silence;  // the first tick at which a silent topic is due
  std::size_t silent_ticks = 0;            // at which that topic is due

  std::string case_id() const { return profile + "/" + group + "/" + name; }
  RunConfiguration configuration() const { return {rate, plant_configuration}; }
  // "px4-v1.5.5/attitude/roll_30@250hz", "px4-v1.5.5/flight/hover@250hz-iris-ode". Reports show
  // this id, and patterns of --filter match it.
  std::string id() const { return case_id() + "@" + configuration().label(); }
};

}  // namespace attest
