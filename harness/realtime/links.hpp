// The messages between the threads of the plant and of the units.
//
//     plant -> each unit               the state; with a floor, what the land detector found
//     plant -> unit of the motors      battery_status
//     unit of the motors -> plant      the motor commands
//     attitude unit -> rate unit       the rates setpoint
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
  Nanoseconds published{0};  // when this was written
};

struct LiveCommand {
  std::size_t tick = 0;
  Nanoseconds made{0};
  MotorCommands commands{};
  float throttle = 0;  // as commanded by the unit; an input of the battery estimate
  bool armed = false;
};

// battery_status, of a flight with a battery.
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
  TripleBuffer<LandDetected> landed;  // of a flight with a floor
};

struct Links {
  UnitLinks unit;           // that commands the motors
  UnitLinks attitude_unit;  // of a flight of the cascade
  TripleBuffer<LiveCommand> commands;
  TripleBuffer<LiveBattery> batteries;
  TripleBuffer<LiveRatesSetpoint> rates_setpoints;
  std::atomic<int> flying{1};     // units that still fly; the last one that ends sets `stop`
  std::atomic<bool> stop{false};  // any thread may set it
  // For a unit that the estimator triggers: released when a new sample of the estimator is in its
  // `states`, once for several samples, and once at the end. `all_published` is set after the last
  // sample of the plant's thread.
  std::counting_semaphore<> published{0};
  std::atomic<bool> all_published{false};
};

}  // namespace attest
