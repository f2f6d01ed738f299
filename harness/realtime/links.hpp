// The messages between the threads of the plant and of the units.
//
//     plant -> each unit               the state; LandDetected in the cascade with a floor
//     plant -> unit of the motors      battery_status
//     unit of the motors -> plant      the motor commands
//     attitude unit -> rate unit       the rates setpoint
//
// The unit of the motors commands them: the controller, or the rate unit of the cascade.
#pragma once

#include <atomic>
#include <cstddef>
#include <semaphore>

#include "harness/core/time.hpp"
#include "harness/loop/actuators.hpp"
#include "harness/loop/land_detector.hpp"
#include "harness/loop/unit_task.hpp"
#include "harness/plant/plant.hpp"
#include "harness/realtime/triple_buffer.hpp"

namespace attest {

struct LiveState {
  Nanoseconds time{0};  // of the plant
  PlantState state;
  Nanoseconds published{0};  // when this message was written
};

struct LiveCommand {
  std::size_t tick = 0;
  Nanoseconds made{0};
  MotorCommands commands{};
  float throttle = 0;  // as commanded by the unit; an input of the battery estimate
  bool armed = false;
};

// battery_status, in a flight with a battery.
struct LiveBattery {
  Nanoseconds time{0};  // of the battery's sample
  float scale = 1;
};

struct LiveRatesSetpoint {
  std::size_t tick = 0;  // of the attitude unit
  Nanoseconds made{0};
  RatesSetpoint value{};
};

// From the plant to one unit.
struct UnitLinks {
  TripleBuffer<LiveState> states;
  TripleBuffer<LandDetected> landed;  // in the cascade with a floor
};

struct Links {
  UnitLinks unit;           // of the unit that commands the motors
  UnitLinks attitude_unit;  // in a flight of the cascade
  TripleBuffer<LiveCommand> commands;
  TripleBuffer<LiveBattery> batteries;
  TripleBuffer<LiveRatesSetpoint> rates_setpoints;
  std::atomic<int> flying{1};     // units that still fly; the last one sets `stop` when it ends
  std::atomic<bool> stop{false};  // any thread may set it
  // For a unit that the estimator triggers. The plant's thread releases `published` when a new
  // sample of the estimator is in UnitLinks::states: once for several samples that come together,
  // and once at the end. After its last sample it sets `all_published`.
  std::counting_semaphore<> published{0};
  std::atomic<bool> all_published{false};
};

}  // namespace attest
