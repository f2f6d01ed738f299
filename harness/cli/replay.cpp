#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/cli/command.hpp"
#include "harness/cli/outputs.hpp"
#include "harness/cli/read_log.hpp"
#include "harness/core/file.hpp"
#include "harness/core/version.hpp"
#include "harness/golden/recorded.hpp"
#include "harness/report/failure_text.hpp"
#include "harness/report/html/signals_page.hpp"
#include "harness/report/log_text.hpp"
#include "harness/report/text.hpp"
#include "harness/trace/provenance.hpp"
#include "harness/verify/evaluate.hpp"
#include "harness/verify/evaluate_log.hpp"

namespace attest::cli {
namespace {

Result<void> set_parameters(const ReplayOptions& options, const Subject& subject, Trace& trace) {
  for (const std::string& parameter : options.parameters) {
    const auto change = parse_parameter(parameter);
    if (!change) return tl::unexpected(change.error());
    if (auto checked = check_parameter(subject, *change); !checked) {
      return fail(fmt::format("--param {}: {}", parameter, checked.error().message));
    }
    override_parameter(*change, trace);
  }
  return {};
}

Result<Recorded> recorded_in(const std::string& file, const ReplayOptions& options) {
  auto recorded = read_recorded(file, options.profile, options.mixer);
  if (!recorded) return recorded;
  if (auto set = set_parameters(options, recorded->subject, recorded->trace); !set) {
    return tl::unexpected(set.error());
  }
  print_notes(file, recorded->notes);
  return recorded;
}

// With the profile to replay it with.
Result<FlightLog> log_in(const std::string& file, const ReplayOptions& options) {
  if (!options.mixer.empty()) return fail_at(file, "is no mixer trace; leave --mixer out");
  auto log = read_log(file, options.assumed, options.profile);
  if (!log) return log;
  if (auto set = set_parameters(options, {log->profile}, log->trace); !set) {
    return tl::unexpected(set.error());
  }
  print_notes(file, log->notes);
  return log;
}

Result<void> check_page(const ReplayOptions& options, const Globals& globals) {
  if (options.html.empty()) return {};
  if (options.files.size() > 1) return fail("--html shows one trace or log; name one");
  Inputs inputs{options.host.port, options.files};
  for (const std::string& file : options.files) {
    const auto folder = std::filesystem::path(file).parent_path();
    inputs.files.push_back((folder / provenance_name).string());
  }
  return check_outputs({options.html}, inputs, globals.suite);
}

// One line per trace, more if it differs. `judged_by`: the level, or "log".
void print_result(const CaseResult& result, std::string_view judged_by) {
  fmt::print("{:<12}{}  {}", name_of(result.verdict), result.name, result.profile);
  if (result.ticks > 0) fmt::print("  {} ticks, {}", result.ticks, judged_by);
  if (result.verdict == Verdict::pass && result.tightest) {
    fmt::print(", tightest headroom {:.3g}x on {}", result.tightest->ratio,
               channels()[result.tightest->channel].name);
  }
  fmt::print("\n");
  if (result.verdict == Verdict::pass) return;
  if (!result.reason.empty()) fmt::print("  {}\n", one_line(result.reason));
}

class Replay {
 public:
  Replay(const ReplayOptions& options, const Globals& globals, Level level, std::string arithmetic)
      : options_(options), globals_(globals), level_(level), arithmetic_(std::move(arithmetic)) {}

  int run() {
    for (const std::string& file : options_.files) {
      auto done = replay(file);
      if (!done) return report_error(done.error());
    }
    const std::size_t apart = options_.files.size() - passed_ - failed_;
    if (!globals_.quiet || failed_ > 0) {
      fmt::print("{} {} of {} {}{} ({}, {}{})\n", failed_ == 0 ? "PASS" : "FAIL", passed_,
                 options_.files.size(), logs_ > 0 ? "traces and logs agree" : "traces conform",
                 apart > 0 ? fmt::format(", {} not compared", apart) : "", options_.host.port,
                 name_of(level_), arithmetic_);
    }
    if (failed_ > 0) return exit_failed;
    if (passed_ > 0) return exit_ok;
    return report_error({"no trace was compared: every trace was skipped or unsupported"});
  }

 private:
  Result<void> replay(const std::string& file) {
    // Before the recorded outputs are read: the port's process is a copy of this one.
    if (auto started = ensure_host(host_, options_.host); !started) return started;
    return is_log(file) ? replay_log(file) : replay_trace(file);
  }

  Result<void> replay_trace(const std::string& file) {
    const auto recorded = recorded_in(file, options_);
    if (!recorded) return tl::unexpected(recorded.error());
    return judge_trace(recorded->trace, recorded->subject);
  }

  Result<void> judge_trace(const Trace& trace, const Subject& subject) {
    Trace got;
    const CaseResult result = evaluate_trace(trace, subject, *host_, Tolerances(level_), &got);
    count(result);
    if (auto written =
            write_page([&] { return trace_page(trace, got, result, options_.host.port); });
        !written) {
      return written;
    }
    const Module module = module_of(trace.present);
    const ChannelSet not_compared = channels_of(module, "out/") & ~trace.present;
    if (result.verdict == Verdict::pass && globals_.quiet && not_compared.none()) return {};
    print_result(result, name_of(level_));
    if (not_compared.any()) {
      fmt::print("  not compared, because the trace does not have them: {}\n",
                 fmt::join(names_of(not_compared), ", "));
    }
    if (result.verdict != Verdict::pass) fmt::print("{}", finding_text(result, level_));
    return {};
  }

  Result<void> replay_log(const std::string& file) {
    const auto log = log_in(file, options_);
    if (!log) return tl::unexpected(log.error());
    // A log of attest has the outputs of all steps, so it is a trace.
    if (log->is_of_attest && log->has_every_step) return judge_trace(log->trace, {log->profile});
    ++logs_;
    const LogResult found = evaluate_log(*log, log->profile, *host_, options_.log_limits);
    count(found.result);
    const auto written =
        write_page([&] { return log_page(*log, found, options_.log_limits, options_.host.port); });
    if (!written) return written;
    if (found.result.verdict == Verdict::pass && globals_.quiet) return {};
    print_result(found.result, "log");
    fmt::print("{}", log_text(*log, found, options_.log_limits));
    return {};
  }

  // Makes the page only if it is wanted.
  template <typename MakePage>
  Result<void> write_page(MakePage make_page) const {
    if (options_.html.empty()) return {};
    return write_file(options_.html, make_page());
  }

  void count(const CaseResult& result) {
    if (result.verdict == Verdict::timeout) host_.reset();  // the next trace gets a new process
    passed_ += result.verdict == Verdict::pass ? 1 : 0;
    failed_ += fails_a_run(result.verdict) ? 1 : 0;
  }

  const ReplayOptions& options_;
  const Globals& globals_;
  Level level_;
  std::string arithmetic_;  // of the port, if it is not floating point
  std::unique_ptr<PortHost> host_;
  std::size_t passed_ = 0;
  std::size_t failed_ = 0;
  std::size_t logs_ = 0;  // judged by their statistics; they say nothing about conformance
};

}  // namespace

int replay_command(const ReplayOptions& options, const Globals& globals) {
  const auto level = parse_level(options.level);
  if (!level) return report_error(level.error());
  if (auto checked = check_page(options, globals); !checked) return report_error(checked.error());
  const auto port = describe_port(options.host);
  if (!port) return report_error(port.error());
  std::string arithmetic;
  if (port->fraction_bits && *level == Level::numeric) {
    arithmetic = fmt::format(" for fixed point with {} fraction bits", *port->fraction_bits);
  }
  return Replay(options, globals, *level, std::move(arithmetic)).run();
}

}  // namespace attest::cli
