// The messages between the plant's thread and the unit's.
#pragma once

#include <atomic>
#include <cstddef>
#include <semaphore>

#include "harness/core/time.hpp"
#include "harness/loop/actuators.hpp"
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

struct Links {
  TripleBuffer<LiveState> states;
  TripleBuffer<LiveCommand> commands;
  TripleBuffer<LiveBattery> batteries;
  std::atomic<bool> stop{false};  // any thread may set it
  // For a unit that the estimator triggers: released with each sample of the estimator that is in
  // `states`. `all_published` is set after the last sample of the plant's thread.
  std::counting_semaphore<> published{0};
  std::atomic<bool> all_published{false};
};

}  // namespace attest
