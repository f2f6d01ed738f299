#include <charconv>
#include <chrono>
#include <cstdlib>
#include <ctime>
#include <optional>
#include <set>
#include <utility>

#include <fmt/chrono.h>
#include <fmt/format.h>

#include "harness/cli/command.hpp"
#include "harness/cli/find_case.hpp"
#include "harness/cli/interrupt.hpp"
#include "harness/cli/outputs.hpp"
#include "harness/cli/suite_folder.hpp"
#include "harness/core/file.hpp"
#include "harness/core/version.hpp"
#include "harness/port/port.hpp"
#include "harness/report/json.hpp"
#include "harness/report/junit.hpp"
#include "harness/report/progress.hpp"
#include "harness/report/statement.hpp"
#include "harness/report/terminal.hpp"
#include "harness/suite/diagnosis_batch.hpp"
#include "harness/suite/expected.hpp"
#include "harness/suite/worker.hpp"

namespace attest::cli {
namespace {

// A report file, opened before the run so that a path that cannot be written is said at once.
struct ReportFile {
  AtomicFile file;
  std::string (*render)(const RunResult&);
};

Result<std::vector<ReportFile>> open_reports(const RunOptions& options) {
  std::vector<ReportFile> reports;
  using Render = std::string (*)(const RunResult&);
  const std::pair<const std::string&, Render> wanted[] = {
      {options.junit, junit_report},
      {options.json, json_report},
      {options.badge, badge},
      {options.write_expected, expected_failures_of}};
  for (const auto& [path, render] : wanted) {
    if (path.empty()) continue;
    auto file = AtomicFile::open(path);
    if (!file) return tl::unexpected(file.error());
    reports.push_back({std::move(*file), render});
  }
  return reports;
}

Result<void> write_reports(std::vector<ReportFile>& reports, const RunResult& run) {
  for (auto& [file, render] : reports) {
    if (auto written = file.write(render(run)); !written) return written;
    if (auto committed = file.commit(); !committed) return committed;
  }
  return {};
}

// What is to be run, complete and checked, before the first case runs.
struct RunPlan {
  RunResult run;
  std::optional<ExpectedFailures> expected;
  std::vector<SelectedCase> cases;
  Batches batches;
  std::size_t results = 0;
  std::optional<PortSays> said;
};

// The cases that are selected, each at its own times.
Result<void> plan_cases(const RunOptions& options, const SuiteFolder& suite, RunPlan& plan) {
  auto cases = options.select.cases_in(suite.cases());
  if (!cases) return tl::unexpected(cases.error());
  std::set<Rate> rates;
  for (const SelectedCase& selected : *cases) {
    for (const Setup& setup : selected.setups) rates.insert(setup.rate);
    plan.results += selected.setups.size();
  }
  Fleet fleet(suite.models());
  auto batches = make_batches(*cases, suite.golden(), fleet, plan.run.level);
  if (!batches) return tl::unexpected(batches.error());
  plan.batches = std::move(*batches);
  plan.run.selection = options.select.narrowing();
  plan.run.all_setups = options.select.selects_all_setups();
  plan.run.rates.assign(rates.begin(), rates.end());
  plan.cases = std::move(*cases);
  return {};
}

// The one flight of a recorded timing.
Result<void> plan_timed(const RunOptions& options, const SuiteFolder& suite, RunPlan& plan) {
  if (!options.select.selects_all()) return fail("--timing says what to run; select nothing else");
  auto flight = find_timed_flight(options.timing, suite);
  if (!flight) return tl::unexpected(flight.error());
  plan.results = 1;
  plan.run.timing = options.timing;
  plan.run.rates = {flight->timing.setup.rate};
  plan.batches.push_back(std::make_unique<TimedBatch>(
      std::move(flight->the_case), std::move(flight->timing), std::move(flight->airframe)));
  return {};
}

// Of the day, in UTC; SOURCE_DATE_EPOCH makes reports the same on every day.
Result<std::string> date_of_run() {
  std::time_t now = std::time(nullptr);
  if (const char* given = std::getenv("SOURCE_DATE_EPOCH"); given && *given) {
    const std::string_view text(given);
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), now);
    if (error != std::errc() || end != text.data() + text.size() || now < 0) {
      return fail(fmt::format("SOURCE_DATE_EPOCH is `{}`; it is a count of seconds", text));
    }
  }
  return fmt::format("{:%Y-%m-%d}", fmt::gmtime(now));
}

// What a statement of conformance is about: which suite, which port, when.
Result<void> identify(const RunOptions& options, const SuiteFolder& suite, RunResult& run) {
  run.suite = suite.cases_by_group();
  run.cases_version = suite.version_of(suite.cases());
  run.golden_version = suite.version_of(suite.golden());
  run.attest_version = version;
  run.port = options.worker.port;
  auto hash = suite.sha256();
  if (!hash) return tl::unexpected(hash.error());
  run.suite_sha256 = *hash;
  run.suite_is_released = run.suite_sha256 == released_suite_sha256();
  if (const auto library = library_of(run.port)) {
    auto of_port = sha256_of_file(*library);
    if (!of_port) return tl::unexpected(of_port.error());
    run.port_sha256 = *of_port;
  }
  auto date = date_of_run();
  if (!date) return tl::unexpected(date.error());
  run.date = *date;
  return {};
}

// What the port is held to during the run; empty for one that gave no answer.
std::optional<PortSays> said_by(const PortDescription& port, const RunPlan& plan,
                                const WorkerOptions& worker) {
  if (!port.hangs.empty()) return std::nullopt;
  std::set<std::string> profiles;
  for (const SelectedCase& selected : plan.cases) profiles.insert(selected.the_case.profile);
  PortSays said = port;
  said.profiles = supported_profiles(worker.port, {profiles.begin(), profiles.end()},
                                     worker.timeout_s, interrupted);
  return said;
}

Result<RunPlan> make_plan(const RunOptions& options, const SuiteFolder& suite) {
  auto level = parse_level(options.level);
  if (!level) return tl::unexpected(level.error());
  auto port = describe_port(options.worker.port, {}, options.worker.timeout_s, interrupted);
  if (!port) return tl::unexpected(port.error());

  RunPlan plan;
  if (!options.expected_failures.empty()) {
    auto expected = ExpectedFailures::read(options.expected_failures);
    if (!expected) return tl::unexpected(expected.error());
    plan.expected = std::move(*expected);
  }
  if (auto known = identify(options, suite, plan.run); !known) {
    return tl::unexpected(known.error());
  }
  plan.run.port_name = port->name;
  plan.run.port_version = port->version;
  plan.run.fraction_bits = port->fraction_bits;
  plan.run.fixed_step = port->fixed_step;
  plan.run.level = *level;
  const auto planned =
      options.timing.empty() ? plan_cases(options, suite, plan) : plan_timed(options, suite, plan);
  if (!planned) return tl::unexpected(planned.error());
  plan.said = said_by(*port, plan, options.worker);
  return plan;
}

// What the failures look like; nothing that goes wrong here spoils the verdicts that are there.
std::optional<Diagnosis> diagnosed(const RunPlan& plan, const WorkerOptions& options) {
  WorkerOptions worker = options;
  worker.on_result = [](const CaseResult&) {};
  worker.fail_fast = false;
  const auto vectors = [&](const faults::Fault* partner) {
    std::vector<VectorLikeness> likenesses;
    const Batches batches = diagnosis_batches(plan.cases, plan.run.results, partner);
    for (CaseResult& result : run_batches(batches, worker).results) {
      if (result.likeness) likenesses.push_back(std::move(*result.likeness));
    }
    return likenesses;
  };
  auto diagnosis = diagnose(vectors(nullptr));
  if (diagnosis && wants_partner(*diagnosis)) {
    add_partner(vectors(diagnosis->suspects.front().fault), *diagnosis);
  }
  return diagnosis;
}

// 0 only when something was compared: a port that supports nothing has not conformed.
int exit_code(const RunResult& run) {
  if (!run.errors.empty()) return exit_usage;
  if (run.failed()) return exit_failed;
  const bool compared = run.count(Verdict::pass) + run.count(Verdict::xfail) > 0;
  if (!compared) {
    return report_error({"nothing was compared: every selected case was skipped or unsupported"});
  }
  return exit_ok;
}

}  // namespace

int run_command(const RunOptions& options, const Globals& globals) {
  const auto begin = std::chrono::steady_clock::now();
  note_interrupts();  // before the port is asked anything, which may hang
  const auto suite = find_suite(globals.suite);
  if (!suite) return report_error(suite.error());
  const auto checked =
      check_outputs({options.junit, options.json, options.badge, options.write_expected},
                    {options.worker.port, {options.expected_failures, options.timing}}, *suite);
  if (!checked) return report_error(checked.error());
  auto plan = make_plan(options, *suite);
  if (!plan) return report_error(plan.error());
  auto reports = open_reports(options);
  if (!reports) return report_error(reports.error());

  Progress progress(plan->results, Progress::on_stderr(globals.quiet));
  WorkerOptions worker = options.worker;
  worker.said = plan->said;
  worker.on_result = [&](const CaseResult& result) { progress.add(result); };
  worker.fails = [&](const CaseResult& result) {
    return fails_a_run(result.verdict) && !(plan->expected && plan->expected->expects(result));
  };
  worker.stop = interrupted;
  WorkerOutcome outcome = run_batches(plan->batches, worker);
  progress.finish();
  if (interrupted()) {
    fmt::print(stderr, "attest: interrupted; no report was written\n");
    return exit_interrupted;
  }

  RunResult& run = plan->run;
  run.results = std::move(outcome.results);
  run.errors = std::move(outcome.errors);
  run.stopped_early = outcome.stopped_early;
  if (plan->expected) plan->expected->apply(options.select.selects_all(), run);
  if (options.diagnose && run.failed()) run.diagnosis = diagnosed(*plan, worker);
  // Before the summary: whoever reads that may stop reading, and end the program.
  const auto written = write_reports(*reports, run);
  const int code = exit_code(run);
  if (!globals.quiet || code != exit_ok) {
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - begin;
    fmt::print("{}", render_summary(run, wall.count(), terminal_style(stdout)));
  }
  if (!written) return report_error(written.error());
  return code;
}

}  // namespace attest::cli
