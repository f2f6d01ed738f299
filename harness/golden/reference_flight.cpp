#include "harness/golden/reference_flight.hpp"

#include <fmt/format.h>

#include "harness/compare/compare.hpp"
#include "harness/golden/reference.hpp"
#include "harness/loop/case_timing.hpp"
#include "harness/loop/flight.hpp"

namespace attest {
namespace {

// Up to the horizon, another correct build may differ from float32 by ten times as much as double
// does, and still pass.
constexpr double part_of_tolerance = 0.1;

Result<Flown> flown_in(Precision precision, const Course& course, const FlightPlan& plan) {
  const Case& the_case = *course.the_case;
  const auto wrong = [&](const std::string& what) {
    return fail_at(the_case.file.string(),
                   fmt::format("at {}, {}", plan.configuration.label(), what));
  };
  auto flown = open_reference(course, precision)->fly(plan);
  if (!flown) return flown;
  if (flown->fault) return wrong("the reference: " + flown->fault->what);
  if (flown->divergence) {
    return wrong(fmt::format("the reference loses the vehicle at {:.3f} s: {}",
                             in_seconds(flown->divergence->at), flown->divergence->what));
  }
  return flown;
}

double seconds_between(const Sample& first, const Sample& other) {
  return static_cast<double>(other.in.timestamp - first.in.timestamp) * 1e-6;
}

double horizon_s(const Trace& flown, const Trace& in_double, const Case& the_case) {
  const auto tolerances = tolerances_of(the_case, Level::numeric, {}, flown.samples.size());
  const auto parted = compare(in_double, flown, tolerances.scaled(part_of_tolerance)).first;
  const Sample& end = parted ? flown.samples[parted->tick] : flown.samples.back();
  return seconds_between(flown.samples.front(), end);
}

}  // namespace

Result<ReferenceFlight> reference_flight(const Case& the_case,
                                         const RunConfiguration& configuration,
                                         const VehicleModel& vehicle_model,
                                         const FlightTiming& timing) {
  const Course course{&the_case, &vehicle_model};
  const FlightPlan plan{configuration, timing};
  auto flown = flown_in(Precision::binary32, course, plan);
  if (!flown) return tl::unexpected(flown.error());
  const auto in_double = flown_in(Precision::binary64, course, plan);
  if (!in_double) return tl::unexpected(in_double.error());

  ReferenceFlight result;
  for (const Metric& metric : the_case.flight->metrics) {
    result.metrics[metric.name] = measured(metric, *flown);
  }
  result.horizon_s = horizon_s(flown->trace, in_double->trace, the_case);
  result.rows = std::move(flown->trace);
  return result;
}

Result<ReferenceFlight> reference_flight(const Case& the_case,
                                         const RunConfiguration& configuration,
                                         const VehicleModel& vehicle_model) {
  auto flight = reference_flight(the_case, configuration, vehicle_model,
                                 flight_timing(the_case, configuration.rate));
  if (!flight) return flight;
  for (const Metric& metric : the_case.flight->metrics) {
    const double value = flight->metrics[metric.name];
    if (!(value >= metric.min && value <= metric.max)) {
      return fail_at(the_case.file.string(),
                     fmt::format("at {}, the reference misses the metric `{}`: {} is {:.4g}, not "
                                 "from {:g} to {:g}",
                                 configuration.label(), metric.name, name_of(metric.measure), value,
                                 metric.min, metric.max));
    }
  }
  return flight;
}

}  // namespace attest
