// A unit flies a plant. Events at the same instant happen in this order:
//
//     the plant is advanced to t
//     disturbances    wind, centre of mass and motor failure change
//     estimator       takes its sample of the plant
//     battery         takes its sample of the plant
//     motor limits    takes the flags of the mixer's last run, before t
//     unit            stimulus; messages from estimator, battery, motor limits; step; mixer
//     actuators       the commands that have arrived are held until the next
//
// Each task has its own times. A task's result arrives after the task's delay; without a delay, at
// the unit's tick of the same instant. The LoopTiming has the times of the unit's ticks, of each
// tick's sample and of its command. It comes from the case or from a run on a real clock. Samples
// before t = 0 do not exist. Until the first estimate arrives, the unit gets the state of the
// flight's start. Until the first command arrives, the rotors turn as at the start.
#pragma once

#include <cstddef>
#include <optional>

#include "harness/casefile/case.hpp"
#include "harness/loop/estimator.hpp"
#include "harness/loop/plant_task.hpp"
#include "harness/loop/unit_task.hpp"
#include "harness/plant/plant.hpp"
#include "harness/port/port.hpp"
#include "harness/schedule/delay_line.hpp"
#include "harness/schedule/event_queue.hpp"
#include "harness/schedule/loop_timing.hpp"
#include "harness/trace/trace.hpp"

namespace attest {

struct FlightEnd {
  std::size_t ticks = 0;  // finished by the unit
  std::optional<PortFault> fault;
  std::optional<Divergence> divergence;
};

class ClosedLoop {
 public:
  // REQUIRES: a flight, which bound_to_vehicle() made (flight.hpp); a fresh plant and unit. All
  // outlive this.
  ClosedLoop(const Case& the_case, const Rate& rate, LoopTiming timing, const Vehicle& vehicle,
             Plant& plant, Unit& unit);

  // Flies to the end; records every tick into `trace` unless it is null. Allocates only for the
  // trace and for parameters that change. Call once.
  FlightEnd run(Trace* trace);

 private:
  void happens(const EventQueue::Event& event, Trace* trace);
  void unit_tick(const EventQueue::Event& event);
  void record(Trace& trace) const;
  bool is_over() const;

  LoopTiming timing_;
  std::size_t first_sampled_;  // the first tick with a sample
  PlantTask plant_;
  UnitTask unit_;
  NoisyEstimator estimator_;
  EventQueue event_queue_;

  DelayLine<Estimate> estimates_;
  DelayLine<float> battery_scales_;
  DelayLine<MotorLimits> limits_;
  DelayLine<MotorCommands> commands_;

  FlightEnd end_;
};

}  // namespace attest
