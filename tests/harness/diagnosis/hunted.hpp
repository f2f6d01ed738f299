// Ports that are hunted: the reference with changed answers, in this process.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "harness/diagnosis/hunt.hpp"
#include "harness/golden/reference.hpp"
#include "harness/host/in_process_host.hpp"
#include "harness/port/fault_port.hpp"

namespace attest {

// Changes the trace that the reference has answered, or gives a fault in its place.
using ChangeAnswer = std::function<std::optional<PortFault>(const ModuleUnderTest&, Trace&)>;

class ChangedHost final : public PortHost {
 public:
  ChangedHost(std::unique_ptr<PortHost> law, Declarations said, ChangeAnswer change)
      : law_(std::move(law)), said_(std::move(said)), change_(std::move(change)) {}

  const Declarations& declarations() const override { return said_; }
  std::optional<PortFault> drive(const ModuleUnderTest& subject, Trace& trace) override {
    if (auto fault = law_->drive(subject, trace)) return fault;
    return change_(subject, trace);
  }
  Result<Flown> fly(const FlightPlan& plan) override { return law_->fly(plan); }
  Result<LiveFlight> fly_live(const LivePlan& plan, const LiveWatch& watch) override {
    return law_->fly_live(plan, watch);
  }
  Result<StepTimes> time_steps(const ModuleUnderTest& subject, const Trace& inputs,
                               bool with_stack) override {
    return law_->time_steps(subject, inputs, with_stack);
  }
  bool supports(const std::string& profile) override { return law_->supports(profile); }

 private:
  std::unique_ptr<PortHost> law_;
  Declarations said_;
  ChangeAnswer change_;
};

// A round of a program has 128 trials, fewer than that of a library.
inline HostOptions host_of_law(std::function<std::unique_ptr<PortHost>()> law,
                               ChangeAnswer change) {
  HostOptions options;
  options.port = "proc:test";
  options.in_process = true;
  options.said = Declarations{"hunted", "1", {}, {}, {}, {}, ModuleSet().set(), {}};
  options.start = [said = *options.said, law, change](const HostOptions&, const Course&) {
    return std::make_unique<ChangedHost>(law(), said, change);
  };
  return options;
}

inline HostOptions changed_host(ChangeAnswer change, Precision precision = Precision::binary32) {
  return host_of_law([precision] { return open_reference({}, precision); }, std::move(change));
}

// `faults`: "cascade-d-reversed", or several with `+` between them.
inline HostOptions fault_host(const std::string& faults) {
  return host_of_law(
      [faults]() -> std::unique_ptr<PortHost> {
        return std::make_unique<InProcessHost>(*open_fault(faults));
      },
      [](const ModuleUnderTest&, Trace&) { return std::nullopt; });
}

// One round, unless `least_steps` is changed.
inline HuntOptions hunted(std::vector<ModuleUnderTest> subjects) {
  HuntOptions options;
  options.subjects = std::move(subjects);
  options.least_steps = 1;
  return options;
}

inline HuntOptions of_rate_unit() { return hunted({{"px4-v1.16.0", Module::rate_unit}}); }

inline HuntRun found_by(const HuntOptions& options, const HostOptions& host) {
  auto found = hunt(options, host);
  EXPECT_TRUE(found) << found.error().to_string();
  return found ? *std::move(found) : HuntRun();
}

inline std::vector<std::string> names_of(const HuntRun& run) {
  std::vector<std::string> names;
  for (const HuntFinding& finding : run.findings) names.push_back(finding.name);
  return names;
}

}  // namespace attest
