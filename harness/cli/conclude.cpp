#include "harness/cli/conclude.hpp"

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <string>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include "harness/cli/run_plan.hpp"
#include "harness/cli/supported_profiles.hpp"
#include "harness/core/interrupt.hpp"
#include "harness/diagnosis/diagnose_run.hpp"
#include "harness/report/conclusion.hpp"
#include "harness/report/github.hpp"
#include "harness/report/terminal.hpp"
#include "harness/report/text.hpp"
#include "harness/verify/silent_topics.hpp"

namespace attest::cli {
namespace {

Result<void> write_reports(std::vector<ReportFile>& reports, const Report& report) {
  for (auto& [file, format] : reports) {
    if (auto written = file.commit(format.render(report)); !written) return written;
  }
  return {};
}

// The diagnosis of the failures. An error is printed and does not change verdicts.
std::optional<Diagnosis> diagnosed(const RunResult& run, const Examined& examined) {
  DiagnosisOptions options;
  options.processes = examined.jobs;
  options.stop = interrupted;
  HostOptions host = examined.host;
  // That a topic is never published is said already, and must not look like a mistake in the law.
  if (host.said) host.said->lacks.outputs |= never_published_outputs(run.results);
  options.on_error = [](const Error& error) {
    if (!interrupted()) fmt::print(stderr, "attest: diagnosis: {}\n", error.to_string());
  };
  auto diagnosis = diagnose_run(run, examined.cases, host, options);
  if (!interrupted()) return diagnosis;
  // This diagnosis used only some of the vectors. The verdicts are complete.
  fmt::print(stderr, "attest: interrupted; the reports do not have the probable mistake\n");
  return std::nullopt;
}

// If no vector was compared because the port supports none of their profiles: what it supports.
std::optional<Error> other_profiles(const RunResult& run, const Examined& examined) {
  const auto applies = [](const VectorResult& result) {
    return result.applies || result.verdict != Verdict::skip;
  };
  if (!run.errors.empty() || std::ranges::any_of(run.results, applies)) return std::nullopt;
  return supported_instead(examined.host, profiles_in(examined.cases),
                           [](const std::string& profile, const std::string& port) {
                             return "attest run --profile " + profile + port;
                           });
}

int exit_code(const RunResult& run, const Examined& examined) {
  if (!run.errors.empty()) return exit_usage;
  const Conclusion conclusion = conclusion_of(run);
  if (conclusion == Conclusion::pass) return exit_ok;
  if (conclusion == Conclusion::fail) return exit_failed;
  if (conclusion == Conclusion::stopped) return exit_usage;
  if (run.count(Verdict::xfail) > 0) {
    return report_error(
        {"no vector passed: every selected vector was an expected failure, skipped or "
         "unsupported"});
  }
  return report_error({"no vector was compared: every selected vector was skipped or unsupported" +
                       (examined.suggestion ? examined.suggestion() : "")});
}

// The environment variable GITHUB_STEP_SUMMARY names the file to which a job appends its summary.
void write_for_github(const RunResult& run, double wall_s,
                      const std::optional<Diagnosis>& diagnosis) {
  fmt::print("{}", github_annotations(run));
  const char* const summary = std::getenv("GITHUB_STEP_SUMMARY");
  if (summary == nullptr || *summary == '\0') return;
  // A port may have replaced the file by a pipe without a reader, or by a link.
  constexpr int flags = O_WRONLY | O_APPEND | O_CREAT | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC;
  const int file = ::open(summary, flags, 0644);
  const std::string text = github_summary(run, wall_s, diagnosis);
  const bool is_written =
      file >= 0 && ::write(file, text.data(), text.size()) == static_cast<ssize_t>(text.size());
  if (file >= 0) ::close(file);
  if (!is_written) fmt::print(stderr, "attest: note: {} cannot be written\n", summary);
}

}  // namespace

Result<std::vector<ReportFile>> open_reports(const ReportOptions& options) {
  std::vector<ReportFile> reports;
  for (const ReportFormat& format : report_formats()) {
    const std::string& path = options.files.at(format.option);
    if (path.empty()) continue;
    auto file = AtomicFile::open(path);
    if (!file) return tl::unexpected(file.error());
    reports.push_back({*std::move(file), format});
  }
  return reports;
}

int conclude(const RunResult& run, const Examined& examined, const ReportOptions& options,
             std::vector<ReportFile> reports, std::chrono::steady_clock::time_point begin,
             const Globals& globals) {
  std::optional<Diagnosis> diagnosis;
  if (!run.suite_reference.empty()) {
    fmt::print(stderr, "attest: note: {}\n", own_law_only);
  } else if (options.diagnose && run.failed()) {
    diagnosis = diagnosed(run, examined);
  }
  if (interrupted()) forget_interrupt();  // the diagnosis has said so
  if (examined.save_traces) examined.save_traces(diagnosis ? diagnosis->specific_case : "");
  if (interrupted()) {
    forget_interrupt();
    fmt::print(stderr, "attest: note: interrupted; the page lacks plots\n");
  }
  // Before the summary is printed: if the reader of stdout closes the pipe early, SIGPIPE ends this
  // process.
  const auto written = write_reports(reports, {run, diagnosis, examined.traces});
  const auto unsupported = other_profiles(run, examined);
  const int code = unsupported ? report_error(*unsupported) : exit_code(run, examined);
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - begin;
  if (!globals.quiet || code != exit_ok) {
    const std::string summary =
        unsupported
            ? fmt::format("{} {}\n", capitals(name_of(conclusion_of(run))), conclusion_text(run))
            : render_summary(run, wall.count(), terminal_style(stdout), diagnosis, options.verbose);
    fmt::print("{}", options.github ? without_commands(summary) : summary);
  }
  if (options.github) write_for_github(run, wall.count(), diagnosis);
  if (!written) return report_error(written.error());
  return code;
}

}  // namespace attest::cli
