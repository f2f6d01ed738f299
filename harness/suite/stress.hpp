// A port that flies in real time: what was measured, beside what the machine does alone, and the
// verdict on it.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "harness/casefile/case.hpp"
#include "harness/plant/plant.hpp"
#include "harness/realtime/cyclictest.hpp"
#include "harness/realtime/live_flight.hpp"
#include "harness/realtime/slow_ticks.hpp"
#include "harness/suite/verdict.hpp"

namespace attest {

// A histogram in a line.
struct Spread {
  std::uint64_t count = 0;
  Nanoseconds min{0}, median{0}, p90{0}, p99{0}, p999{0}, max{0};
};
Spread spread_of(const Histogram& histogram);

struct StressResult {
  CaseResult
      result;   // verdict; ticks, first and tightest are of the outputs beside the reference's
  Spread idle;  // wake-ups of a thread with nothing to do: the machine's own floor
  Spread lateness, execution, age, plant;  // as of LiveUnitRecord; wake-ups of the plant
  std::uint64_t deadlines = 0, ticks = 0, overruns = 0, missed = 0;
  // The port's own, not the machine's: missed after a step that itself took half a period or more,
  // and steps longer than RealtimeBudget::execution_us. A step's own time is that on the CPU; if
  // the port waits for something in its steps, all of it.
  std::uint64_t missed_by_steps = 0, over_budget = 0;
  bool waits = false;
  std::uint64_t plant_steps = 0, plant_late_steps = 0;
  Nanoseconds longest_gap{0}, wall{0};
  Usage unit_usage, plant_usage;
  std::vector<Right> rights;
  SlowTicks slow;
  std::optional<Cyclictest> cyclictest;

  double per_million(std::uint64_t count) const;  // of the deadlines
};

// One rate of a stress run.
struct StressTask {
  Case the_case;  // its duration is that of the run
  Setup setup;
  std::shared_ptr<const Airframe> airframe;
  LiveOptions live;
  Nanoseconds idle_duration{0};
  std::string record_timing;                       // file; empty: none
  Nanoseconds timeout = std::chrono::seconds(10);  // for each answer of the port
};

struct StressProgress {
  LiveProgress live;
  bool idle = false;  // measuring the machine alone
};

// Flies it in a child process; a port that crashes or hangs gets a verdict. `stop` ends it early
// with what was measured. Errors: the port cannot be opened; the case cannot be flown in real time.
Result<StressResult> run_stress(const StressTask& task, const std::string& port,
                                const std::function<bool()>& stop,
                                const std::function<void(const StressProgress&)>& progress);

// The same in this process: no protection. For the child, and for tests.
Result<StressResult> stress_here(const StressTask& task, Port& port,
                                 const std::function<bool()>& stop,
                                 const std::function<void(const StressProgress&)>& progress);

}  // namespace attest
