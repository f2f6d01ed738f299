// How long a port's steps take, over the corpus, and which input takes longest.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <vector>

#include "harness/casefile/select.hpp"
#include "harness/host/port_process.hpp"
#include "harness/realtime/histogram.hpp"
#include "harness/verify/verdict.hpp"

namespace attest {

struct TimeOptions {
  int repeats = 5;                  // of each vector: of each step the quickest counts
  std::optional<double> budget_us;  // steps longer than this are counted
  bool stack = true;                // measure the stack of a step, in one more run of each vector
  std::filesystem::path worst;      // where to write the vector of the slowest step; empty: nowhere
};

// A case at a rate.
struct VectorTimes {
  CaseResult result;                       // a verdict other than pass: there are no times
  std::vector<Nanoseconds> steps;          // the quickest of each
  std::optional<std::size_t> stack_bytes;  // the most that a step used

  bool is_timed() const { return !steps.empty(); }
  // REQUIRES: is_timed().
  std::size_t slowest_tick() const;
  Nanoseconds slowest() const { return steps[slowest_tick()]; }
  Nanoseconds median() const;
};

struct CorpusTimes {
  std::vector<VectorTimes> vectors;
  Histogram steps;       // of all vectors; over its limit: over the budget
  Nanoseconds clock{0};  // what reading the clock takes, which was taken off

  // Null: nothing was timed.
  const VectorTimes* with_slowest_step() const;
  const VectorTimes* with_most_stack() const;  // also null where no stack was measured
};

// Every vector of the cases, one after the other in one process of the port, so that they do not
// disturb each other; in a new one after a crash. Ends early when `host.stop` says so. Errors: the
// port cannot be opened, no memory for its stack. REQUIRES: open-loop cases of the controller.
Result<CorpusTimes> time_corpus(const std::vector<SelectedCase>& cases, const TimeOptions& options,
                                const HostOptions& host,
                                const std::function<void(const CaseResult&)>& on_result);

// Writes the vector of the slowest step up to that step, with what the port answers: for `attest
// replay`. Errors: nothing was timed, the port goes wrong now, the file cannot be written.
Result<void> write_slowest(const CorpusTimes& times, const std::vector<SelectedCase>& cases,
                           const HostOptions& host, const std::filesystem::path& file);

}  // namespace attest
