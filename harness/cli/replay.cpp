#include <algorithm>
#include <charconv>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "controller/reference/parameters.hpp"
#include "harness/cli/command.hpp"
#include "harness/core/nearest.hpp"
#include "harness/core/version.hpp"
#include "harness/report/failure_text.hpp"
#include "harness/report/text.hpp"
#include "harness/run/mixer_replay.hpp"
#include "harness/suite/worker.hpp"
#include "harness/trace/mixer_csv.hpp"
#include "harness/trace/provenance.hpp"

namespace attest::cli {
namespace {

constexpr const char* default_profile = "px4-v1.5.5";

// "NAME=VALUE" becomes a change at tick 0 that replaces whatever the trace says of NAME.
Result<void> override_parameter(Trace& trace, const std::string& text) {
  const auto equals = std::min(text.find('='), text.size());
  const std::string name = text.substr(0, equals);
  const char* const end = text.data() + text.size();
  float value = 0;
  const auto [rest, error] = std::from_chars(std::min(text.data() + equals + 1, end), end, value);
  if (equals == text.size() || error != std::errc{} || rest != end) {
    return fail(fmt::format("--param {}: write NAME=VALUE, such as MC_ROLL_P=6.5", text));
  }
  if (!reference::find_parameter(name)) {
    std::vector<std::string> names;
    for (const auto& info : reference::parameter_table()) names.emplace_back(info.name);
    return fail(fmt::format("--param {}: unknown parameter{}", text, suggestion(name, names)));
  }
  std::erase_if(trace.parameters, [&](const ParameterChange& c) { return c.name == name; });
  trace.parameters.insert(trace.parameters.begin(), ParameterChange{0, name, value});
  return {};
}

// The one given, else the one that the trace's provenance names, else the default.
std::string profile_of(const std::string& file, const ReplayOptions& options) {
  if (!options.profile.empty()) return options.profile;
  const auto path = std::filesystem::path(file).parent_path() / provenance_name;
  const auto provenance = read_provenance(path);
  return provenance && !provenance->profile.empty() ? provenance->profile : default_profile;
}

Result<std::unique_ptr<Batch>> trace_batch(const std::string& file, const ReplayOptions& options,
                                           Level level) {
  auto trace = read_csv(file, CsvNeed::inputs_and_outputs);
  if (!trace) return tl::unexpected(trace.error());
  for (const std::string& parameter : options.parameters) {
    if (auto set = override_parameter(*trace, parameter); !set) return tl::unexpected(set.error());
  }
  return std::make_unique<TraceBatch>(std::move(*trace), profile_of(file, options),
                                      Tolerances(level));
}

// One line a trace, more for one that differs.
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
  Replay(const ReplayOptions& options, const Globals& globals, Level level)
      : options_(options), globals_(globals), level_(level) {}

  int run() {
    for (const std::string& file : options_.files) {
      auto done = looks_like_mixer_csv(file) ? mixer(file) : trace(file);
      if (!done) return report_error(done.error());
    }
    if (!globals_.quiet || passed_ != options_.files.size()) {
      fmt::print("{} {} of {} traces conform ({}, {})\n",
                 passed_ == options_.files.size() ? "PASS" : "FAIL", passed_, options_.files.size(),
                 options_.port, name_of(level_));
    }
    return passed_ == options_.files.size() ? exit_ok : exit_failed;
  }

 private:
  Result<void> trace(const std::string& file) {
    auto batch = trace_batch(file, options_, level_);
    if (!batch) return tl::unexpected(batch.error());
    Batches batches;
    batches.push_back(std::move(*batch));
    WorkerOptions worker;
    worker.port = options_.port;
    worker.timeout_s = options_.timeout_s;
    const WorkerOutcome outcome = run_batches(batches, worker);
    if (!outcome.errors.empty()) return tl::unexpected(outcome.errors.front());
    const CaseResult& result = outcome.results.front();
    note(result.verdict == Verdict::pass, [&] { print_result(result, level_); });
    return {};
  }

  // The mixer is no part of the unit ABI: only the reference's can be replayed.
  Result<void> mixer(const std::string& file) {
    if (options_.port != "builtin") {
      return fail_at(file, "is a mixer trace; only the built-in mixer can be replayed");
    }
    auto recorded = read_mixer_csv(file);
    if (!recorded) return tl::unexpected(recorded.error());
    const auto definition = options_.mixer.empty() ? mixer_of(file) : std::optional(options_.mixer);
    if (!definition) {
      return fail_at(file, "which mixer made it? pass --mixer \"R: 4x 10000 10000 10000 0\"");
    }
    const auto replay = replay_mixer(*recorded, *definition);
    if (!replay) return tl::unexpected(replay.error());
    note(replay->deviating == 0, [&] {
      fmt::print("{:<12}{}  {}  {} samples, exact\n", replay->deviating ? "fail" : "pass", file,
                 *definition, replay->samples);
      if (replay->deviating) {
        fmt::print("  {} samples differ; first: {}\n", replay->deviating, replay->first);
      }
    });
    return {};
  }

  template <typename Print>
  void note(bool passed, Print print) {
    passed_ += passed ? 1 : 0;
    if (!passed || !globals_.quiet) print();
  }

  const ReplayOptions& options_;
  const Globals& globals_;
  Level level_;
  std::size_t passed_ = 0;
};

}  // namespace

int replay_command(const ReplayOptions& options, const Globals& globals) {
  const auto level = parse_level(options.level);
  if (!level) return report_error(level.error());
  const auto port = describe_port(options.port, {}, options.timeout_s);
  if (!port) return report_error(port.error());
  return Replay(options, globals, *level).run();
}

}  // namespace attest::cli
