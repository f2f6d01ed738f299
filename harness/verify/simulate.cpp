#include "harness/verify/simulate.hpp"

#include <utility>

#include "harness/verify/evaluate.hpp"
#include "harness/verify/fixed_step.hpp"
#include "harness/verify/judge.hpp"

namespace attest {

Result<SimulatedFlight> simulate_flight(const Case& the_case, FlightPlan plan, PortHost& host) {
  SimulatedFlight flight{result_for(the_case, plan.configuration), {}};
  VectorResult& result = flight.result;
  const Declarations& port = host.declarations();
  if (has_other_steps(port, the_case, plan.configuration.rate.motor_unit, plan.timing, result))
    return flight;
  if (marks_declined(port, result)) return flight;
  plan.from_one_period_on = has_fixed_step(port, the_case);
  auto flown = host.fly(plan);
  if (!flown) return tl::unexpected(flown.error());
  if (flown->fault) {
    judge(*flown->fault, result);
    return flight;
  }
  result.ticks = flown->trace.samples.size();
  if (flown->divergence) {
    result.verdict = Verdict::fail;
    result.reason = how_it_ended(*flown);
    flight.flown = *std::move(flown);
    return flight;
  }
  for (const Metric& metric : the_case.flight->metrics) {
    const double value = measured(metric, *flown);
    result.metrics.push_back(
        {metric.name, metric.measure, value, value, 0, metric.min, metric.max});
    if (!result.metrics.back().within()) result.verdict = Verdict::fail;
  }
  flight.flown = *std::move(flown);
  return flight;
}

}  // namespace attest
