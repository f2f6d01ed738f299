// Replays one trace or log, for `attest replay`.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "harness/cli/replay_inputs.hpp"
#include "harness/compare/tolerance.hpp"
#include "harness/verify/port_job.hpp"
#include "harness/verify/verdict.hpp"

namespace attest::cli {

struct ReplayedFile {
  std::size_t index = 0;             // among the files of the command
  std::vector<std::string> notes;    // about the file
  std::string text;                  // for the terminal
  std::optional<Error> error;        // the file cannot be read
  std::vector<std::string> entries;  // of the JSON report: each trace, and each unit of a log
  std::vector<Verdict> verdicts;     // of the entries
  std::string page;                  // HTML; empty: not wanted, or there is nothing to show
  bool is_log = false;               // of a flight, which cannot prove conformance
};

}  // namespace attest::cli

namespace attest {

template <>
struct Codec<cli::ReplayedFile> {
  static std::string encode(const Result<cli::ReplayedFile>& result);
  static Result<cli::ReplayedFile> decode(const std::string& text);
};

}  // namespace attest

namespace attest::cli {

// The port starts before the file is read, because its process is a copy of another process, which
// must not contain the recorded outputs. So if a library crashes or hangs on one unit of a log, its
// other unit is not run.
class ReplayJob final : public PortJob<ReplayedFile> {
 public:
  // REQUIRES: `options` outlives this. `is_quiet`: no text about what passes.
  ReplayJob(const ReplayOptions& options, std::size_t index, Level level, bool is_quiet)
      : PortJob(options.host),
        replay_(options),
        index_(index),
        level_(level),
        is_quiet_(is_quiet) {}

  std::size_t size() const override { return 1; }
  Result<ReplayedFile> run(std::size_t task) override;

 private:
  const ReplayOptions& replay_;
  std::size_t index_;
  Level level_;
  bool is_quiet_;
};

}  // namespace attest::cli
