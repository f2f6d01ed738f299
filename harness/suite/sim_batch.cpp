#include "harness/suite/sim_batch.hpp"

#include "harness/core/float_environment.hpp"
#include "harness/process/child.hpp"
#include "harness/run/flight.hpp"
#include "harness/suite/evaluate.hpp"
#include "harness/suite/fixed_step.hpp"
#include "harness/suite/judge.hpp"
#include "harness/trace/csv.hpp"

namespace attest {
namespace {

Result<void> write_flown(const Trace& trace, const std::filesystem::path& path) {
  allow_large_files();
  auto file = AtomicFile::open(path);
  if (!file) return tl::unexpected(file.error());
  CsvColumns columns = all_columns(trace);
  columns.plant = true;
  if (auto written = write_csv(trace, columns, *file); !written) return written;
  return file->commit();
}

}  // namespace

CaseResult SimBatch::identity(std::size_t) const { return unjudged(case_, setup_); }

Result<CaseResult> SimBatch::evaluate(std::size_t, Port& port) {
  CaseResult result = unjudged(case_, setup_);
  if (has_other_steps(port, case_, setup_.rate, timing_, result)) return result;
  const auto unit = create_unit(port, case_.profile, result);
  if (!unit) return result;
  const Case& flies = has_fixed_step(port, case_) ? from_one_period_on(case_) : case_;
  const auto flown = fly(flies, setup_, *airframe_, *unit, timing_);
  if (!flown) return tl::unexpected(flown.error());
  if (flown->fault) {
    judge(*flown->fault, result);
    return result;
  }
  const DefaultFloatEnvironment environment;
  result.ticks = flown->trace.samples.size();
  if (auto written = write_flown(flown->trace, out_); !written) {
    return tl::unexpected(written.error());
  }
  if (flown->divergence) {
    result.verdict = Verdict::fail;
    result.reason = how_it_ended(*flown);
    return result;
  }
  for (const Metric& metric : case_.flight->metrics) {
    const double value = measured(metric, flown->trace);
    result.metrics.push_back(
        {metric.name, metric.measure, value, value, 0, metric.min, metric.max});
    if (!result.metrics.back().within()) result.verdict = Verdict::fail;
  }
  return result;
}

}  // namespace attest
