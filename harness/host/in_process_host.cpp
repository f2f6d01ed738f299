#include "harness/host/in_process_host.hpp"

#include <utility>

#include "harness/host/step_timer.hpp"
#include "harness/port/profiles.hpp"

namespace attest {

InProcessHost::InProcessHost(std::unique_ptr<Port> port, std::optional<Declarations> said,
                             Course course, const PortCalls* calls)
    : port_(std::move(port)),
      calls_(calls),
      noted_(calls ? calls->noted(*port_) : nullptr),
      declarations_(said ? *std::move(said) : Declarations::asked(*port_)),
      course_(course) {}

std::optional<PortFault> InProcessHost::held(std::optional<PortFault> fault,
                                             const std::string& profile) const {
  port_->finish();
  if (const std::string difference = change(declarations_, Declarations::asked(*port_));
      !difference.empty()) {
    return PortFault{PortFault::Kind::protocol, 0, difference};
  }
  return held_to(declarations_, profile, std::move(fault));
}

std::optional<PortFault> InProcessHost::drive(const ModuleUnderTest& subject, Trace& trace) {
  const bool begins = subject.part.first_tick == 0;
  return ports_.run([&] {
    if (begins) parts_.reset();  // the judge may have stopped in the middle of a trace
    if (!begins || !subject.part.is_last) return drive_part(subject, trace);
    return held(attest::drive(driven(), subject, trace), subject.profile);
  });
}

std::optional<PortFault> InProcessHost::drive_part(const ModuleUnderTest& subject, Trace& part) {
  const auto [first_tick, is_last] = subject.part;
  if (first_tick == 0) {
    auto unit = make_unit(driven(), subject);
    if (!unit) return held(unit.error(), subject.profile);
    parts_.emplace(*std::move(unit), subject.module);
  }
  auto fault = parts_->drive(part, first_tick);
  if (!fault && !is_last) return std::nullopt;
  parts_.reset();
  return held(std::move(fault), subject.profile);
}

Result<Flown> InProcessHost::fly(const FlightPlan& plan) {
  const Case& whole = *course_.the_case;
  return ports_.run([&]() -> Result<Flown> {
    const auto units = units_for(whole, driven());
    if (!units) {
      Flown none;
      if (whole.attitude_loop) none.attitude_trace.emplace();
      none.fault = held(units.error(), whole.profile);
      return none;
    }
    auto flown =
        attest::fly(plan.from_one_period_on ? whole.from_one_period_on() : whole,
                    plan.configuration, *course_.vehicle_model, units->for_flight(), plan.timing);
    if (flown) flown->fault = held(std::move(flown->fault), whole.profile);
    return flown;
  });
}

Result<LiveFlight> InProcessHost::fly_live(const LivePlan& plan, const LiveWatch& watch) {
  const Case& whole = *course_.the_case;
  return ports_.run([&] {
    Result<LiveFlight> flight = LiveFlight();
    std::optional<PortFault> refusal;
    if (const auto units = units_for(whole, driven())) {
      flight = attest::fly_live(whole, plan, *course_.vehicle_model, units->for_flight(),
                                calls_ ? calls_->watch() : watch);
    } else {
      refusal = units.error();
    }
    if (flight) flight->fault = held(std::move(refusal), whole.profile);
    return flight;
  });
}

Result<StepTimes> InProcessHost::time_steps(const ModuleUnderTest& subject, const Trace& inputs,
                                            bool with_stack) {
  if (declarations_.cost) return count_steps(subject, inputs);
  if (!clock_) clock_ = time_of_clock();
  StepTimes times;
  times.clock = *clock_;
  times.steps.reserve(inputs.samples.size());
  Trace trace = inputs;
  times.fault = ports_.run([&]() -> std::optional<PortFault> {
    const auto unit = make_unit(*port_, subject);
    if (!unit) return held(unit.error(), subject.profile);
    // `timed` is inside of the noted unit, so the time of a step does not include the note.
    std::unique_ptr<Unit> timed = std::make_unique<TimedUnit>(**unit, *clock_, times.steps);
    if (calls_) timed = calls_->noted(std::move(timed));
    return held(attest::drive(*timed, trace, subject.module), subject.profile);
  });
  if (!with_stack || times.fault) return times;
  if (auto measured = measure_stack(subject, std::move(trace), times); !measured) {
    return tl::unexpected(measured.error());
  }
  return times;
}

StepTimes InProcessHost::count_steps(const ModuleUnderTest& subject, const Trace& inputs) {
  StepTimes times;
  times.costs.reserve(inputs.samples.size());
  Trace trace = inputs;
  times.fault = ports_.run([&]() -> std::optional<PortFault> {
    const auto unit = make_unit(driven(), subject);
    if (!unit) return held(unit.error(), subject.profile);
    CountedUnit counted(**unit, times.costs);
    return held(attest::drive(counted, trace, subject.module), subject.profile);
  });
  return times;
}

Result<void> InProcessHost::measure_stack(const ModuleUnderTest& subject, Trace trace,
                                          StepTimes& times) {
  if (!stack_) {
    auto made = PaintedStack::make();
    if (!made) return tl::unexpected(made.error());
    stack_.emplace(*std::move(made));
  }
  times.fault = ports_.run([&]() -> std::optional<PortFault> {
    const auto unit = make_unit(*port_, subject);
    if (!unit) return held(unit.error(), subject.profile);
    stack_->repaint();
    UnitOnStack on_stack(**unit, *stack_);
    return held(attest::drive(on_stack, trace, subject.module), subject.profile);
  });
  if (!times.fault) times.stack_bytes = stack_->used();
  return {};
}

bool InProcessHost::supports(const std::string& profile) {
  return ports_.run([&] {
    const bool is_made = makes_any_of(driven(), profile);
    port_->finish();
    return is_made;
  });
}

Result<std::unique_ptr<PortHost>> open_in_process_host(const std::string& port,
                                                       std::optional<Declarations> said,
                                                       Course course, const PortCalls* calls,
                                                       const PortFiles* files) {
  const DefaultFloatEnvironment callers;  // a library may change it when it is loaded
  auto opened = open_port(port, files);
  if (!opened) return tl::unexpected(opened.error());
  return std::make_unique<InProcessHost>(*std::move(opened), std::move(said), course, calls);
}

}  // namespace attest
