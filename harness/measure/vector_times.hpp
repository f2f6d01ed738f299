// Measures what a port's steps cost in all vectors, and writes the input of the slowest step.
//
// The cost of a step is its time by the host's clock. If the port is a program that counts the cost
// of its steps (PROTOCOL.md), it is this count.
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

// A time of the host's clock; or a count of the port, in the unit of TimeOptions::counter: 2011
// cycles are Cost(2011). So both have one kind of histogram and one order.
using Cost = Nanoseconds;

struct TimeOptions {
  // Of each vector. The shortest time of each step counts, because a disturbance of the host only
  // adds to it. Of a port's own counts the largest counts. Empty: 5 times, or a single one for a
  // port's own counts.
  std::optional<int> repeats;
  std::optional<double> budget_us;  // steps longer than this are counted
  bool stack = true;                // measure the stack of the steps, in another run of each vector
  std::filesystem::path worst;  // where to write the vector of the slowest step; empty: not written
  // How the port counts: Declarations::cost, with another clock if the user gave one. Empty: the
  // host's clock measures.
  std::optional<CostCounter> counter = {};

  int runs() const { return repeats.value_or(counter ? 1 : 5); }
};

// The duration of Cost(1) [ns]. Empty for instructions.
std::optional<double> cost_ns(const std::optional<CostCounter>& counter);

struct VectorTimes {
  VectorResult result;                     // pass, or why there are no times
  std::vector<Cost> steps;                 // the cost of each step
  std::optional<std::size_t> stack_bytes;  // the most stack that a step used, or the port reported
  Module module = Module::mc_att_control;  // whose steps were timed
  std::size_t varying = 0;                 // steps whose counts differ from those of earlier runs

  bool is_timed() const { return !steps.empty(); }
  // REQUIRES: is_timed().
  std::size_t slowest_tick() const;
  Cost slowest() const { return steps[slowest_tick()]; }
  Cost median() const;
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
