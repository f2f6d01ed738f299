// A host in this process: no protection against a port that crashes or hangs, and full speed.
#pragma once

#include <memory>
#include <optional>

#include "harness/core/float_environment.hpp"
#include "harness/host/port_calls.hpp"
#include "harness/host/port_host.hpp"
#include "harness/port/port_files.hpp"
#include "harness/realtime/painted_stack.hpp"

namespace attest {

class InProcessHost final : public PortHost {
 public:
  // `said`: the port's declarations before the run, which must stay the same. Empty: its
  // declarations now. `calls`: where the port's calls are noted, and from where fly_live() is
  // watched; outlives this. Null: the calls are not noted.
  InProcessHost(std::unique_ptr<Port> port, std::optional<Declarations> said = {},
                Course course = {}, const PortCalls* calls = nullptr);

  const Declarations& declarations() const override { return declarations_; }
  std::optional<PortFault> drive(const ModuleUnderTest& subject, Trace& trace) override;
  Result<Flown> fly(const FlightPlan& plan) override;
  Result<LiveFlight> fly_live(const LivePlan& plan, const LiveWatch& watch) override;
  Result<StepTimes> time_steps(const ModuleUnderTest& subject, const Trace& inputs,
                               bool with_stack) override;
  bool supports(const std::string& profile) override;

 private:
  // Returns `fault`, or a fault of kind protocol if the port's declarations have changed. Throws
  // PortBroke if a program broke the protocol in destroy().
  std::optional<PortFault> held(std::optional<PortFault> fault, const std::string& profile) const;
  Port& driven() { return noted_ ? *noted_ : *port_; }
  std::optional<PortFault> drive_part(const ModuleUnderTest& subject, Trace& part);
  StepTimes count_steps(const ModuleUnderTest& subject, const Trace& inputs);
  Result<void> measure_stack(const ModuleUnderTest& subject, Trace trace, StepTimes& times);

  std::unique_ptr<Port> port_;
  const PortCalls* calls_;
  std::unique_ptr<Port> noted_;      // port_, with its calls noted; null without calls_
  std::optional<PartDriver> parts_;  // of a trace of which further parts follow
  PortFloatEnvironment ports_;
  Declarations declarations_;
  Course course_;
  std::optional<Nanoseconds> clock_;
  std::optional<PaintedStack> stack_;
};

// Opens the port with open_port(port, files). A change that the port makes to the floating point
// environment while it is loaded does not reach the caller. The other arguments are those of
// InProcessHost. Errors: those of open_port().
Result<std::unique_ptr<PortHost>> open_in_process_host(const std::string& port,
                                                       std::optional<Declarations> said = {},
                                                       Course course = {},
                                                       const PortCalls* calls = nullptr,
                                                       const PortFiles* files = nullptr);

}  // namespace attest
