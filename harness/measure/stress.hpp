// A port that flies in real time: the measurements, those of the idle machine, and the verdict. The
// terms are those of docs/timing.md.
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
#include "harness/realtime/timeline.hpp"
#include "harness/verify/verdict.hpp"

namespace attest {

// The summary of a histogram for a report. A percentile is empty where there are too few samples
// for it (supports_percentile()); min and max are always there.
struct Percentiles {
  std::uint64_t count = 0;
  Nanoseconds min{0}, max{0};
  std::optional<Nanoseconds> median, p90, p99, p999;
  std::vector<Histogram::Bucket> buckets;
};
Percentiles percentiles_of(const Histogram& histogram);

struct StressResult {
  // The verdict. Its members `ticks`, `first` and `tightest` come from the comparison of the
  // outputs with those of the reference.
  CaseResult result;
  // The unit, in a flight of the cascade. Empty: the controller, or a flight without measurements.
  std::optional<Module> module;
  Percentiles idle;  // wake-up latency of an idle thread: the machine's own part
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
  FlightTimeline timeline;  // of the ticks that the judge's process received; not in the JSON
  std::optional<Cyclictest> cyclictest;

  double per_million(std::uint64_t count) const;  // of the deadlines
  const Rate& unit_rate() const;                  // of the module
};

// A flight of the cascade has one result for each unit of the port, that of the rate unit first. A
// unit that the port does not have is the reference's, and is not judged.
using StressResults = std::vector<StressResult>;

// One rate of a stress run.
struct StressTask {
  Case the_case;  // its duration is that of the run
  RunConfiguration configuration;
  std::shared_ptr<const VehicleModel> vehicle_model;
  PortSays port;  // the port's declarations before the run
  LiveOptions live;
  Nanoseconds idle_duration{0};
  std::string record_timing;                       // file; empty: none
  Nanoseconds timeout = std::chrono::seconds(10);  // for each answer of the port
};

// The outputs of this number of ticks, the first ones, are kept and compared: half a minute at 8
// kHz, 80 MB.
inline constexpr std::size_t checked_ticks = 1u << 18;

struct StressProgress {
  LiveProgress live;
  bool idle = false;  // measuring the idle machine
};

// The measurements, without a verdict. A judge also needs the outputs of `flight`, its ticks and
// its end.
struct StressMeasurement {
  StressResult stress;                        // of the unit that commands the motors
  std::optional<StressResult> attitude_unit;  // of a flight of the cascade
  std::optional<LiveFlight> flight;           // empty: the port did not make the units
  std::optional<PortFault> refusal;           // why; empty: it makes no unit of that profile
};

// Flies the task in a child process, and judges it in this one; a port that crashes or hangs gets a
// verdict. `stop` ends it early with the measurements so far. Errors: the port cannot be opened;
// the case cannot be flown in real time.
Result<StressResults> run_stress(const StressTask& task, const std::string& port,
                                 const std::function<bool()>& stop,
                                 const std::function<void(const StressProgress&)>& progress);

// Runs in the port's process. The idle machine is measured at the rate of the unit that commands
// the motors. REQUIRES: the port does not decline the task (run_stress checks its declarations).
Result<StressMeasurement> measure_live(const StressTask& task, Port& port,
                                       const std::function<bool()>& stop,
                                       const std::function<void(const StressProgress&)>& progress);

// Fills `stress` from the histograms and counters of a unit of the flight, except the verdict, the
// idle machine's latency, and cyclictest. `rate` is that of the unit.
void summarise(const LiveFlight& flight, const LiveUnitRecord& unit, const Rate& rate,
               const RealtimeBudget& budget, StressResult& stress);

// The limits of `budget` for the timeline.
TimelineLimits limits_of(const RealtimeBudget& budget);

// Also writes the timing of the flight if the task has a file for it. Errors: it cannot be written.
Result<StressResults> judge_live(const StressTask& task, StressMeasurement measurement);

}  // namespace attest
