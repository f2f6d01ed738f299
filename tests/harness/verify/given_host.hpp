// A host for HostOptions::start, whose answers and times the test gives.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "harness/host/port_process.hpp"

namespace attest {

// Returns the answers that the test gives. REQUIRES: the test gives an answer to each request.
class GivenHost final : public PortHost {
 public:
  struct Answers {
    Declarations says;
    std::function<std::optional<PortFault>(const ModuleUnderTest&, Trace&)> drive;
    std::function<Result<Flown>(const FlightPlan&)> fly;
    std::function<Result<StepTimes>(const ModuleUnderTest&, const Trace&, bool)> time_steps;
    std::function<bool()> is_spent = [] { return false; };
  };

  explicit GivenHost(Answers answers) : answers_(std::move(answers)) {}

  const Declarations& declarations() const override { return answers_.says; }
  std::optional<PortFault> drive(const ModuleUnderTest& subject, Trace& trace) override {
    return answers_.drive(subject, trace);
  }
  Result<Flown> fly(const FlightPlan& plan) override { return answers_.fly(plan); }
  Result<LiveFlight> fly_live(const LivePlan&, const LiveWatch&) override {
    return fail("no live flights");
  }
  Result<StepTimes> time_steps(const ModuleUnderTest& subject, const Trace& inputs,
                               bool with_stack) override {
    return answers_.time_steps(subject, inputs, with_stack);
  }
  bool supports(const std::string&) override { return true; }
  bool is_spent() const override { return answers_.is_spent(); }

 private:
  Answers answers_;
};

}  // namespace attest
