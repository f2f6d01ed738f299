#include <algorithm>
#include <filesystem>
#include <optional>

#include <fmt/format.h>

#include "harness/cli/command.hpp"
#include "harness/cli/interrupt.hpp"
#include "harness/cli/outputs.hpp"
#include "harness/cli/suite_folder.hpp"
#include "harness/core/file.hpp"
#include "harness/realtime/instructions.hpp"
#include "harness/report/progress.hpp"
#include "harness/report/time_text.hpp"
#include "harness/suite/time_batch.hpp"

namespace attest::cli {
namespace {

// Of the controller. A flight's steps cannot be repeated without flying it again, and their inputs
// are no others.
Result<std::vector<SelectedCase>> open_loop_cases(const TimeCommandOptions& options,
                                                  const SuiteFolder& suite) {
  auto cases = options.select.cases_in(suite.cases());
  if (!cases) return cases;
  std::erase_if(*cases, [](const SelectedCase& one) {
    return one.the_case.flight || one.the_case.part != Part::mc_att_control;
  });
  if (cases->empty()) return fail("nothing of the controller in open loop is selected to be timed");
  return cases;
}

// Under callgrind, with the time to start; measured are factors of 50 to 100.
constexpr double counting_is_slower_by = 100;

// This program again, on that vector only, once.
std::vector<std::uint64_t> counted(const TimeCommandOptions& options, const SuiteFolder& suite,
                                   const std::string& id) {
  std::error_code ignored;
  const auto self = std::filesystem::read_symlink("/proc/self/exe", ignored);
  return instructions_of_calls(
      {self.string(), "--suite", suite.root.string(), "--quiet", "time", "--port",
       options.worker.port, "--filter", id, "--repeat", "1", "--no-stack", "--in-process"},
      counted_step_symbol, {options.worker.timeout_s * counting_is_slower_by, interrupted});
}

}  // namespace

int time_command(const TimeCommandOptions& options, const Globals& globals) {
  const auto suite = find_suite(globals.suite);
  if (!suite) return report_error(suite.error());
  const auto checked =
      check_outputs({options.json, options.measure.worst}, {options.worker.port, {}}, *suite);
  if (!checked) return report_error(checked.error());
  auto cases = open_loop_cases(options, *suite);
  if (!cases) return report_error(cases.error());
  const auto port = describe_port(options.worker.port, {}, options.worker.timeout_s);
  if (!port) return report_error(port.error());

  note_interrupts();
  TimeRun run{options.worker.port, options.measure.repeats, options.measure.budget_us, {}, {}};
  Batches batches;
  batches.push_back(std::make_unique<TimeBatch>(std::move(*cases), options.measure));
  Progress progress(batches.front()->size(), Progress::on_stderr(globals.quiet));
  WorkerOptions worker = options.worker;
  worker.on_result = [&](const CaseResult& result) { progress.add(result); };
  worker.stop = interrupted;
  WorkerOutcome outcome = run_batches(batches, worker);
  progress.finish();
  if (interrupted()) return exit_interrupted;
  if (!outcome.errors.empty()) return report_error(outcome.errors.front());
  run.results = std::move(outcome.results);
  const bool wrong = std::any_of(run.results.begin(), run.results.end(),
                                 [](const auto& one) { return fails_a_run(one.verdict); });
  if (run.all().figures.empty() || run.all().figures.at(figure::steps) == 0) {
    if (wrong) {
      fmt::print("{}", what_went_wrong(run));
      return exit_failed;
    }
    return report_error({"nothing was timed: every selected case was skipped or unsupported"});
  }
  if (options.instructions) {
    run.instructions = counted(options, *suite, run.all().reason);
    if (run.instructions.empty()) {
      fmt::print(stderr, "attest: no instructions were counted: valgrind is missing, or failed\n");
    }
  }
  if (auto written = write_file(options.json, time_json(run)); !written)
    return report_error(written.error());
  const bool over = run.all().figures.at(figure::over_budget) > options.allowed;
  const bool failed = over || wrong;
  if (!globals.quiet || failed) fmt::print("{}", render_times(run));
  return failed ? exit_failed : exit_ok;
}

}  // namespace attest::cli
