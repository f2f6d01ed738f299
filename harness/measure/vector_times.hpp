// How long a port's steps take over all vectors, and the input of the slowest step.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <vector>

#include "harness/casefile/select.hpp"
#include "harness/host/port_process.hpp"
#include "harness/realtime/histogram.hpp"
#include "harness/verify/verdict.hpp"

namespace attest {

struct TimeOptions {
  int repeats = 5;                  // of each vector; the quickest time of each step counts
  std::optional<double> budget_us;  // steps longer than this are counted
  bool stack = true;                // measure the stack of a step, in one more run of each vector
  std::filesystem::path worst;  // where to write the vector of the slowest step; empty: not written
};

// A case at a rate.
struct VectorTimes {
  CaseResult result;                       // a verdict other than pass: there are no times
  std::vector<Nanoseconds> steps;          // the quickest time of each
  std::optional<std::size_t> stack_bytes;  // the most that a step used
  Module module = Module::mc_att_control;  // whose steps were timed

  bool is_timed() const { return !steps.empty(); }
  // REQUIRES: is_timed().
  std::size_t slowest_tick() const;
  Nanoseconds slowest() const { return steps[slowest_tick()]; }
  Nanoseconds median() const;
};

struct CorpusTimes {
  std::vector<VectorTimes> vectors;
  Histogram steps;       // of all vectors; its limit is the budget
  Nanoseconds clock{0};  // the time of reading the clock, already subtracted

  // Null: no vector was timed.
  const VectorTimes* with_slowest_step() const;
  const VectorTimes* with_most_stack() const;  // also null where no stack was measured

  // The steps of each module that was timed.
  std::map<Module, Histogram> by_module() const;
};

// Times every vector of the cases, one after the other so that they do not disturb each other. They
// share one process of the port; after a crash a new one is started. Ends early when `host.stop`
// returns true. Errors: the port cannot be opened, no memory for its stack. REQUIRES: open-loop
// cases of units.
Result<CorpusTimes> time_corpus(const std::vector<SelectedCase>& cases, const TimeOptions& options,
                                const HostOptions& host,
                                const std::function<void(const CaseResult&)>& on_result);

// Writes the vector of the slowest step up to that step, with the port's outputs, for `attest
// replay`. Errors: no vector was timed, the port fails now, the file cannot be written.
Result<void> write_slowest(const CorpusTimes& times, const std::vector<SelectedCase>& cases,
                           const HostOptions& host, const std::filesystem::path& file);

}  // namespace attest
