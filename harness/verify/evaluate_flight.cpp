#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/compare/compare_rows.hpp"
#include "harness/golden/expected_outputs.hpp"
#include "harness/golden/reference.hpp"
#include "harness/loop/flight.hpp"
#include "harness/verify/declared_lacks.hpp"
#include "harness/verify/evaluate.hpp"
#include "harness/verify/fixed_step.hpp"
#include "harness/verify/flight_contradiction.hpp"
#include "harness/verify/judge.hpp"
#include "harness/verify/reference_comparison.hpp"
#include "harness/verify/saved_traces.hpp"
#include "harness/verify/silent_topics.hpp"
#include "harness/verify/stopwatch.hpp"

namespace attest {
namespace {

// The allowed deviation of a metric from the reference's. Two correct controllers have slightly
// different metrics, because their flights differ beyond the horizon. The values are a few times
// these measured differences, and far below the differences of a port with a wrong gain.
double tolerance_of(Measure measure, double reference, const Rate& rate) {
  constexpr double relative = 0.05;
  const auto at_least = [&] {
    switch (measure) {
      case Measure::settling_time_s:
        return 0.05 + 2 * rate.period_s();  // the band is crossed between two ticks
      case Measure::overshoot_deg:
        return 0.5;
      case Measure::rms_attitude_error_deg:
        return 0.1;
      case Measure::rms_rate_error_rad_s:
        return 0.02;
      case Measure::peak_rate_rad_s:
        return 0.1;
      case Measure::saturation_duty:
        return 0.02;
      case Measure::peak_integral:
        return 0.005;
      case Measure::sink_m:
        return 0.05;
    }
    return 0.0;
  };
  const double size = std::isfinite(reference) ? std::abs(reference) : 0;
  return std::max(at_least(), relative * size);
}

std::string off(const MetricResult& metric) {
  if (metric.value < metric.min || metric.value > metric.max) {
    const bool low = metric.value < metric.min;
    return fmt::format("metric {}: {} is {:.4g}, {} {:g}", metric.name, name_of(metric.measure),
                       metric.value, low ? "below" : "above", low ? metric.min : metric.max);
  }
  return fmt::format("metric {}: {} is {:.4g}, the reference's {:.4g} +- {:.2g}", metric.name,
                     name_of(metric.measure), metric.value, metric.reference, metric.tolerance);
}

// Whether the metric needs an output that is not judged.
bool is_unknown(const Metric& metric, const Trace& flown) {
  if (metric.measure != Measure::peak_integral) return false;
  const ChannelSet missing = channels_of(module_of(flown.present), "out/") & ~flown.present;
  for (std::size_t i = 0; i < channels().size(); ++i) {
    if (missing[i] && channels()[i].stage == Stage::integrator) return true;
  }
  return false;
}

void judge_metrics(const Case& the_case, const Flown& flown, const ReferenceFlight& reference,
                   VectorResult& result, std::vector<std::string>& reasons) {
  for (const Metric& metric : the_case.flight->metrics) {
    if (is_unknown(metric, flown.trace)) continue;
    const auto known = reference.metrics.find(metric.name);
    const double expected =
        known == reference.metrics.end() ? std::numeric_limits<double>::quiet_NaN() : known->second;
    MetricResult measurement{metric.name,
                             metric.measure,
                             measured(metric, flown),
                             expected,
                             tolerance_of(metric.measure, expected, result.rate.motor_unit),
                             metric.min,
                             metric.max};
    // With `versus` the metric is a ratio without a unit, so only a relative tolerance applies.
    if (metric.versus) measurement.tolerance = 0.05 * std::abs(expected);
    if (!measurement.within()) reasons.push_back(off(measurement));
    result.metrics.push_back(std::move(measurement));
  }
}

// For a flight with correct outputs: the comparison of the loop with the golden, but with the ticks
// of `answers`, and the tightest headroom of both.
Comparison with_tightest(Comparison loop, const Comparison& answers) {
  loop.ticks = answers.ticks;
  loop.largest = answers.largest;  // those of the loop have grown through the vehicle
  if (!loop.tightest || (answers.tightest && answers.tightest->ratio < loop.tightest->ratio)) {
    loop.tightest = answers.tightest;
  }
  return loop;
}

// Compares each output with the reference's. If all agree, compares the loop with the golden's rows
// up to the horizon. NaN or infinity in an output that is finite in all rows fails at every tick,
// also beyond the horizon.
Result<void> judge_ticks(const Case& the_case, const Flown& flown, const ReferenceFlight& reference,
                         Level level, std::optional<int> fraction_bits, VectorResult& result) {
  // The horizon is that of floats. A port in fixed point rounds more, and in flight its rounding
  // changes its later inputs. A port with 22 fraction bits was measured to deviate from the
  // golden's rates by seven times the tolerance of its LSBs. With 30 bits, seven times that
  // tolerance is a tenth of the tolerance of floats for rates. With fewer bits only the metrics
  // judge the loop.
  constexpr int as_near_as_floats_bits = 30;
  const double horizon_s = fraction_bits.value_or(as_near_as_floats_bits) < as_near_as_floats_bits
                               ? 0
                               : reference.horizon_s;
  const std::size_t ticks = flown.trace.samples.size();
  result.compared = level;
  auto comparison = compare_with_reference(
      flown, the_case.profile, tolerances_of(the_case, level, fraction_bits, ticks), fraction_bits);
  if (!comparison) return tl::unexpected(comparison.error());
  const bool answers_agree = comparison->agrees();
  if (answers_agree) {
    const Tolerances of_plant = tolerances_of(the_case, Level::numeric, fraction_bits, ticks);
    comparison =
        with_tightest(compare_rows(flown.trace, reference.rows, horizon_s, of_plant), *comparison);
  }
  if (const auto non_finite = first_non_finite(flown.trace, reference.rows)) {
    if (!comparison->first) comparison->first = non_finite;
    comparison->got_non_finite = true;
  }
  // Each output agrees with the reference's for the same inputs, so the inputs differ.
  if (answers_agree && comparison->first) comparison->first->stages = only(Stage::input);
  judge(*comparison, result);
  return {};
}

Result<void> judge_flight(const Case& the_case, const Flown& flown,
                          const ReferenceFlight& reference, Level level,
                          std::optional<int> fraction_bits, VectorResult& result) {
  auto judged = judge_ticks(the_case, flown, reference, level, fraction_bits, result);
  if (!judged) return judged;
  std::vector<std::string> reasons;
  if (!result.reason.empty()) reasons.push_back(result.reason);
  if (flown.divergence) {
    reasons.push_back(how_it_ended(flown));
  } else {
    judge_metrics(the_case, flown, reference, result, reasons);
  }
  if (result.verdict == Verdict::pass && !reasons.empty()) result.verdict = Verdict::fail;
  result.reason = fmt::format("{}", fmt::join(reasons, "; "));
  return {};
}

}  // namespace

std::string how_it_ended(const Flown& flown) {
  return fmt::format("the flight ended at {:.3f} s (tick {}): {}", in_seconds(flown.divergence->at),
                     flown.trace.samples.size(), flown.divergence->what);
}

namespace {

// Saves the traces of a failed flight, with the reference's outputs for the same inputs.
void save_flight(const std::filesystem::path& folder, const Trace& flown,
                 const Tolerances& tolerances, VectorResult& result) {
  if (!saves_traces(folder, result) || flown.samples.empty()) return;
  const ModuleUnderTest subject{result.profile, module_of(flown.present)};
  const auto want = reference_outputs(subject, flown);
  if (!want) return;
  save_traces(folder, subject, {flown, *want, tolerances}, result);
}

// The fault of a flight. If its traces contradict the plan: a fault of kind protocol.
std::optional<PortFault> fault_of(const Course& course, const FlightPlan& plan,
                                  const Flown& flown) {
  const std::string contradiction = flight_contradiction(course, plan, flown);
  if (contradiction.empty()) return flown.fault;
  return PortFault{PortFault::Kind::protocol, 0,
                   fmt::format("{}: the port changed memory that is not its own", contradiction)};
}

Result<VectorResult> evaluate_with(const Course& course, const FlightPlan& plan,
                                   const ReferenceFlight& reference, PortHost& host,
                                   const JudgeOptions& options) {
  const Stopwatch stopwatch;
  const Case& the_case = *course.the_case;
  const Level level = options.level == Level::exact ? Level::exact : Level::numeric;
  VectorResult result = result_for(the_case, plan.configuration);
  const Lacks& lacks = host.declarations().lacks;
  if (marks_declined(host.declarations(), result) ||
      excludes_flight(lacks, *course.the_case, result)) {
    return result;
  }
  if (lacks.features.any() || !lacks.constants.empty()) {
    // By the flight of the reference: the port's process must not choose what excuses it.
    const auto right = open_reference(course)->fly(plan);
    if (!right) return tl::unexpected(right.error());
    leave_out(lacking_features(lacks, *right, result), result);
    result.has_after_all.clear();  // the port did not fly
    if (result.verdict == Verdict::unsupported) return result;
  }
  auto flown = host.fly(plan);
  if (!flown) return tl::unexpected(flown.error());
  const auto bits = host.declarations().fraction_bits;
  const auto fault = fault_of(course, plan, *flown);
  Result<void> judged;
  for (Trace* trace : {&flown->trace, flown->attitude_trace ? &*flown->attitude_trace : nullptr}) {
    if (fault || trace == nullptr || !judged) continue;
    note_published(lacks, *trace, result);
    trace->present &= ~lacks.outputs;
    if (options.leaves_out_silent) judged = leave_out_silent(lacks, *trace, result);
  }
  if (!judged) return tl::unexpected(judged.error());
  if (!fault) {
    judged = judge_flight(the_case, *flown, reference, level, bits, result);
  } else if (leaves_ticks_to_judge(*fault)) {
    judged = judge_ticks(the_case, *flown, reference, level, bits, result);
    judge_after(*fault, result);
  } else {
    judge(*fault, result);
  }
  if (!judged) return tl::unexpected(judged.error());
  const Tolerances tolerances = tolerances_of(the_case, level, bits, flown->trace.samples.size());
  save_flight(options.save_traces, flown->trace, tolerances, result);
  if (flown->attitude_trace) {
    save_flight(options.save_traces, *flown->attitude_trace, tolerances, result);
  }
  result.elapsed_s = stopwatch.elapsed_s();
  return result;
}

// Errors: the reference does not agree with the golden, so the golden is no judge of a port.
Result<void> check_golden(const Course& course, const FlightPlan& plan,
                          const ReferenceFlight& golden) {
  const auto checked = evaluate_with(course, plan, golden, *open_reference(course), {});
  if (!checked) return tl::unexpected(checked.error());
  if (checked->verdict == Verdict::pass) return {};
  return fail_at(golden.rows.source,
                 fmt::format("at {}, the reference of this attest does not agree with the golden: "
                             "{}; bless it anew, or restore it from version control",
                             plan.configuration.label(), checked->reason));
}

// Whether the flight fails by the golden alone: each output is the reference's, but the flight or
// its metrics differ.
bool fails_by_golden(const VectorResult& result) {
  const bool differs = result.verdict == Verdict::fail || result.verdict == Verdict::non_finite;
  return differs && (!result.first || result.first->stages == only(Stage::input));
}

// For a port with a fixed step (fixed_step.hpp): the case begins one period after zero, and a
// flight of the reference in this shifted case takes the place of the golden. Errors: in the case
// as it is, the reference does not agree with the golden.
Result<VectorResult> evaluate_from_one_period_on(const Course& course, FlightPlan plan,
                                                 const ReferenceFlight& golden, PortHost& host,
                                                 const JudgeOptions& options) {
  const Case& the_case = *course.the_case;
  if (auto checked = check_golden(course, plan, golden); !checked) {
    return tl::unexpected(checked.error());
  }
  const Case begun = the_case.from_one_period_on();
  const auto reference =
      reference_flight(begun, plan.configuration, *course.vehicle_model, plan.timing);
  if (!reference) return tl::unexpected(reference.error());
  plan.from_one_period_on = true;
  return evaluate_with({&begun, course.vehicle_model}, plan, *reference, host, options);
}

}  // namespace

Result<VectorResult> evaluate_flight(const Case& the_case, const RunConfiguration& configuration,
                                     const VehicleModel& vehicle_model, const Golden& golden,
                                     PortHost& host, const JudgeOptions& options) {
  const auto reference = expected_flight(the_case, configuration, vehicle_model.vehicle(), golden);
  if (!reference) return tl::unexpected(reference.error());
  const Course course{&the_case, &vehicle_model};
  const auto plan = FlightPlan::as_scheduled(the_case, configuration);
  if (!has_fixed_step(host.declarations(), the_case)) {
    auto result = evaluate_with(course, plan, *reference, host, options);
    if (!result || !fails_by_golden(*result)) return result;
    const auto checked = check_golden(course, plan, *reference);
    return checked ? std::move(result) : tl::unexpected(checked.error());
  }
  VectorResult result = result_for(the_case, configuration);
  if (has_other_steps(host.declarations(), the_case, configuration.rate.motor_unit, plan.timing,
                      result))
    return result;
  return evaluate_from_one_period_on(course, plan, *reference, host, options);
}

Result<VectorResult> evaluate_timed_flight(const Case& the_case,
                                           const RunConfiguration& configuration,
                                           const VehicleModel& vehicle_model,
                                           const FlightTiming& timing, PortHost& host,
                                           const JudgeOptions& options) {
  VectorResult result = result_for(the_case, configuration);
  if (has_other_steps(host.declarations(), the_case, configuration.rate.motor_unit, timing, result))
    return result;
  const FlightPlan plan{configuration, timing, has_fixed_step(host.declarations(), the_case)};
  Case relaxed = plan.from_one_period_on ? the_case.from_one_period_on() : the_case;
  const auto reference = reference_flight(relaxed, configuration, vehicle_model, timing);
  if (!reference) return tl::unexpected(reference.error());
  for (Metric& metric : relaxed.flight->metrics) {
    const double value = reference->metrics.at(metric.name);
    if (value < metric.min) metric.min = -std::numeric_limits<double>::infinity();
    if (value > metric.max) metric.max = std::numeric_limits<double>::infinity();
  }
  return evaluate_with({&relaxed, &vehicle_model}, plan, *reference, host, options);
}

}  // namespace attest
