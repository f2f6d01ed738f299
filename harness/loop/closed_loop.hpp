// Flies a plant with the units of a flight controller. Events at the same instant happen in this
// order:
//
//     the plant is advanced to t
//     disturbances    wind, centre of mass and motor failure change
//     battery         takes its sample of the plant
//     saturation      takes what the mixer or the allocator reported at its last run, before t
//     land detector   of the cascade, if there is a floor: takes its sample of the plant
//     estimators      take their samples of the plant, one for each unit
//     rate unit       of the cascade, or the controller: the unit that commands the motors.
//                     Stimulus; messages; step; mixer or allocator
//     attitude unit   of the cascade: stimulus; messages; step
//     actuators       take the commands that have arrived, and hold them until the next ones
//
// In the firmware the rate unit has the higher priority. So here it runs before the attitude unit
// of the same instant, and receives that unit's new setpoint at the next tick at the earliest.
//
// Each task has its own times, and its result arrives after its delay. A tick of a unit receives
// the results that have arrived by then, also those of earlier events of the same instant.
// FlightTiming has the times of each unit's ticks, of their samples and of their results. It comes
// from the case or from a run on a real clock. The plant is not sampled before t = 0. Until the
// first estimate arrives, a unit receives the exact state of the flight's start. Until the first
// command arrives, the rotors turn as at the start.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "harness/casefile/case.hpp"
#include "harness/core/delay_line.hpp"
#include "harness/core/event_queue.hpp"
#include "harness/core/loop_rate.hpp"
#include "harness/core/loop_timing.hpp"
#include "harness/loop/estimator.hpp"
#include "harness/loop/plant_task.hpp"
#include "harness/loop/unit_task.hpp"
#include "harness/plant/plant.hpp"
#include "harness/port/port.hpp"
#include "harness/trace/trace.hpp"

namespace attest {

struct FlightEnd {
  std::size_t ticks = 0;           // finished by the unit that commands the motors
  std::size_t attitude_ticks = 0;  // finished by the attitude unit
  std::optional<PortFault> fault;
  std::optional<Divergence> divergence;
};

// The units that fly. `attitude_unit` is null except in a flight of the cascade.
struct FlightUnits {
  FlightUnits(Unit& of_motors, Unit* attitude = nullptr)  // NOLINT(google-explicit-constructor)
      : unit(of_motors), attitude_unit(attitude) {}
  Unit& unit;
  Unit* attitude_unit;
};

// What a flight records: a trace for each unit. A trace whose pointer is null is not recorded.
struct FlightTraces {
  FlightTraces(Trace* of_motors = nullptr, Trace* attitude = nullptr)  // NOLINT
      : unit(of_motors), attitude_unit(attitude) {}
  Trace* unit;           // including Trace::plant
  Trace* attitude_unit;  // only in a flight of the cascade
};

class ClosedLoop {
 public:
  // REQUIRES: a flight that bound_to_vehicle() made (flight.hpp); units in their power-on state,
  // both if the flight is of the cascade. All references outlive this.
  ClosedLoop(const Case& the_case, const LoopRate& rate, FlightTiming timing,
             const Vehicle& vehicle, Plant& plant, FlightUnits units);
  ClosedLoop(const ClosedLoop&) = delete;
  ClosedLoop& operator=(const ClosedLoop&) = delete;

  // Flies to the end and records every tick. Allocates memory only for the traces and for
  // parameters that change. Call once.
  FlightEnd run(FlightTraces traces);

 private:
  // A unit with its times and the messages on their way to it.
  struct UnitLoop {
    UnitLoop(const Case& the_case, const Rate& own, const Rate& timeline, LoopTiming times,
             const Vehicle& vehicle, Unit& unit, const PlantState& start);

    Case scripted;
    LoopTiming timing;
    std::size_t first_sampled;  // the first tick with a sample
    UnitEstimator estimator;
    UnitTask task;
    DelayLine<Estimate> estimates;
    DelayLine<LandDetected> landed;
  };

  EventQueue events_of(const Case& the_case, const Rate& rate) const;
  void happens(const EventQueue::Event& event);
  void sample(UnitLoop& unit, const EventQueue::Event& event);
  void tick(const EventQueue::Event& event);
  void attitude_tick(const EventQueue::Event& event);
  void detect_landing(Nanoseconds now);
  void record(Trace& trace) const;
  bool is_over() const;

  PlantTask plant_;
  UnitLoop unit_;
  std::optional<UnitLoop> attitude_unit_;
  LandDetector land_detector_;
  EventQueue event_queue_;
  FlightTraces traces_;

  DelayLine<float> battery_scales_;
  DelayLine<Saturation> saturations_;
  DelayLine<RatesSetpoint> rates_setpoints_;
  DelayLine<MotorCommands> commands_;

  FlightEnd end_;
};

}  // namespace attest
