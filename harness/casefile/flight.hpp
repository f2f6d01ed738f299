// The data of a case that is a flight: its vehicles and plants, its start, its disturbances, and
// the timing of the tasks around the unit.
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

// A periodic task other than the unit's. Its result reaches the unit `delay` after the task ran.
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
  double height_m = 0;              // above z = 0, the height of the floor
  bool on_floor = false;            // in place of a height: the feet touch the floor
  bool rotors_stopped = false;      // else they turn at hover speed
};

// The estimator finds that its attitude was wrong: from `at` on its estimate is turned.
struct EstimatorReset {
  Span at;
  Quaternion turn;  // the estimate after it = turn * the estimate before it
};

// The estimate of attitude and rates that the units receive: delayed and noisy. Delay and drift are
// those of the attitude; the cascade's rate unit reads the gyro at its tick.
struct Estimator {
  Span delay{0, Span::In::seconds};
  // Empty: the estimator runs once for each tick of the unit. Else it runs on its own clock, faster
  // than the loop rate by this fraction (slower if negative), and a tick receives its last sample.
  std::optional<double> drift;
  double attitude_noise_deg = 0;  // standard deviation of a rotation about each body axis
  double rate_noise_rad_s = 0;    // standard deviation, each axis
  std::uint64_t seed = 1;
  std::optional<EstimatorReset> reset = std::nullopt;  // of the cascade
};

// A battery that empties. Its voltage limits the rotors' speed, and battery_status is computed from
// it as the firmware does. Without a battery the supply is ideal.
struct BatteryFlight {
  double charge = 1;  // at the start, as a fraction of the capacity
  // Capacity in seconds of hover, small enough to be used up in a flight. Empty: the vehicle's.
  std::optional<double> capacity_hover_s;
  TaskTiming timing = task_at(Rate::hz(100));  // the firmware's filter counts samples of 100 Hz
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
  std::string lead_vehicle;                              // flies at all rates of the case
  std::vector<LoopRate> other_rates;                     // of the other vehicles, ascending
  std::optional<Rate> physics;  // of MuJoCo; empty: 1 kHz, or the loop rate if that is higher
  int physics_line = 0;         // of the case file, for messages
  bool floor = false;
  FlightStart start;
  Estimator estimator;
  // Publishes what the actuators could not realise: multirotor_motor_limits, at 50 Hz in the
  // firmware; of the cascade control_allocator_status.
  TaskTiming saturation;
  Span actuator_delay{0, Span::In::seconds};  // from the unit's tick to the motors
  std::optional<BatteryFlight> battery;
  std::array<Signal, 3> wind_m_s{};  // of the air, NED
  // Offset from its nominal place, FRD, in units of the vehicle's arm.
  std::array<Signal, 3> centre_of_mass_of_arm{};
  std::optional<MotorFailure> motor_failure;
  std::vector<Metric> metrics;
  RealtimeBudget realtime;
};

}  // namespace attest
