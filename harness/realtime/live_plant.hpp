// Steps the plant on a clock, as time passes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "harness/core/histogram.hpp"
#include "harness/loop/land_detector.hpp"
#include "harness/loop/plant_task.hpp"
#include "harness/plant/plant.hpp"
#include "harness/realtime/clock.hpp"
#include "harness/realtime/links.hpp"
#include "harness/realtime/usage.hpp"

namespace attest {

struct LivePlantRecord {
  Histogram latency;             // of the wake-ups
  std::uint64_t late_steps = 0;  // made together with a later step, which was due too
  // For each tick of the unit that commands the motors: when the motors began to follow its
  // command. Empty if a later command, or the end of the flight, came first. In a LiveFlight the
  // ticks have these times (LiveTick::commanded).
  std::vector<std::optional<Nanoseconds>> commanded;
  std::optional<Divergence> divergence;
  Usage usage;

  std::uint64_t steps() const { return latency.count() + late_steps; }
};

struct LivePlantPlan {
  Rate physics;
  Nanoseconds duration{0};
  std::size_t ticks = 0;  // the most that the unit that commands the motors can have
  std::vector<Nanoseconds> battery_times;  // of the battery's samples; empty: no battery
  std::optional<Rate> estimator;           // set if its samples trigger the unit
  // In the cascade with a floor: the detector, and the times of its samples.
  std::optional<LandDetector> land_detector;
  std::vector<Nanoseconds> landing_times;
};

class LivePlant {
 public:
  // Publishes the state at time 0. Allocates here and never later.
  LivePlant(PlantTask& task, LivePlantPlan plan, Clock& clock, Links& links);

  // Runs until LivePlantPlan::duration, Links::stop, or the loss of the vehicle. Call once. The
  // estimator's sample k is the first state at or after estimator.tick(k).
  void run();

  // After run().
  LivePlantRecord take_record() { return std::move(record_); }

 private:
  std::optional<Divergence> advance(Nanoseconds to);
  void sample_battery(Nanoseconds now);
  void detect_landing(Nanoseconds now);
  void write_state(Nanoseconds now, Nanoseconds published);
  void publish(Nanoseconds now);
  std::optional<Divergence> take_commands(Nanoseconds now);
  std::optional<Divergence> command(Nanoseconds now, const LiveCommand& command);

  PlantTask& task_;
  LivePlantPlan plan_;
  Clock& clock_;
  Links& links_;
  std::size_t disturbed_ = 0;   // disturbances so far
  std::size_t batteries_ = 0;   // samples of the battery so far
  std::size_t landings_ = 0;    // samples of the land detector so far
  std::int64_t estimates_ = 0;  // samples of the estimator that were due so far
  float throttle_ = 0;          // of the command that the motors follow
  bool armed_ = false;
  std::optional<LiveCommand> pending_;  // made after the time of the step that read it
  LivePlantRecord record_;
};

}  // namespace attest
