// The unit's task on a clock: it waits for its deadlines, and writes down how it went.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "harness/casefile/case.hpp"
#include "harness/realtime/histogram.hpp"
#include "harness/realtime/links.hpp"
#include "harness/realtime/usage.hpp"
#include "harness/run/unit_task.hpp"
#include "harness/schedule/clock.hpp"
#include "harness/schedule/delay_line.hpp"

namespace attest {

struct LiveTick {
  Nanoseconds sampled{0};    // time of the plant's state that it was told
  Nanoseconds begins{0};     // its timestamp
  Nanoseconds execution{0};  // of the unit's step and the mixer
  Nanoseconds cpu{0};        // of that, time on the CPU: less when it was preempted, or waited
  std::uint32_t missed = 0;  // deadlines that had passed when it was over, beside the next
};

struct LiveUnitRecord {
  Histogram lateness;          // from the deadline until it woke up
  Histogram execution;         // as of LiveTick
  Histogram age;               // of the sample used, when the step ended: what the loop feels
  std::uint64_t overruns = 0;  // steps that were not over at the next deadline
  std::uint64_t missed = 0;    // deadlines that were passed over
  Nanoseconds longest_gap{0};  // between the begins of two ticks
  Usage usage;                 // after the first tick, which sets the parameters
  std::vector<LiveTick> ticks;
  std::vector<Sample> samples;  // of the first ticks
  std::vector<ParameterChange> changes;
  std::optional<PortFault> fault;
};

// One deadline a period. A tick whose deadline passed while the one before ran begins at once; of
// several such deadlines only the last is kept, the others are missed.
//
// A unit that the estimator triggers waits for a sample instead. Its deadline is the publication,
// and of several that came while a step ran only the newest is used, the others are missed.
class LiveUnit {
 public:
  // Records all ticks, and the samples of the first `samples`; allocates and touches the memory for
  // it here, and none later. REQUIRES: a flight; all outlive this.
  LiveUnit(const Case& the_case, const Rate& rate, UnitTask& task, Clock& clock, Links& links,
           std::size_t samples);

  // Until the case is over, the links say stop, or the port goes wrong. Once.
  void run();

  // For other threads, while it runs.
  std::uint64_t deadlines_passed() const { return passed_.load(std::memory_order_relaxed); }
  std::uint64_t missed() const { return missed_.load(std::memory_order_relaxed); }

  // How many there are in the case: the most ticks there can be.
  std::size_t deadlines() const { return static_cast<std::size_t>(deadlines_); }

  // After run().
  LiveUnitRecord take_record() { return std::move(record_); }

 private:
  void run_on_deadlines();
  void run_on_estimates();
  // The tick of `deadline`, for which it woke up at `woke`. Returns when the step was over.
  Nanoseconds tick(Nanoseconds deadline, Nanoseconds woke);
  // After tick k, when tick `next` is the next.
  void count_missed(std::int64_t k, std::int64_t next);
  bool take_sample();
  void take_battery();
  std::optional<MotorLimits> limits_at(Nanoseconds now);
  void write_down(const LiveTick& tick);

  UnitTask& task_;
  Clock& clock_;
  Links& links_;
  Rate rate_;
  bool on_estimate_;
  std::int64_t deadlines_;
  NoisyEstimator estimator_;
  LiveState latest_;
  bool sampled_ = false;
  std::vector<Nanoseconds> limit_times_;
  std::size_t limits_done_ = 0;
  DelayLine<MotorLimits> limits_;
  DelayLine<float> battery_scales_;
  std::size_t ticks_ = 0, samples_max_;
  std::atomic<std::uint64_t> passed_{0}, missed_{0};
  Usage warm_;
  LiveUnitRecord record_;
};

}  // namespace attest
