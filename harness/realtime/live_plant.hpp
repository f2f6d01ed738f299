// The plant on a clock: it is stepped as time passes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "harness/loop/land_detector.hpp"
#include "harness/loop/plant_task.hpp"
#include "harness/plant/plant.hpp"
#include "harness/realtime/histogram.hpp"
#include "harness/realtime/links.hpp"
#include "harness/realtime/usage.hpp"
#include "harness/schedule/clock.hpp"

namespace attest {

struct LivePlantRecord {
  Histogram latency;
  std::uint64_t steps = 0;
  std::uint64_t late_steps = 0;  // made together with a later step, whose time had come too
  // For each tick of the unit: when the motors began to follow its command. Empty if a later
  // command, or the end of the flight, came first.
  std::vector<std::optional<Nanoseconds>> commanded;
  std::optional<Divergence> divergence;
  Usage usage;
};

struct LivePlantPlan {
  Rate physics;
  Nanoseconds duration{0};
  std::size_t ticks = 0;                   // of the unit, at most
  std::vector<Nanoseconds> battery_times;  // of the battery's samples; empty: no battery
  std::optional<Rate> estimator;           // whose samples trigger the unit
  // The detector of a flight of the cascade with a floor, and the times of its samples.
  std::optional<LandDetector> land_detector;
  std::vector<Nanoseconds> landing_times;
};

class LivePlant {
 public:
  // Publishes the state at time 0. Allocates here and never later.
  LivePlant(PlantTask& task, LivePlantPlan plan, Clock& clock, Links& links);

  // Runs until `duration`, Links::stop, or the loss of the vehicle. Call once. The estimator's
  // sample k is due at rate.tick(k), and is published with the first state that is not earlier.
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
  std::size_t disturbed_ = 0;
  std::size_t batteries_ = 0;   // samples taken
  std::size_t landings_ = 0;    // of the land detector
  std::int64_t estimates_ = 0;  // samples published
  float throttle_ = 0;          // of the command that the motors follow
  bool armed_ = false;
  std::optional<LiveCommand> pending_;  // read by a step whose time is before the command's
  LivePlantRecord record_;
};

}  // namespace attest
