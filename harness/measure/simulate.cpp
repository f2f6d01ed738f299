#include "harness/measure/simulate.hpp"

#include <utility>

#include "harness/core/file.hpp"
#include "harness/ulog/trace_log.hpp"
#include "harness/verify/evaluate.hpp"
#include "harness/verify/fixed_step.hpp"
#include "harness/verify/judge.hpp"

namespace attest {
Result<CaseResult> simulate_flight(const Case& the_case, FlightPlan plan, PortHost& host,
                                   const std::filesystem::path& out) {
  CaseResult result = result_for(the_case, plan.configuration);
  const PortSays& port = host.says();
  if (has_other_steps(port, the_case, plan.configuration.rate, plan.timing, result)) return result;
  if (declines(port, result)) return result;
  plan.from_one_period_on = has_fixed_step(port, the_case);
  const auto flown = host.fly(plan);
  if (!flown) return tl::unexpected(flown.error());
  if (flown->fault) {
    judge(*flown->fault, result);
    return result;
  }
  result.ticks = flown->trace.samples.size();
  if (auto written = write_trace(out, flown->trace); !written) {
    return tl::unexpected(written.error());
  }
  if (flown->divergence) {
    result.verdict = Verdict::fail;
    result.reason = how_it_ended(*flown);
    return result;
  }
  for (const Metric& metric : the_case.flight->metrics) {
    const double value = measured(metric, flown->trace);
    result.metrics.push_back(
        {metric.name, metric.measure, value, value, 0, metric.min, metric.max});
    if (!result.metrics.back().within()) result.verdict = Verdict::fail;
  }
  return result;
}

}  // namespace attest
