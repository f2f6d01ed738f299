// Where a port runs, and all that is asked of it: to be given a trace, to fly, to be timed. A judge
// sees a port through this only, and need not know in which process it is.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "harness/host/port_says.hpp"
#include "harness/loop/flight.hpp"
#include "harness/loop/open_loop.hpp"
#include "harness/schedule/loop_timing.hpp"

namespace attest {

// What a host flies: known when it starts. Both outlive the host.
struct Course {
  const Case* the_case = nullptr;
  const VehicleModel* vehicle_model = nullptr;
};

// One flight of a course.
struct FlightPlan {
  RunConfiguration configuration;
  LoopTiming timing;
  bool from_one_period_on = false;  // Case::from_one_period_on()
};

// How long each step of a trace took.
struct StepTimes {
  std::vector<Nanoseconds> steps;          // without what reading the clock takes
  Nanoseconds clock{0};                    // that
  std::optional<std::size_t> stack_bytes;  // the most that a step used, where that was asked
  std::optional<PortFault> fault;
};

// A PortFault of a port that died or fell silent is of kind crash or timeout. One thread at a time.
class PortHost {
 public:
  virtual ~PortHost() = default;

  // Before the first request, or before the run; the port is held to it: after a request for which
  // it said something else, that request ends with a fault of kind protocol.
  virtual const PortSays& says() const = 0;

  // As of open_loop.hpp, with a fresh instance.
  virtual std::optional<PortFault> drive(const Subject& subject, Trace& trace) = 0;

  // As of flight.hpp, with a fresh unit. REQUIRES: the host was started with a course.
  virtual Result<Flown> fly(const FlightPlan& plan) = 0;

  // As drive(), of a unit of `profile`, without its outputs. Errors: no memory for the stack.
  virtual Result<StepTimes> time_steps(const std::string& profile, const Trace& inputs,
                                       bool with_stack) = 0;

  // Whether the port makes a unit of that profile; also false of a port that went wrong.
  virtual bool supports(const std::string& profile) = 0;

  // It crashed or broke the protocol: further requests need a new host. One that was too late is
  // not asked again, and each further request ends with that fault.
  virtual bool is_spent() const { return false; }
};

}  // namespace attest
