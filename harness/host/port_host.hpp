// A running port, and the requests to it: take a trace, fly, fly in real time, be timed. A judge
// uses a port through this interface only: in another process, in its own process, or recorded in
// files.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "harness/core/loop_timing.hpp"
#include "harness/host/declarations.hpp"
#include "harness/loop/case_timing.hpp"
#include "harness/loop/flight.hpp"
#include "harness/loop/open_loop.hpp"
#include "harness/realtime/live_flight.hpp"

namespace attest {

// The case and the vehicle that a host flies, given when it starts. Both outlive the host.
struct Course {
  const Case* the_case = nullptr;
  const VehicleModel* vehicle_model = nullptr;
};

struct FlightPlan {
  RunConfiguration configuration;
  FlightTiming timing;
  bool from_one_period_on = false;  // Case::from_one_period_on()

  // With the times that the case schedules.
  static FlightPlan as_scheduled(const Case& the_case, const RunConfiguration& configuration) {
    return {configuration, flight_timing(the_case, configuration.rate)};
  }
};

struct StepTimes {
  std::vector<Nanoseconds> steps;          // without the time of reading the clock
  Nanoseconds clock{0};                    // the time of reading the clock
  std::optional<std::size_t> stack_bytes;  // the most that a step used; empty unless requested
  // Of a port that counts its cost (Declarations::cost): of each step. The rest is then empty, and
  // the host's clock is not read.
  std::vector<StepCost> costs = {};
  std::optional<PortFault> fault;
};

// If the port's process dies or does not answer in time, the PortFault is of kind crash or timeout.
// For one thread at a time.
class PortHost {
 public:
  virtual ~PortHost() = default;

  // The port's declarations, made before the first request or before the run. If they change during
  // a request, that request ends with a fault of kind protocol.
  virtual const Declarations& declarations() const = 0;

  // Same as drive() of open_loop.hpp, with a fresh instance. If `trace` is a part of a longer one
  // (ModuleUnderTest::part), its first part makes the instance, and its other parts continue with
  // it.
  virtual std::optional<PortFault> drive(const ModuleUnderTest& subject, Trace& trace) = 0;

  // Same as fly() of flight.hpp, with fresh units. REQUIRES: the host was started with a course.
  virtual Result<Flown> fly(const FlightPlan& plan) = 0;

  // Same as fly_live() of live_flight.hpp, with fresh units. If `watch` stops it, the result is the
  // flight so far. REQUIRES: same as fly().
  virtual Result<LiveFlight> fly_live(const LivePlan& plan, const LiveWatch& watch) = 0;

  // Same as drive(), but measures each step, discards the outputs, and ignores subject.instances.
  // Errors: no memory for the stack.
  virtual Result<StepTimes> time_steps(const ModuleUnderTest& subject, const Trace& inputs,
                                       bool with_stack) = 0;

  // The CPU time of the port's process so far, as the judge sees it. Empty without such a process.
  virtual std::optional<Nanoseconds> cpu_time() const { return std::nullopt; }

  // The last line that the port printed in the last trace or flight, or that of its panic. Empty:
  // it printed nothing, or it does not run in a process of its own.
  virtual std::string last_words() const { return ""; }

  // Whether the port makes a unit of that profile; also false after a fault of the port.
  virtual bool supports(const std::string& profile) = 0;

  // True after a crash or a broken protocol: further requests need a new host. False after a
  // timeout: the port gets no more requests, and each further request ends with a fault of kind
  // timeout.
  virtual bool is_spent() const { return false; }
};

}  // namespace attest
