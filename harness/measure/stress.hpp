// Flies a port in real time: measures the flight and the idle machine, and judges the port. The
// terms are those of docs/timing.md.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "harness/casefile/case.hpp"
#include "harness/core/file.hpp"
#include "harness/host/declarations.hpp"
#include "harness/host/port_process.hpp"
#include "harness/plant/plant.hpp"
#include "harness/realtime/cyclictest.hpp"
#include "harness/realtime/deadline_misses.hpp"
#include "harness/realtime/live_flight.hpp"
#include "harness/realtime/slow_ticks.hpp"
#include "harness/realtime/timeline.hpp"
#include "harness/verify/verdict.hpp"

namespace attest {

// The summary of a histogram for a report. A percentile is empty if there are too few samples for
// it (supports_percentile()).
struct Percentiles {
  std::uint64_t count = 0;
  Nanoseconds min{0}, max{0};
  std::optional<Nanoseconds> median, p90, p99, p999;
  std::vector<Histogram::Bucket> buckets;
};
Percentiles percentiles_of(const Histogram& histogram);

struct StressResult {
  // The verdict. If the outputs were compared with the reference's, `ticks`, `first` and `tightest`
  // are those of this comparison.
  VectorResult result;
  // The unit of the cascade. Empty: the controller, or a result without measurements.
  std::optional<Module> module;
  Percentiles idle;  // wake-up latency of an idle thread (idle_latency())
  Percentiles latency, execution, response, age;  // as in LiveTick
  Percentiles plant;                              // wake-up latency of the plant
  std::uint64_t deadlines = 0;                    // releases: steps that ran, and skipped ones
  std::uint64_t ticks = 0;                        // steps that ran
  DeadlineMisses misses;            // the latency limit is RealtimeBudget::p99_latency_us
  std::uint64_t overruns = 0;       // steps above RealtimeBudget::execution_us
  std::uint64_t waiting_steps = 0;  // steps with LiveTick::waited
  std::uint64_t plant_steps = 0, plant_late_steps = 0;
  Nanoseconds longest_gap{0};  // between LiveTick::begins of a tick and of the next
  Nanoseconds wall{0};         // from time 0 to the last tick of the unit of the motors
  Usage unit_usage, plant_usage;
  std::vector<RealtimePrivilege> privileges;
  SlowTicks slow;
  FlightTimeline timeline;  // not in the JSON
  std::optional<Cyclictest> cyclictest;

  double per_million(std::uint64_t count) const;  // `count` per million deadlines
  const Rate& unit_rate() const;
};

// The results of a stress run at one rate. A flight of the cascade has one for each unit of the
// port, that of the rate unit first. A unit that the port does not have is the reference's, and is
// not judged. A run without measurements has one result.
using StressResults = std::vector<StressResult>;

// One rate of a stress run.
struct StressTask {
  Case the_case;  // its duration is that of the run
  RunConfiguration configuration;
  std::shared_ptr<const VehicleModel> vehicle_model;
  Declarations port;  // the port's declarations before the run
  LiveOptions live;
  Nanoseconds idle_duration{0};
  std::shared_ptr<AtomicFile> record_timing;  // for the timing; null: not written
};

// The outputs of the first ticks, at most this number, are kept and compared: half a minute at 8
// kHz, 80 MB.
inline constexpr std::size_t checked_ticks = 1u << 18;

struct StressProgress {
  LiveProgress live;
  bool idle = false;  // the idle machine is being measured; `live` is zero
};

// Measures the idle machine at the rate of the unit that commands the motors, has the host fly the
// task, and judges it. A port that crashes or hangs gets a verdict. `stop` ends the flight early;
// the measurements so far are judged. Errors: the port cannot be opened; the flight cannot be set
// up; the timing cannot be written.
Result<StressResults> run_stress(const StressTask& task, const HostOptions& host,
                                 const std::function<bool()>& stop,
                                 const std::function<void(const StressProgress&)>& progress);

// Fills `stress` from the record of a unit of the flight, except the verdict, the module, the
// timeline, the idle machine's latency, and cyclictest. `rate` is that of the unit.
void summarise(const LiveFlight& flight, const LiveUnitRecord& unit, const Rate& rate,
               const RealtimeBudget& budget, StressResult& stress);

TimelineLimits limits_of(const RealtimeBudget& budget);

// Judges the flight, and writes its timing if the task has a file for it. `idle`: of the idle
// machine. Errors: the file cannot be written.
Result<StressResults> judge_live(const StressTask& task, const Percentiles& idle,
                                 LiveFlight flight);

}  // namespace attest
