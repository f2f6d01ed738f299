#include "harness/verify/simulate.hpp"

#include <utility>

#include "harness/verify/evaluate.hpp"
#include "harness/verify/fixed_step.hpp"
#include "harness/verify/judge.hpp"
#include "harness/verify/reference_comparison.hpp"

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

Result<void> note_deviations(const Case& the_case, const Declarations& port,
                             SimulatedFlight& flight) {
  Flown flown = flight.flown;
  for (Trace* trace : {&flown.trace, flown.attitude_trace ? &*flown.attitude_trace : nullptr}) {
    if (trace) trace->present &= ~port.lacks.outputs;
  }
  const std::size_t ticks = flown.trace.samples.size();
  if (ticks == 0) return {};
  const auto compared = compare_with_reference(
      flown, the_case.profile, tolerances_of(the_case, Level::numeric, port.fraction_bits, ticks),
      port.fraction_bits);
  if (!compared) return tl::unexpected(compared.error());
  flight.result.first = compared->first;
  flight.result.worst = compared->worst;
  return {};
}

}  // namespace attest
