// The data of a case that is a flight: its vehicles and plants, its start, its disturbances, and
// the timing of the tasks around the units.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "harness/casefile/run_configuration.hpp"
#include "harness/casefile/signal.hpp"
#include "harness/compare/metric.hpp"
#include "harness/plant/plant.hpp"

namespace attest {

// A periodic task other than a unit. Its result reaches the units `delay` after the task ran.
struct TaskTiming {
  Rate rate = Rate::hz(50);
  Span phase{0, Span::In::seconds};
  double jitter = 0;  // late by up to this fraction of a period
  std::uint64_t seed = 1;
  Span delay{0, Span::In::seconds};
  std::vector<std::int64_t> drop_ticks;
};

inline TaskTiming task_at(const Rate& rate) {
  TaskTiming timing;
  timing.rate = rate;
  return timing;
}

struct FlightStart {
  Quaternion attitude{1, 0, 0, 0};  // body FRD to world NED
  Vector3 rate_rad_s{};             // of the body
  double height_m = 0;              // of the centre of mass above z = 0, where the floor is
  bool on_floor = false;            // the feet touch the floor, and height_m is not used
  bool rotors_stopped = false;      // false: they turn at hover speed
};

// The estimator corrects its attitude: from `at` on its estimate is rotated by `turn`.
struct EstimatorReset {
  Span at;
  Quaternion turn;  // estimate from `at` on = turn * estimate without the reset
};

// The estimate of attitude and rates that the units receive, delayed and noisy. Delay and drift do
// not apply to the cascade's rate unit, which reads the gyro at its tick.
struct Estimator {
  Span delay{0, Span::In::seconds};
  // Empty: the estimator runs once for each tick of the unit. Otherwise it runs on its own clock,
  // faster than the loop rate by this fraction (slower if negative), and a tick receives the last
  // estimate that has arrived.
  std::optional<double> drift;
  double attitude_noise_deg = 0;  // standard deviation of a rotation about each body axis
  double rate_noise_rad_s = 0;    // standard deviation, each axis
  std::uint64_t seed = 1;
  std::optional<EstimatorReset> reset = std::nullopt;  // only of the cascade
};

// A battery that empties. Its voltage limits the rotors' speed, and battery_status is computed from
// it as the firmware does. Without a battery the supply is ideal.
struct BatteryFlight {
  double charge = 1;  // at the start, as a fraction of the capacity
  // Capacity in seconds of hover, to use it up in a short flight. Empty: the vehicle's capacity.
  std::optional<double> capacity_hover_s;
  TaskTiming timing = task_at(Rate::hz(100));  // as in the firmware
};

struct MotorFailure {
  std::size_t rotor = 0;  // index in the vehicle's order
  Span at;
};

// The limits for a run in real time. They are counts and percentiles: a single maximum depends on
// the machine. docs/timing.md defines the terms.
struct RealtimeBudget {
  double misses_per_million = 500;     // deadline misses; the same limit for overruns
  double p99_latency_us = 100;         // wake-up latency that 1% may exceed
  std::optional<double> execution_us;  // execution time; empty: no limit
};

struct Flight {
  std::vector<PlantConfiguration> plant_configurations;  // ascending
  std::string lead_vehicle;                              // flies at the case's rates
  std::vector<LoopRate> other_rates;                     // of the other vehicles, ascending
  std::optional<Rate> physics;  // of MuJoCo's steps; empty: 1 kHz, or the loop rate if higher
  int physics_line = 0;         // of the case file, for messages
  bool floor = false;
  FlightStart start;
  Estimator estimator;
  // The task that publishes what the actuators could not realise: multirotor_motor_limits, or in
  // the cascade control_allocator_status.
  TaskTiming saturation;
  // Values of MC_AIRMODE: a parameter of the attitude unit, which the allocator reads, too.
  // Case::of_module() sets it.
  Signal airmode = Constant{0};
  Span actuator_delay{0, Span::In::seconds};  // from the unit's tick to the motors
  std::optional<BatteryFlight> battery;
  std::array<Signal, 3> wind_m_s{};  // of the air, NED
  // Offset of the centre of mass from its nominal place, FRD, in units of the vehicle's arm.
  std::array<Signal, 3> centre_of_mass_of_arm{};
  std::optional<MotorFailure> motor_failure;
  std::vector<Metric> metrics;
  RealtimeBudget realtime;
};

}  // namespace attest
