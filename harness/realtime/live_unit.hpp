// Runs a unit's task on a clock: waits for its releases, and records each tick.
//
// The controller or the rate unit commands the motors. The attitude unit sends the rates setpoint
// to the rate unit, which receives it at the first tick that begins at least AttitudeLoop::delay
// later. If a newer setpoint arrives before that tick, the older one is lost, same as in a topic of
// queue length 1.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "harness/casefile/case.hpp"
#include "harness/core/delay_line.hpp"
#include "harness/core/loop_rate.hpp"
#include "harness/loop/unit_task.hpp"
#include "harness/realtime/clock.hpp"
#include "harness/realtime/links.hpp"
#include "harness/realtime/live_tick.hpp"
#include "harness/realtime/usage.hpp"

namespace attest {

struct LiveUnitRecord {
  std::uint64_t skipped = 0;  // releases, also those before the first tick
  Usage usage;                // without the first tick, which sets the parameters
  std::vector<LiveTick> ticks;
  std::vector<Sample> samples;           // of the first ticks
  std::vector<ParameterChange> changes;  // of the same ticks
  // In the rate unit's record, for each tick of the attitude unit: LiveTick::begins of the tick of
  // the rate unit that received the setpoint. Empty if no tick received it.
  std::vector<std::optional<Nanoseconds>> setpoints_received;
  std::optional<PortFault> fault;
};

// There is one release per period. If releases come during a step, the next tick starts as soon as
// that step ends. It uses the last of these releases; the others are skipped.
//
// For a unit that the estimator triggers, a release is the publication of a sample. If several
// samples come during a step, the newest is used and the others are skipped.
class LiveUnit {
 public:
  // Records all ticks, and the samples of the first `samples` ticks. The constructor allocates the
  // memory for both and touches every page, so that run() records them without a page fault.
  // Parameter changes have no reserved memory: a tick that records some may allocate. `the_case` is
  // Case::of_module() of a flight, for the task's module. REQUIRES: all arguments outlive this.
  LiveUnit(const Case& the_case, const LoopRate& rate, UnitTask& task, Clock& clock, Links& links,
           std::size_t samples);

  // Runs until the end of the case, Links::stop, or a fault of the port, which stops all threads.
  // Call once.
  void run();

  // Other threads may call these while run() runs.
  std::uint64_t releases_passed() const { return passed_.load(std::memory_order_relaxed); }
  std::uint64_t missed() const { return missed_.load(std::memory_order_relaxed); }

  // The number of releases in the case: the largest possible number of ticks.
  std::size_t deadlines() const { return static_cast<std::size_t>(deadlines_); }

  // After run().
  LiveUnitRecord take_record() { return std::move(record_); }

 private:
  void run_on_releases();
  void run_on_estimates();
  // Runs the tick of a release; `due` has the values known before the step. Returns the finish.
  Nanoseconds tick(LiveTick due);
  // Counts the releases after k and before `next` as skipped. `next` is the next release in use.
  void count_skipped(std::int64_t k, std::int64_t next);
  bool take_sample();
  void take_messages();
  Arrivals arrivals_at(Nanoseconds now);
  void send(Nanoseconds made);
  std::optional<Saturation> saturation_at(Nanoseconds now);
  void write_down(const LiveTick& tick);

  UnitTask& task_;
  Clock& clock_;
  Links& links_;
  UnitLinks& own_;
  bool commands_motors_;
  Rate rate_;
  bool on_estimate_;
  std::int64_t deadlines_;
  UnitEstimator estimator_;
  LiveState latest_;
  bool sampled_ = false;
  std::vector<Nanoseconds> saturation_times_;
  std::size_t saturations_done_ = 0;
  DelayLine<Saturation> saturations_;
  DelayLine<float> battery_scales_;
  DelayLine<LiveRatesSetpoint> rates_setpoints_;
  std::optional<LandDetected> landed_;
  std::size_t ticks_ = 0, samples_max_;
  std::uint64_t late_ = 0;  // responses longer than the period
  std::atomic<std::uint64_t> passed_{0}, missed_{0};
  Usage warm_;
  LiveUnitRecord record_;
};

}  // namespace attest
