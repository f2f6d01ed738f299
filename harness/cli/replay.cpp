#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "harness/cli/outputs.hpp"
#include "harness/cli/read_log.hpp"
#include "harness/cli/replayed_file.hpp"
#include "harness/cli/shared_arguments.hpp"
#include "harness/cli/supported_profiles.hpp"
#include "harness/core/file.hpp"
#include "harness/core/interrupt.hpp"
#include "harness/core/json_text.hpp"
#include "harness/port/port.hpp"
#include "harness/port/profiles.hpp"
#include "harness/report/fleet_document.hpp"
#include "harness/report/progress.hpp"
#include "harness/report/replay_document.hpp"
#include "harness/report/text.hpp"
#include "harness/trace/provenance.hpp"

namespace attest::cli {
namespace {

Result<void> check_reports(const ReplayOptions& options, const Globals& globals) {
  if (options.html.empty() && options.json.empty()) return {};
  Inputs inputs{options.host.port, options.files};
  for (const std::string& file : options.files) {
    const auto folder = std::filesystem::path(file).parent_path();
    inputs.files.push_back((folder / provenance_name).string());
  }
  return check_outputs({options.html, options.json}, inputs, globals.suite);
}

// Replays the files, and reports them in their order.
class Replay {
 public:
  Replay(const ReplayOptions& options, const Globals& globals, Level level, std::string arithmetic)
      : options_(options),
        globals_(globals),
        level_(level),
        arithmetic_(std::move(arithmetic)),
        out_(options.json == "-" || options.html == "-" ? stderr : stdout) {}

  int run() {
    auto json = AtomicFile::open(options_.json);
    if (!json) return report_error(json.error());
    auto html = AtomicFile::open(options_.html);
    if (!html) return report_error(html.error());
    if (auto replayed = replay_all(); !replayed) return report_error(replayed.error());
    if (interrupted()) return exit_interrupted;
    if (auto same = check_port(options_.host); !same) return report_error(same.error());
    if (auto written = write_reports(*std::move(json), *std::move(html)); !written) {
      return report_error(written.error());
    }
    if (!entries_.empty()) conclude();
    int status = exit_ok;
    for (const Error& error : errors_) status = report_error(error);
    if (status != exit_ok) return status;
    if (failed_ > 0) return exit_failed;
    if (passed_ > 0) return exit_ok;
    return report_error(nothing_compared());
  }

 private:
  // Without a result, the reports of an earlier command are kept.
  Result<void> write_reports(AtomicFile json, AtomicFile html) {
    if (entries_.empty()) return {};
    if (options_.files.size() > 1) page_ = html_page(fleet_document(options_.host.port, logs_));
    if (!page_.empty()) {
      if (auto written = html.commit(page_); !written) return written;
    }
    return json.commit(
        replay_json(options_.host.port, name_of(level_), options_.log_limits, entries_));
  }

  Result<void> replay_all() {
    Jobs<ReplayedFile> jobs;
    for (std::size_t i = 0; i < options_.files.size(); ++i) {
      jobs.push_back(std::make_unique<ReplayJob>(options_, i, level_, globals_.quiet));
    }
    std::map<std::size_t, ReplayedFile> done;  // not yet reported
    std::size_t next = 0;
    Progress progress(jobs.size(), Progress::on_stderr(globals_.quiet || jobs.size() == 1));
    JobOptions<ReplayedFile> workers;
    workers.processes = options_.jobs;
    workers.in_process = jobs.size() == 1;  // a worker has another standard input
    workers.stop = interrupted;
    workers.on_result = [&](const ReplayedFile& file) {
      progress.finish();
      done.emplace(file.index, file);
      for (; !done.empty() && done.begin()->first == next; ++next) {
        report(done.begin()->second);
        done.erase(done.begin());
      }
      const bool fails = std::any_of(file.verdicts.begin(), file.verdicts.end(), fails_a_run);
      progress.add(fails, options_.files[file.index]);
    };
    const JobResults<ReplayedFile> outcome = run_jobs(jobs, workers);
    progress.finish();
    if (!outcome.errors.empty()) return tl::unexpected(outcome.errors.front());
    return {};
  }

  void report(const ReplayedFile& file) {
    print_notes(options_.files[file.index], file.notes);
    fmt::print(out_, "{}", file.text);
    if (file.error) errors_.push_back(*file.error);
    are_logs_ = are_logs_ || file.is_log;
    page_ = file.page;
    for (const Verdict verdict : file.verdicts) {
      passed_ += verdict == Verdict::pass ? 1 : 0;
      failed_ += fails_a_run(verdict) ? 1 : 0;
    }
    FleetLog log{options_.files[file.index], file.verdicts, {}, file.text};
    for (const std::string& entry : file.entries) log.entries.push_back(ordered_json_from(entry));
    entries_.insert(entries_.end(), log.entries.begin(), log.entries.end());
    logs_.push_back(std::move(log));
  }

  Error nothing_compared() const {
    // A law of one's own may have another name, but no port here has it.
    if (!options_.profile.empty()) {
      if (auto known = check_profiles({options_.profile}); !known) return known.error();
    }
    std::set<std::string> profiles;
    for (const auto& entry : entries_) {
      if (const auto profile = entry.at("profile").get<std::string>(); find_profile(profile)) {
        profiles.insert(profile);
      }
    }
    const auto with_trace = [](const std::string& profile, const std::string& port) {
      return fmt::format("attest replay TRACE_OF_{}.csv{}", profile, port);
    };
    return supported_instead(options_.host, {profiles.begin(), profiles.end()}, with_trace)
        .value_or(Error{"no trace was compared: every trace was skipped or unsupported"});
  }

  // A log of v1.14 to v1.18 counts once for each of its units.
  void conclude() const {
    if (globals_.quiet && failed_ == 0) return;
    const std::size_t apart = entries_.size() - passed_ - failed_;
    const char* const what = !are_logs_                                ? "traces conform"
                             : entries_.size() > options_.files.size() ? "traces and units agree"
                                                                       : "traces and logs agree";
    if (are_logs_ && passed_ > 0) {
      fmt::print(
          out_, "{}\n",
          meaning_of_pass(options_.files.size() == 1 ? options_.files.front() : "FLIGHT.ulg"));
    }
    const Conclusion conclusion = failed_ > 0   ? Conclusion::fail
                                  : passed_ > 0 ? Conclusion::pass
                                                : Conclusion::none;
    const std::string not_judged = not_judged_text(entries_);
    fmt::print(out_, "{} {} of {} {}{} ({}, {}{}){}{}\n", capitals(name_of(conclusion)), passed_,
               entries_.size(), what, apart > 0 ? fmt::format(", {} not compared", apart) : "",
               options_.host.port, name_of(level_), arithmetic_, not_judged.empty() ? "" : "; ",
               not_judged);
  }

  const ReplayOptions& options_;
  const Globals& globals_;
  Level level_;
  std::string arithmetic_;  // of the port, if it is not floating point
  std::FILE* out_;
  std::size_t passed_ = 0;
  std::size_t failed_ = 0;
  bool are_logs_ = false;  // a file was a flight log, which cannot prove conformance
  std::vector<nlohmann::ordered_json> entries_;
  std::vector<FleetLog> logs_;
  std::vector<Error> errors_;
  std::string page_;
};

// Not a file of data that is executable, as all files of some file systems are.
bool is_port_here(const std::string& word) {
  if (!port_of_file(word).starts_with("proc:") || !kind_of(word).prefix.empty()) {
    return is_port(word);
  }
  std::string begin(2, '\0');
  std::ifstream(word).read(begin.data(), 2);
  return begin == "#!" || begin ==
                              "\x7f"
                              "E";
}

// Other commands take a port without --port, so it may stand among the files here, too.
Result<ReplayOptions> with_port_of_files(ReplayOptions options) {
  const auto port = std::ranges::find_if(options.files, is_port_here);
  if (port == options.files.end()) return options;
  if (options.host.port != HostOptions().port || options.files.size() == 1) {
    return fail(fmt::format("{} is a port, not a trace or log; give one port, and a file", *port));
  }
  options.host.port = port_of_file(*port);
  options.files.erase(port);
  return with_port_of_files(std::move(options));
}

int replay_command(const ReplayOptions& given, const Globals& globals) {
  auto sorted = with_port_of_files(given);
  if (!sorted) return report_error(sorted.error());
  ReplayOptions& options = *sorted;
  // The outputs in these files are what the port must compute.
  auto& hidden = globals.barrier->hidden;
  hidden.insert(hidden.end(), options.files.begin(), options.files.end());
  const auto level = parse_level(options.level);
  if (!level) return report_error(level.error());
  if (auto checked = check_reports(options, globals); !checked)
    return report_error(checked.error());
  const auto port = prepare_port(options.host);
  if (!port) return report_error(port.error());
  std::string arithmetic;
  if (port->fraction_bits && *level == Level::numeric) {
    arithmetic = fmt::format(" for fixed point with {} fraction bits", *port->fraction_bits);
  }
  // With one file, this process does the work itself, and an interrupt may end it at once.
  if (options.files.size() > 1) note_interrupts();
  return Replay(options, globals, *level, std::move(arithmetic)).run();
}

void add_log_options(Command command, ReplayOptions& options) {
  add_assumed(command, options.assumed);
  command
      .option("--within", options.log_limits.within,
              "Largest difference from a logged value that counts as agreement, in the unit "
              "of the signal")
      .type("X")
      .shows_default()
      .at_least_zero()
      .group(option_group::logs);
  command
      .option("--at-least", options.log_limits.least_part_within,
              "Part of the compared samples of a log that must agree")
      .type("PART")
      .shows_default()
      .range(0.0, 1.0)
      .group(option_group::logs);
}

// Options that choose the law by which the port is judged.
void add_law_options(Command command, ReplayOptions& options) {
  command
      .option("--profile", options.profile,
              "Version of the law; default for a trace: that of its column profile/..., or else of "
              "its provenance.toml, or else the newest released one with its unit and parameters; "
              "default for a log: the release of PX4 that wrote it")
      .type("PROFILE")
      .rewritten(full_profile_name);
  add_parameters(command, options.parameters, "Set a parameter of the port from the first step on");
  command
      .option("--level", options.level, "How outputs are compared: `exact`, `numeric` or `events`")
      .type("LEVEL")
      .shows_default();
  command
      .option("--mixer", options.mixer,
              "Mixer definition of a mixer trace; default: that of its provenance.toml, else "
              "the geometry in the file name (4x.csv)")
      .type("TEXT");
}

}  // namespace

void add_replay(const CommandLine& line) {
  auto options = std::make_shared<ReplayOptions>();
  const Command command = line.add("replay",
                                   "Feed the inputs of recorded traces or flight logs to a "
                                   "port and compare its outputs with the recorded ones");
  command
      .option("files", options->files,
              "Traces (CSV) or flight logs (.ulg). A log shows more if the vehicle flew with bit 4 "
              "of SDLOG_PROFILE (high rate); docs/traces.md has a table")
      .type("FILE")
      .required();
  add_port(command, options->host);
  add_law_options(command, *options);
  add_log_options(command, *options);
  add_page(command, options->html,
           "a page with plots of the outputs; of several files, a table, the worst first");
  command.option("--json", options->json, "Write the result of each trace and unit as JSON")
      .type("F.json")
      .group(option_group::reports);
  add_timeout(command, options->host.timeout_s);
  add_jobs(command, options->jobs, "Number of files that are replayed at the same time");
  command.examples(
      {{"attest replay TRACE.csv --port lib:./libmine.so", "compare a port with a recorded trace"},
       {"attest replay TRACE.csv --param MC_ROLL_P=7",
        "compare the reference with another value of a parameter"},
       {"attest replay FLIGHT.ulg --port lib:./libmine.so",
        "compare a port with the log of a flight"},
       {"attest replay logs/*.ulg --html fleet.html",
        "judge many logs, and show the worst first"}});
  command.runs(options, replay_command);
}

}  // namespace attest::cli
