// A port that flies in real time: what was measured, what the machine does alone, and the verdict.
// The terms are those of the glossary in README.md, Timing.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "harness/casefile/case.hpp"
#include "harness/host/port_says.hpp"
#include "harness/plant/plant.hpp"
#include "harness/realtime/cyclictest.hpp"
#include "harness/realtime/deadline_misses.hpp"
#include "harness/realtime/live_flight.hpp"
#include "harness/realtime/slow_ticks.hpp"
#include "harness/verify/verdict.hpp"

namespace attest {

// What a report says of a histogram. A percentile is empty where there are too few samples for it
// (supports_percentile()); min and max are always there.
struct Percentiles {
  std::uint64_t count = 0;
  Nanoseconds min{0}, max{0};
  std::optional<Nanoseconds> median, p90, p99, p999;
  std::vector<Histogram::Bucket> buckets;
};
Percentiles percentiles_of(const Histogram& histogram);

struct StressResult {
  // Verdict; ticks, first and tightest are of the outputs, compared with the reference's.
  CaseResult result;
  Percentiles idle;  // wake-up latency of a thread with nothing to do: the machine's own floor
  Percentiles latency, execution, response, age;  // as in LiveUnitRecord
  Percentiles plant;                              // wake-up latency of the plant
  std::uint64_t deadlines = 0;                    // releases: steps that ran, and skipped ones
  std::uint64_t ticks = 0;                        // steps that ran
  DeadlineMisses misses;            // late starts: above RealtimeBudget::p99_latency_us
  std::uint64_t overruns = 0;       // steps above RealtimeBudget::execution_us
  std::uint64_t waiting_steps = 0;  // LiveTick::waited
  std::uint64_t plant_steps = 0, plant_late_steps = 0;
  Nanoseconds longest_gap{0}, wall{0};
  Usage unit_usage, plant_usage;
  std::vector<RealtimePrivilege> privileges;
  SlowTicks slow;
  std::optional<Cyclictest> cyclictest;

  double per_million(std::uint64_t count) const;  // of the deadlines
};

// One rate of a stress run.
struct StressTask {
  Case the_case;  // its duration is that of the run
  RunConfiguration configuration;
  std::shared_ptr<const VehicleModel> vehicle_model;
  PortSays port;  // what the port said before
  LiveOptions live;
  Nanoseconds idle_duration{0};
  std::string record_timing;                       // file; empty: none
  Nanoseconds timeout = std::chrono::seconds(10);  // for each answer of the port
};

// Of so many ticks the outputs are kept and checked: half a minute at 8 kHz, 80 MB.
inline constexpr std::size_t checked_ticks = 1u << 18;

struct StressProgress {
  LiveProgress live;
  bool idle = false;  // measuring the machine alone
};

// What was measured, without a verdict, and what a judge needs besides: of `flight` the outputs,
// the ticks, and how it ended.
struct StressMeasurement {
  StressResult stress;
  std::optional<LiveFlight> flight;  // empty: the port makes no unit of that profile
};

// Flies it in a child process, and judges it in this one; a port that crashes or hangs gets a
// verdict. `stop` ends it early with what was measured. Errors: the port cannot be opened; the case
// cannot be flown in real time.
Result<StressResult> run_stress(const StressTask& task, const std::string& port,
                                const std::function<bool()>& stop,
                                const std::function<void(const StressProgress&)>& progress);

// In the port's process. REQUIRES: the port does not decline the task (run_stress asks what it said
// of itself).
Result<StressMeasurement> measure_live(const StressTask& task, Port& port,
                                       const std::function<bool()>& stop,
                                       const std::function<void(const StressProgress&)>& progress);

// What the histograms and counters of a flight say: all of a StressResult but its verdict, what the
// idle machine does, and cyclictest.
void summarise(const LiveFlight& flight, const Rate& rate, const RealtimeBudget& budget,
               StressResult& stress);

// Writes the timing of the flight, too, where the task says so. Errors: it cannot be written.
Result<StressResult> judge_live(const StressTask& task, StressMeasurement measurement);

}  // namespace attest
