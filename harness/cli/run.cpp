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
#include "harness/diagnosis/diagnosis_job.hpp"
#include "harness/port/port.hpp"
#include "harness/process/child.hpp"
#include "harness/report/progress.hpp"
#include "harness/report/report_format.hpp"
#include "harness/report/terminal.hpp"
#include "harness/report/text.hpp"
#include "harness/verify/case_job.hpp"
#include "harness/verify/expected.hpp"

namespace attest::cli {
namespace {

// A report file, opened before the run so that a path that cannot be written is reported at once.
struct ReportFile {
  AtomicFile file;
  const ReportFormat& format;
};

Result<std::vector<ReportFile>> open_reports(const RunOptions& options) {
  std::vector<ReportFile> reports;
  for (const ReportFormat& format : report_formats()) {
    const std::string& path = options.reports.at(format.option);
    if (path.empty()) continue;
    auto file = AtomicFile::open(path);
    if (!file) return tl::unexpected(file.error());
    reports.push_back({*std::move(file), format});
  }
  return reports;
}

Result<void> write_reports(std::vector<ReportFile>& reports, const RunResult& run,
                           const std::optional<Diagnosis>& diagnosis) {
  for (auto& [file, format] : reports) {
    if (auto written = file.write(format.render(run, diagnosis)); !written) return written;
    if (auto committed = file.commit(); !committed) return committed;
  }
  return {};
}

// The whole run, complete and checked before the first vector runs.
struct RunPlan {
  RunResult run;
  std::optional<ExpectedFailures> expected;
  std::vector<SelectedCase> cases;
  HostOptions host;
  Jobs<CaseResult> jobs;
  std::size_t results = 0;
};

// Stores the port's description and the profiles that it supports. The port must give the same
// answers during the run. A port that hangs here has no description and is not asked again.
Result<void> ask_port(const std::vector<std::string>& profiles, RunPlan& plan) {
  const auto port = describe_port(plan.host, profiles);
  if (!port) return tl::unexpected(port.error());
  for (const auto& [profile, words] : port->refusals) {
    if (words.empty()) continue;
    fmt::print(stderr, "attest: note: the port made no unit of {}; it printed: {}\n", profile,
               one_line(words));
  }
  plan.run.port_name = port->name;
  plan.run.port_version = port->version;
  plan.run.fraction_bits = port->fraction_bits;
  plan.run.fixed_step = port->fixed_step;
  plan.host.hangs = port->hangs;
  if (port->hangs.empty()) plan.host.said = *port;
  return {};
}

// The selected cases, each at its own times.
Result<void> plan_cases(const RunOptions& options, const SuiteFolder& suite, RunPlan& plan) {
  auto cases = options.select.cases_in(suite.cases());
  if (!cases) return tl::unexpected(cases.error());
  std::set<Rate> rates;
  bool all_configurations = options.select.shard == "1/1";
  for (const SelectedCase& selected : *cases) {
    all_configurations &=
        selected.configurations.size() == selected.the_case.configurations().size();
    for (const RunConfiguration& configuration : selected.configurations)
      rates.insert(configuration.rate);
    plan.results += selected.configurations.size();
  }
  std::set<std::string> profiles;
  for (const SelectedCase& selected : *cases) profiles.insert(selected.the_case.profile);
  if (auto asked = ask_port({profiles.begin(), profiles.end()}, plan); !asked) return asked;
  VehicleModels vehicle_models(suite.models());
  auto jobs = case_jobs(*cases, suite.golden(), vehicle_models,
                        {plan.run.level, options.save_traces}, plan.host);
  if (!jobs) return tl::unexpected(jobs.error());
  plan.jobs = *std::move(jobs);
  plan.run.selection = options.select.narrowing();
  plan.run.all_configurations = all_configurations;
  plan.run.rates.assign(rates.begin(), rates.end());
  plan.cases = std::move(*cases);
  return {};
}

// The one flight of a recorded timing.
Result<void> plan_timed(const RunOptions& options, const SuiteFolder& suite, RunPlan& plan) {
  if (!options.select.selects_all())
    return fail("--timing selects the flight; leave out all other selections");
  auto flight = find_timed_flight(options.timing, suite);
  if (!flight) return tl::unexpected(flight.error());
  if (auto asked = ask_port({flight->the_case.profile}, plan); !asked) return asked;
  plan.results = 1;
  plan.run.timing = options.timing;
  plan.run.rates = {flight->timing.configuration.rate};
  plan.jobs.push_back(
      std::make_unique<TimedJob>(std::move(flight->the_case), std::move(flight->timing),
                                 std::move(flight->vehicle_model), options.save_traces, plan.host));
  return {};
}

// The date in UTC. With SOURCE_DATE_EPOCH, reports do not depend on the day.
Result<std::string> date_of_run() {
  std::time_t now = std::time(nullptr);
  if (const char* given = std::getenv("SOURCE_DATE_EPOCH"); given && *given) {
    const std::string_view text(given);
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), now);
    if (error != std::errc() || end != text.data() + text.size() || now < 0) {
      return fail(fmt::format("SOURCE_DATE_EPOCH is `{}`; it must be a count of seconds", text));
    }
  }
  return fmt::format("{:%Y-%m-%d}", fmt::gmtime(now));
}

// Of the port's file, or of the hashes of its files if it has several. Empty: it has none.
Result<std::string> sha256_of_port(const std::string& port) {
  std::vector<std::string> hashes;
  for (const std::string& file : files_of(port)) {
    auto hash = sha256_of_file(file);
    if (!hash) return tl::unexpected(hash.error());
    hashes.push_back(*std::move(hash));
  }
  if (hashes.size() <= 1) return hashes.empty() ? "" : hashes.front();
  return sha256(fmt::format("{}\n", fmt::join(hashes, "\n")));
}

// Adds the subject of the conformance statement: suite, port and date.
Result<void> identify(const RunOptions& options, const SuiteFolder& suite, RunResult& run) {
  run.suite = suite.cases_by_group();
  run.cases_version = suite.version_of(suite.cases());
  run.golden_version = suite.version_of(suite.golden());
  run.attest_version = version;
  run.port = options.host.port;
  run.limits = {!options.host.in_process, options.host.timeout_s,
                memory_is_limited() ? std::optional(max_memory_gib) : std::nullopt, max_file_mib};
  auto hash = suite.sha256();
  if (!hash) return tl::unexpected(hash.error());
  run.suite_sha256 = *hash;
  run.suite_is_released = run.suite_sha256 == released_suite_sha256();
  auto of_port = sha256_of_port(run.port);
  if (!of_port) return tl::unexpected(of_port.error());
  run.port_sha256 = *std::move(of_port);
  auto date = date_of_run();
  if (!date) return tl::unexpected(date.error());
  run.date = *date;
  return {};
}

Result<RunPlan> make_plan(const RunOptions& options, const SuiteFolder& suite) {
  auto level = parse_level(options.level);
  if (!level) return tl::unexpected(level.error());
  RunPlan plan;
  plan.host = options.host;
  plan.host.stop = interrupted;
  plan.run.level = *level;
  if (!options.expected_failures.empty()) {
    auto expected = ExpectedFailures::read(options.expected_failures);
    if (!expected) return tl::unexpected(expected.error());
    plan.expected = std::move(*expected);
  }
  const auto planned =
      options.timing.empty() ? plan_cases(options, suite, plan) : plan_timed(options, suite, plan);
  if (!planned) return tl::unexpected(planned.error());
  // After the port was loaded, because loading gives the better error for a file that is not a
  // library.
  if (auto known = identify(options, suite, plan.run); !known) {
    return tl::unexpected(known.error());
  }
  return plan;
}

// The diagnosis of the failures. Its errors are printed and do not change verdicts.
std::optional<Diagnosis> diagnosed(const RunPlan& plan, int processes) {
  JobOptions<VectorDiagnosis> options;
  options.processes = processes;
  options.in_process = plan.host.in_process;
  options.stop = interrupted;
  const auto vectors = [&](const faults::Fault* partner) {
    std::vector<VectorSimilarity> similarities;
    const auto jobs = diagnosis_jobs(plan.cases, plan.run.results, plan.host, partner);
    auto outcome = run_jobs(jobs, options);
    if (!outcome.errors.empty() && !interrupted()) {
      fmt::print(stderr, "attest: diagnosis: {}\n", outcome.errors.front().to_string());
    }
    for (VectorDiagnosis& vector : outcome.results) {
      if (vector) similarities.push_back(*std::move(vector));
    }
    return similarities;
  };
  auto diagnosis = diagnose(vectors(nullptr));
  if (diagnosis && wants_partner(*diagnosis)) {
    add_partner(vectors(diagnosis->suspects.front().fault), *diagnosis);
  }
  if (!interrupted()) return diagnosis;
  // It would rest on some of the vectors only. The verdicts are complete.
  fmt::print(stderr, "attest: interrupted; the reports do not have the probable mistake\n");
  return std::nullopt;
}

// 0 requires that at least one vector was compared: a port without support for any does not
// conform.
int exit_code(const RunResult& run) {
  if (!run.errors.empty()) return exit_usage;
  if (run.failed()) return exit_failed;
  const bool compared = run.count(Verdict::pass) + run.count(Verdict::xfail) > 0;
  if (!compared) {
    return report_error(
        {"no vector was compared: every selected vector was skipped or unsupported"});
  }
  return exit_ok;
}

}  // namespace

int run_command(const RunOptions& options, const Globals& globals) {
  const auto begin = std::chrono::steady_clock::now();
  note_interrupts();  // before the first request to the port, which may hang
  const auto suite = find_suite(globals.suite);
  if (!suite) return report_error(suite.error());
  std::vector<std::string> outputs;
  for (const auto& [option, path] : options.reports) outputs.push_back(path);
  const auto checked = check_outputs(
      outputs, {options.host.port, {options.expected_failures, options.timing}}, *suite);
  if (!checked) return report_error(checked.error());
  if (const auto ready = prepare_trace_folder(options.save_traces, *suite); !ready) {
    return report_error(ready.error());
  }
  auto plan = make_plan(options, *suite);
  if (!plan) return report_error(plan.error());
  plan->run.suite_folder = globals.suite;
  auto reports = open_reports(options);
  if (!reports) return report_error(reports.error());

  Progress progress(plan->results, Progress::on_stderr(globals.quiet));
  JobOptions<CaseResult> jobs;
  jobs.processes = options.jobs;
  jobs.in_process = options.host.in_process;
  jobs.fail_fast = options.fail_fast;
  jobs.on_result = [&](const CaseResult& result) { progress.add(result); };
  jobs.fails = [&](const CaseResult& result) {
    return fails_a_run(result.verdict) && !(plan->expected && plan->expected->expects(result));
  };
  jobs.stop = interrupted;
  JobResults<CaseResult> outcome = run_jobs(plan->jobs, jobs);
  progress.finish();
  if (interrupted()) {
    fmt::print(stderr, "attest: interrupted; no report was written\n");
    return exit_interrupted;
  }

  RunResult& run = plan->run;
  run.results = std::move(outcome.results);
  run.errors = std::move(outcome.errors);
  run.stopped_early = outcome.stopped_early;
  const bool is_complete = options.timing.empty() && options.select.selects_all() &&
                           !run.stopped_early && run.errors.empty();
  if (plan->expected) plan->expected->apply(is_complete, run);
  std::optional<Diagnosis> diagnosis;
  if (options.diagnose && run.failed()) diagnosis = diagnosed(*plan, options.jobs);
  // Before the summary: if its reader closes the pipe early, SIGPIPE ends this process.
  const auto written = write_reports(*reports, run, diagnosis);
  const int code = exit_code(run);
  if (!options.save_traces.empty() && run.failed()) {
    fmt::print(stderr, "attest: note: the traces of the failing vectors are in {}\n",
               options.save_traces);
  }
  if (!globals.quiet || code != exit_ok) {
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - begin;
    fmt::print("{}", render_summary(run, wall.count(), terminal_style(stdout), diagnosis));
  }
  if (!written) return report_error(written.error());
  return code;
}

}  // namespace attest::cli
