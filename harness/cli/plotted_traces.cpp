#include "harness/cli/plotted_traces.hpp"

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "harness/core/interrupt.hpp"
#include "harness/plant/vehicle_models.hpp"
#include "harness/report/html/plots.hpp"
#include "harness/report/report.hpp"

namespace attest::cli {

Result<PlottedTraces> PlottedTraces::prepare(const RunOptions& options) {
  PlottedTraces traces;
  const auto formats = report_formats();
  const bool needed = std::any_of(formats.begin(), formats.end(), [&](const ReportFormat& format) {
    return format.plots_traces && !options.report.files.at(format.option).empty();
  });
  if (!needed) return traces;
  traces.folder_ = options.save_traces;
  if (!traces.folder_.empty()) return traces;
  auto made = TemporaryFolder::make("plots");
  if (!made) return tl::unexpected(made.error());
  traces.folder_ = made->path();
  traces.temporary_.emplace(*std::move(made));
  return traces;
}

RunOptions PlottedTraces::planned(RunOptions options) const {
  if (temporary_ && !options.timing.empty()) options.save_traces = folder_.string();
  return options;
}

void PlottedTraces::save(const RunPlan& plan, const SuiteFolder& suite, const RunOptions& options,
                         const std::string& named) const {
  std::set<std::string> ids;
  for (const VectorResult* result : vectors_to_plot(plan.run, named)) ids.insert(result->id());
  if (!temporary_ || !options.timing.empty() || ids.empty()) return;
  VehicleModels vehicle_models(suite.models());
  const auto jobs =
      case_jobs(keep_vectors(plan.cases, ids),
                std::make_shared<const Goldens>(suite.golden(), plan.suite), vehicle_models,
                {plan.run.level, folder_, plan.run.parameters, false,
                 judged_by_reference(suite, plan.run.suite_reference)},
                plan.host);
  JobOptions<VectorResult> again;
  again.processes = options.jobs;
  again.in_process = plan.host.in_process;
  again.stop = interrupted;
  std::vector<Error> errors;
  if (jobs)
    errors = run_jobs(*jobs, again).errors;
  else
    errors = {jobs.error()};
  if (errors.empty() || interrupted()) return;
  fmt::print(stderr, "attest: plots: {}\n", errors.front().to_string());
}

}  // namespace attest::cli
