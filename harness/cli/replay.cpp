#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "harness/cli/command.hpp"
#include "harness/core/version.hpp"
#include "harness/golden/recorded.hpp"
#include "harness/report/failure_text.hpp"
#include "harness/report/text.hpp"
#include "harness/verify/evaluate.hpp"

namespace attest::cli {
namespace {

Result<Recorded> recorded_in(const std::string& file, const ReplayOptions& options) {
  auto recorded = read_recorded(file, options.profile, options.mixer);
  if (!recorded) return recorded;
  for (const std::string& parameter : options.parameters) {
    const auto change = parse_parameter(parameter);
    if (!change) return tl::unexpected(change.error());
    if (auto checked = check_parameter(recorded->subject, *change); !checked) {
      return fail(fmt::format("--param {}: {}", parameter, checked.error().message));
    }
    override_parameter(*change, recorded->trace);
  }
  for (const std::string& note : recorded->notes) {
    fmt::print(stderr, "attest: note: {}: {}\n", file, note);
  }
  return recorded;
}

// One line per trace, more if it differs.
void print_result(const CaseResult& result, Level level) {
  fmt::print("{:<12}{}  {}", name_of(result.verdict), result.name, result.profile);
  if (result.ticks > 0) fmt::print("  {} ticks, {}", result.ticks, name_of(level));
  if (result.verdict == Verdict::pass && result.tightest) {
    fmt::print(", tightest headroom {:.3g}x on {}", result.tightest->ratio,
               channels()[result.tightest->channel].name);
  }
  fmt::print("\n");
  if (result.verdict == Verdict::pass) return;
  if (!result.reason.empty()) fmt::print("  {}\n", one_line(result.reason));
  fmt::print("{}", finding_text(result, level));
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
      fmt::print("{} {} of {} traces conform{} ({}, {}{})\n", failed_ == 0 ? "PASS" : "FAIL",
                 passed_, options_.files.size(),
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
    const auto recorded = recorded_in(file, options_);
    if (!recorded) return tl::unexpected(recorded.error());
    const CaseResult result =
        evaluate_trace(recorded->trace, recorded->subject, *host_, Tolerances(level_));
    if (result.verdict == Verdict::timeout) host_.reset();  // the next trace gets a new process
    const bool passed = result.verdict == Verdict::pass;
    passed_ += passed ? 1 : 0;
    failed_ += fails_a_run(result.verdict) ? 1 : 0;
    if (!passed || !globals_.quiet) print_result(result, level_);
    return {};
  }

  const ReplayOptions& options_;
  const Globals& globals_;
  Level level_;
  std::string arithmetic_;  // of the port, if it is not floating point
  std::unique_ptr<PortHost> host_;
  std::size_t passed_ = 0;
  std::size_t failed_ = 0;
};

}  // namespace

int replay_command(const ReplayOptions& options, const Globals& globals) {
  const auto level = parse_level(options.level);
  if (!level) return report_error(level.error());
  const auto port = describe_port(options.host);
  if (!port) return report_error(port.error());
  std::string arithmetic;
  if (port->fraction_bits && *level == Level::numeric) {
    arithmetic = fmt::format(" for fixed point with {} fraction bits", *port->fraction_bits);
  }
  return Replay(options, globals, *level, std::move(arithmetic)).run();
}

}  // namespace attest::cli
