// Runs batches in worker processes, so that a port that crashes, hangs, exits or corrupts its
// memory costs one verdict and nothing else.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "harness/suite/batch.hpp"
#include "harness/suite/held_port.hpp"
#include "harness/suite/verdict.hpp"

namespace attest {

// For one case at one rate, and for all other answers of a port [s]; they take milliseconds.
inline constexpr double default_timeout_s = 10;

struct WorkerOptions {
  std::string port = "builtin";  // as for open_port
  // What the port said of itself, which it is held to; empty: it is asked each time.
  std::optional<PortSays> said = std::nullopt;
  int jobs = 1;  // worker processes at a time
  double timeout_s = default_timeout_s;
  bool fail_fast = false;   // nothing after the first batch, in their order, that `fails`
  bool in_process = false;  // for a debugger: no children, no protection, one after the other
  std::function<void(const CaseResult&)> on_result = [](const CaseResult&) {};
  std::function<bool(const CaseResult&)> fails = [](const CaseResult& result) {
    return fails_a_run(result.verdict);
  };
  std::function<bool()> stop = [] { return false; };  // true: end soon, results do not matter
};

struct WorkerOutcome {
  std::vector<CaseResult> results;  // in the order of batches and tasks, whatever finished first
  std::vector<Error> errors;        // in the same order
  bool stopped_early = false;
};

using Batches = std::vector<std::unique_ptr<Batch>>;

// The results are the same for any number of jobs.
WorkerOutcome run_batches(const Batches& batches, const WorkerOptions& options);

// What a port says of itself, asked in a child process.
struct PortDescription : PortSays {
  std::string hangs;  // why it says nothing: it gave no answer in time; empty: it answered
};
// A port that hangs is described as such, so that its cases can have their verdicts. Errors: it
// cannot be loaded, or its process ends.
Result<PortDescription> describe_port(
    const std::string& port, const std::vector<std::string>& profiles, double timeout_s,
    const std::function<bool()>& stop = [] { return false; });

// Which of the profiles the port makes a unit of, each asked in a process of its own: one that
// makes a single unit is told from one that does not support the second profile. A port that
// crashes or hangs here supports none of those that were not asked yet; its cases have their
// verdicts.
std::vector<std::string> supported_profiles(const std::string& port,
                                            const std::vector<std::string>& profiles,
                                            double timeout_s, const std::function<bool()>& stop);

}  // namespace attest
