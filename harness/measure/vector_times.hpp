// Measures how long a port's steps take in all vectors, and writes the input of the slowest step.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <vector>

#include "harness/casefile/select.hpp"
#include "harness/core/file.hpp"
#include "harness/core/histogram.hpp"
#include "harness/host/port_process.hpp"
#include "harness/verify/verdict.hpp"

namespace attest {

struct TimeOptions {
  int repeats = 5;                  // of each vector; the shortest time of each step counts
  std::optional<double> budget_us;  // steps longer than this are counted
  bool stack = true;                // measure the stack of the steps, in another run of each vector
  std::filesystem::path worst;  // where to write the vector of the slowest step; empty: not written
};

struct VectorTimes {
  VectorResult result;                     // pass, or why there are no times
  std::vector<Nanoseconds> steps;          // the shortest time of each step
  std::optional<std::size_t> stack_bytes;  // the most stack that a step used
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
  Nanoseconds clock{0};  // how long it takes to read the clock; already subtracted from the steps

  const VectorTimes* with_slowest_step() const;  // null if no vector was timed
  const VectorTimes* with_most_stack() const;    // null if no stack was measured

  std::map<Module, Histogram> by_module() const;
};

// Times every vector of the cases, one after the other so that they do not disturb each other. All
// vectors run in one process of the port; after a crash a new one is started. Ends early when
// `host.stop` returns true. Errors: the port cannot be opened, no memory for its stack. REQUIRES:
// open-loop cases of units.
Result<CorpusTimes> time_corpus(const std::vector<SelectedCase>& cases, const TimeOptions& options,
                                const HostOptions& host,
                                const std::function<void(const VectorResult&)>& on_result);

// Writes the vector of the slowest step up to that step, with the port's outputs, for `attest
// replay`. Runs the port again. Errors: no vector was timed, the port cannot be opened or has a
// fault, the file cannot be written.
Result<void> write_slowest(const CorpusTimes& times, const std::vector<SelectedCase>& cases,
                           const HostOptions& host, AtomicFile file);

}  // namespace attest
