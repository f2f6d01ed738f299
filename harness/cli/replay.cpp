#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "harness/cli/outputs.hpp"
#include "harness/cli/read_log.hpp"
#include "harness/cli/replay_inputs.hpp"
#include "harness/cli/shared_arguments.hpp"
#include "harness/core/file.hpp"
#include "harness/core/version.hpp"
#include "harness/host/file_format.hpp"
#include "harness/report/failure_text.hpp"
#include "harness/report/replay_document.hpp"
#include "harness/report/text.hpp"
#include "harness/trace/provenance.hpp"
#include "harness/verify/evaluate.hpp"
#include "harness/verify/evaluate_log.hpp"

namespace attest::cli {
namespace {

Result<void> check_reports(const ReplayOptions& options, const Globals& globals) {
  if (options.html.empty() && options.json.empty()) return {};
  if (!options.html.empty() && options.files.size() > 1) {
    return fail("--html shows one trace or log; name one");
  }
  Inputs inputs{options.host.port, options.files};
  for (const std::string& file : options.files) {
    const auto folder = std::filesystem::path(file).parent_path();
    inputs.files.push_back((folder / provenance_name).string());
  }
  return check_outputs({options.html, options.json}, inputs, globals.suite);
}

// One line per trace or unit, and a second one with the reason if it does not pass. `judged_by`:
// "ticks, numeric" or "single steps, log".
void print_result(const VectorResult& result, const std::string& title, std::string_view judged_by,
                  std::FILE* out) {
  fmt::print(out, "{:<12}{}  {}", name_of(result.verdict), title, result.profile);
  if (result.ticks > 0) fmt::print(out, "  {} {}", result.ticks, judged_by);
  if (result.verdict == Verdict::pass && result.tightest) {
    fmt::print(out, ", tightest headroom {:.3g}x on {}", result.tightest->ratio,
               channels()[result.tightest->channel].name);
  }
  fmt::print(out, "\n");
  if (result.verdict == Verdict::pass) return;
  if (!result.reason.empty()) fmt::print(out, "  {}\n", one_line(result.reason));
}

bool is_replayed(const FileFormat& format) { return format.open || format.read_log; }

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
    for (const std::string& file : options_.files) {
      auto done = replay(file);
      if (!done) return report_error(done.error());
    }
    host_.reset();
    if (auto same = check_port(options_.host); !same) return report_error(same.error());
    const auto page = page_.empty() ? Result<void>() : html->commit(page_);
    if (!page) return report_error(page.error());
    const auto written = json->commit(
        replay_json(options_.host.port, name_of(level_), options_.log_limits, entries_));
    if (!written) return report_error(written.error());
    conclude();
    if (failed_ > 0) return exit_failed;
    if (passed_ > 0) return exit_ok;
    return report_error({"no trace was compared: every trace was skipped or unsupported"});
  }

 private:
  Result<void> replay(const std::string& file) {
    if (auto started = start(); !started) return started;
    const std::filesystem::path path = file;  // gcc 14 warns of a reference from a temporary
    const FileFormat& format = format_of(path);
    if (!is_replayed(format)) return wrong_format(file, format, is_replayed);
    return format.read_log != nullptr ? replay_log(file) : replay_trace(file);
  }

  // Starts the port's process unless one runs. It is called before a file is read, because the
  // port's process is a copy of this process, and must not contain the recorded outputs. So if the
  // port crashes or hangs on one unit of a log, its other unit is not run.
  Result<void> start() {
    if (timed_out_) host_.reset();
    timed_out_ = false;
    return ensure_host(host_, options_.host);
  }

  Result<void> replay_trace(const std::string& file) {
    auto recorded = recorded_in(file, options_);
    if (!recorded) return tl::unexpected(recorded.error());
    return judge_trace(*recorded, recorded->subject());
  }

  // A page shows the whole trace. Without one, the trace need not be in memory as a whole.
  Result<VectorResult> evaluated(TraceParts& trace, const ModuleUnderTest& subject) {
    const Tolerances tolerances(level_);
    if (options_.html.empty()) return evaluate_parts(trace, subject, *host_, tolerances);
    Trace whole, got;
    const auto read = trace.next_part(whole_trace, whole);
    if (!read) return tl::unexpected(read.error());
    VectorResult result = evaluate_trace(whole, subject, *host_, tolerances, &got);
    keep_page({result.verdict},
              [&] { return trace_document(whole, got, result, options_.host.port); });
    return result;
  }

  Result<void> judge_trace(TraceParts& trace, const ModuleUnderTest& subject) {
    const auto evaluation = evaluated(trace, subject);
    if (!evaluation) return tl::unexpected(evaluation.error());
    const VectorResult& result = *evaluation;
    count(result);
    entries_.push_back(json_of_trace(result, subject.module));
    const ChannelSet not_compared = channels_of(subject.module, "out/") & ~trace.present();
    if (result.verdict == Verdict::pass && globals_.quiet && not_compared.none()) return {};
    print_result(result, result.name, fmt::format("ticks, {}", name_of(level_)), out_);
    if (not_compared.any()) {
      fmt::print(out_, "  not compared, because the trace does not have them: {}\n",
                 fmt::join(names_of(not_compared), ", "));
    }
    if (result.verdict != Verdict::pass) fmt::print(out_, "{}", finding_text(result, level_));
    return {};
  }

  Result<void> replay_log(const std::string& file) {
    const auto log = log_in(file, options_);
    if (!log) return tl::unexpected(log.error());
    const LoggedUnit& first = log->units.front();
    // A log that attest wrote has the outputs of all steps, so it is judged like a trace.
    if (log->is_of_attest && first.has_every_step) {
      Trace parameters;
      parameters.parameters = first.trace.parameters;
      for (const ParameterChange& change : parameters_of(options_, *log, first)) {
        override_parameter(change, parameters);
      }
      const auto ticks = ticks_of(first);
      ticks->set_parameters(std::move(parameters.parameters));
      return judge_trace(*ticks, {log->profile, first.module});
    }
    are_logs_ = true;
    std::vector<LogResult> results;
    for (const LoggedUnit& unit : log->units) {
      if (auto judged = judge_unit(*log, unit, results); !judged) return judged;
    }
    std::vector<Verdict> verdicts;
    for (const LogResult& found : results) verdicts.push_back(found.result.verdict);
    keep_page(verdicts,
              [&] { return log_document(*log, results, options_.log_limits, options_.host.port); });
    return {};
  }

  Result<void> judge_unit(const FlightLog& log, const LoggedUnit& unit,
                          std::vector<LogResult>& results) {
    auto evaluated = evaluate_log(unit, log.profile, *host_, options_.log_limits,
                                  parameters_of(options_, log, unit));
    if (!evaluated) return tl::unexpected(evaluated.error());
    const LogResult& found = results.emplace_back(*std::move(evaluated));
    count(found.result);
    entries_.push_back(json_of_unit(log, unit, found, options_.log_limits));
    if (found.result.verdict == Verdict::pass && globals_.quiet) return {};
    print_result(found.result, title_of(unit),
                 found.single_steps ? "single steps, log" : "ticks, log", out_);
    fmt::print(out_, "{}", render_text(unit_table(unit, found, options_.log_limits), {}));
    return {};
  }

  // Makes the page only if it is wanted and has a result. Otherwise an old page is kept.
  template <typename MakeDocument>
  void keep_page(const std::vector<Verdict>& verdicts, MakeDocument make_document) {
    const bool any_result = std::any_of(verdicts.begin(), verdicts.end(), is_judged);
    if (!options_.html.empty() && any_result) page_ = html_page(make_document());
  }

  void count(const VectorResult& result) {
    timed_out_ = timed_out_ || result.verdict == Verdict::timeout;
    passed_ += result.verdict == Verdict::pass ? 1 : 0;
    failed_ += fails_a_run(result.verdict) ? 1 : 0;
  }

  // A log of v1.14 to v1.18 counts once for each of its units.
  void conclude() const {
    if (globals_.quiet && failed_ == 0) return;
    const std::size_t apart = entries_.size() - passed_ - failed_;
    const char* const what = !are_logs_                                ? "traces conform"
                             : entries_.size() > options_.files.size() ? "traces and units agree"
                                                                       : "traces and logs agree";
    if (are_logs_ && passed_ > 0) {
      fmt::print(out_, "Which mistakes would this show? attest faults --log {}\n",
                 options_.files.size() == 1 ? options_.files.front() : "FLIGHT.ulg");
    }
    const Verdict verdict = failed_ > 0   ? Verdict::fail
                            : passed_ > 0 ? Verdict::pass
                                          : Verdict::skip;
    fmt::print(out_, "{} {} of {} {}{} ({}, {}{})\n", outcome_of(verdict), passed_, entries_.size(),
               what, apart > 0 ? fmt::format(", {} not compared", apart) : "", options_.host.port,
               name_of(level_), arithmetic_);
  }

  const ReplayOptions& options_;
  const Globals& globals_;
  Level level_;
  std::string arithmetic_;  // of the port, if it is not floating point
  std::FILE* out_;
  std::unique_ptr<PortHost> host_;
  bool timed_out_ = false;  // the port in host_
  std::size_t passed_ = 0;
  std::size_t failed_ = 0;
  bool are_logs_ = false;  // a file was a flight log, which cannot prove conformance
  std::vector<nlohmann::ordered_json> entries_;
  std::string page_;
};

int replay_command(const ReplayOptions& options, const Globals& globals) {
  // The outputs in these files are what the port must compute.
  auto& hidden = globals.barrier->hidden;
  hidden.insert(hidden.end(), options.files.begin(), options.files.end());
  const auto level = parse_level(options.level);
  if (!level) return report_error(level.error());
  if (auto checked = check_reports(options, globals); !checked)
    return report_error(checked.error());
  ReplayOptions held = options;
  const auto port = prepare_port(held.host);
  if (!port) return report_error(port.error());
  std::string arithmetic;
  if (port->fraction_bits && *level == Level::numeric) {
    arithmetic = fmt::format(" for fixed point with {} fraction bits", *port->fraction_bits);
  }
  return Replay(held, globals, *level, std::move(arithmetic)).run();
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
              "Version of the law; default for a trace: that of its provenance.toml, else "
              "the newest with its unit; default for a log: the release of PX4 that wrote it")
      .type("PROFILE");
  command
      .option("--param", options.parameters, "Set a parameter of the port from the first step on")
      .type("NAME=VALUE")
      .one_each_time();
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
  command.option("files", options->files, "Traces (CSV) or flight logs (.ulg)")
      .type("FILE")
      .required();
  add_port(command, options->host);
  add_law_options(command, *options);
  add_log_options(command, *options);
  add_page(command, options->html, "a page with plots of the outputs; needs a single trace or log");
  command.option("--json", options->json, "Write the result of each trace and unit as JSON")
      .type("F.json")
      .group(option_group::reports);
  add_timeout(command, options->host.timeout_s);
  command.examples(
      {{"attest replay TRACE.csv --port lib:./libmine.so", "compare a port with a recorded trace"},
       {"attest replay TRACE.csv --param MC_ROLL_P=7",
        "compare the reference with another value of a parameter"},
       {"attest replay FLIGHT.ulg --port lib:./libmine.so",
        "compare a port with the log of a flight"}});
  command.runs(options, replay_command);
}

}  // namespace attest::cli
