// One or two units fly a plant in real time. Each unit has a thread, and so has the plant.
//
// The priorities are those of the firmware: the rate unit's is above the attitude unit's. Both run
// on the unit's CPU. The plant's priority is the lowest, in case it has the same CPU.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "harness/casefile/case.hpp"
#include "harness/core/loop_timing.hpp"
#include "harness/core/result.hpp"
#include "harness/loop/closed_loop.hpp"
#include "harness/plant/plant.hpp"
#include "harness/realtime/live_plant.hpp"
#include "harness/realtime/live_unit.hpp"
#include "harness/realtime/pacer.hpp"
#include "harness/realtime/privileges.hpp"

namespace attest {

// Where and how the threads run.
struct LiveOptions {
  int unit_cpu = 0, plant_cpu = 0;  // may be equal
  bool fifo = true;                 // SCHED_FIFO; false: the ordinary scheduler
  Wait wait;                        // of the units
};

struct LivePlan {
  RunConfiguration configuration;
  LiveOptions options;
  std::size_t samples = 0;  // the samples of the first ticks of each unit are kept
};

struct LiveProgress {
  Nanoseconds time{0};
  std::uint64_t deadlines = 0, missed = 0;  // of all units, so far
};

// Both functions are called every tenth of a second in flight.
struct LiveWatch {
  std::function<bool()> stop = [] { return false; };  // true: ends the flight
  std::function<void(const LiveProgress&)> progress = [](const LiveProgress&) {};
};

struct LiveFlight {
  LiveUnitRecord unit;  // of the unit that commands the motors
  LivePlantRecord plant;
  std::optional<LiveUnitRecord> attitude_unit;  // in a flight of the cascade
  // All privileges of the process and of the thread of `unit`, and those that were refused to the
  // other threads.
  std::vector<RealtimePrivilege> privileges;
  // A fault of the port outside of its steps. All other members are then empty. fly_live() leaves
  // this empty: only a PortHost sets it.
  std::optional<PortFault> fault;

  // The times of the flight, with which a simulated flight can repeat it.
  FlightTiming timing() const;
};

// Flies the case to its end, or until `watch` stops it, the vehicle is lost, or a port has a fault.
// The case's jitter and dropped ticks are not used: the real clock alone makes ticks late.
// AttitudeLoop::delay of the cascade is used. A unit that the estimator triggers waits for the
// plant's thread, which publishes a sample at each tick of the rate. The plant's thread samples the
// battery and runs the land detector, with the command that the motors follow. REQUIRES: a flight;
// fresh units, one or both as the case says. Errors: those of fly().
Result<LiveFlight> fly_live(const Case& the_case, const LivePlan& plan,
                            const VehicleModel& vehicle_model, FlightUnits units,
                            const LiveWatch& watch);

// The wake-up latency of an idle thread at that rate, on the unit's CPU and with its privileges:
// the latency of the machine itself.
Histogram idle_latency(const Rate& rate, Nanoseconds duration, const LiveOptions& options,
                       const std::function<bool()>& stop);

}  // namespace attest
