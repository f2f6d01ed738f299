#include "harness/host/smoke.hpp"

#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "harness/loop/open_loop.hpp"
#include "harness/trace/channels.hpp"

namespace attest {
namespace {

Trace shaken_vehicle(const Rate& rate) {
  Trace trace;
  trace.present = channels_of(Module::mc_att_control);
  for (std::size_t tick = 0; tick < smoke_steps; ++tick) {
    Sample sample{};
    sample.in.timestamp = timestamp_us(rate.tick(static_cast<std::int64_t>(tick) + 1));
    sample.in.control_state.q[0] = 1;
    // Any motion that changes the state of every axis.
    sample.in.control_state.roll_rate = 0.05f * (static_cast<float>(tick % 7) - 3);
    sample.in.control_state.pitch_rate = 0.04f * (static_cast<float>(tick % 5) - 2);
    sample.in.control_state.yaw_rate = 0.03f * (static_cast<float>(tick % 3) - 1);
    sample.in.vehicle_attitude_setpoint.q_d[0] = 1;
    sample.in.vehicle_attitude_setpoint.thrust = 0.5f;
    sample.in.vehicle_control_mode.flag_control_attitude_enabled = 1;
    sample.in.vehicle_control_mode.flag_control_rates_enabled = 1;
    sample.in.vehicle_status.is_rotary_wing = 1;
    sample.in.actuator_armed.armed = 1;
    sample.in.battery_status.scale = 1;
    trace.samples.push_back(sample);
  }
  // At the first step all topics are new; at the others only the state.
  for (const Channel& channel : channels()) {
    if (channel.type == ChannelType::bit) set_value(channel, trace.samples[0], 1);
  }
  return trace;
}

Trace without_numbers(Trace trace) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (Sample& sample : trace.samples) {
    for (float& q : sample.in.control_state.q) q = nan;
    sample.in.control_state.roll_rate = std::numeric_limits<float>::infinity();
    sample.in.control_state.yaw_rate = nan;
    sample.in.vehicle_attitude_setpoint.thrust = nan;
  }
  return trace;
}

// "out/vehicle_rates_setpoint.roll at tick 3 is 1, it was 2"; empty when the outputs have the same
// bits, or both are NaN.
std::string difference(const Trace& now, const Trace& before) {
  const ChannelSet outputs = channels_of(Module::mc_att_control, "out/");
  for (std::size_t tick = 0; tick < now.samples.size(); ++tick) {
    for (std::size_t i = 0; i < channels().size(); ++i) {
      const Channel& channel = channels()[i];
      if (!outputs[i] || !channel.is_output()) continue;
      const double is = value_of(channel, now.samples[tick]);
      const double was = value_of(channel, before.samples[tick]);
      if (is == was || (std::isnan(is) && std::isnan(was))) continue;
      return fmt::format("{} at tick {} is {:g}, it was {:g}", channel.name, tick, is, was);
    }
  }
  return "";
}

class Smoke {
 public:
  Smoke(const HostOptions& options, std::string profile,
        const std::function<void(const SmokeFinding&)>& report)
      : options_(options), profile_(std::move(profile)), report_(report) {}

  bool all() {
    auto started = start_host(options_);
    if (!started) return find("steps", "", started.error().to_string());
    host_ = *std::move(started);
    inputs_ = shaken_vehicle(host_->says().fixed_step.value_or(Rate::hz(250)));
    alone_ = inputs_;
    if (!steps() || !outputs() || !repeatable()) return false;
    // All of them, although one is bad.
    const bool parameters_are_good = parameters(), instances_are_good = instances();
    const bool takes_nan = nan();
    return parameters_are_good && instances_are_good && takes_nan;
  }

 private:
  bool find(const std::string& check, const std::string& what, const std::string& wrong) {
    const std::string whole = what.empty() ? wrong : what + (wrong.empty() ? "" : ": " + wrong);
    report_({check, whole, wrong.empty()});
    return wrong.empty();
  }

  // "step at tick 3 returned ATTEST_FAILED"; empty when the port took the whole trace, or does not
  // support it.
  std::string fault_with(Trace& trace, Instances instances = Instances::one) {
    if (auto ensured = ensure_host(host_, options_); !ensured) return ensured.error().to_string();
    Subject subject{profile_};
    subject.instances = instances;
    const auto fault = host_->drive(subject, trace);
    is_unsupported_ = fault && fault->kind == PortFault::Kind::unsupported;
    return fault && !is_unsupported_ ? fault->what : "";
  }

  bool steps() {
    return find("steps", fmt::format("{} of {}", smoke_steps, profile_), fault_with(alone_));
  }

  bool outputs() {
    if (is_unsupported_) return true;
    const attest_outputs& last = alone_.samples.back().out;
    std::string wrong;
    if (last.vehicle_rates_setpoint.published == 0) wrong = "vehicle_rates_setpoint";
    if (last.actuator_controls_0.published == 0) wrong = "actuator_controls_0";
    if (!wrong.empty()) {
      wrong +=
          " is not published although attitude and rate control are enabled, and "
          "vehicle_status had a sample";
    }
    for (const float control : last.actuator_controls_0.control) {
      if (!std::isfinite(control)) wrong = "actuator_controls_0.control is not finite";
    }
    return find("outputs", "rates setpoint and controls of " + profile_, wrong);
  }

  bool repeatable() {
    if (is_unsupported_) return true;
    host_ = nullptr;
    Trace again = inputs_;
    std::string wrong = fault_with(again);
    if (wrong.empty()) wrong = difference(again, alone_);
    return find("repeatable", "a second process gives the same bits", wrong);
  }

  bool parameters() {
    Trace known = inputs_, unknown = inputs_;
    known.parameters = {{0, "MC_ROLL_P", 6.5f}};
    unknown.parameters = {{0, "MC_NO_SUCH_NAME", 1}};
    const std::string wrong = fault_with(known);
    const bool takes_any = wrong.empty() && fault_with(unknown).empty() && !is_unsupported_;
    return find("parameters",
                takes_any ? "MC_ROLL_P is accepted, but so is MC_NO_SUCH_NAME: return "
                            "ATTEST_INVALID, so that a misspelled name is noticed"
                          : "MC_ROLL_P is accepted, an unknown name is not",
                wrong);
  }

  bool instances() {
    std::string wrong, what = "after another one";
    for (const Instances company : {Instances::again, Instances::together}) {
      Trace trace = inputs_;
      wrong = fault_with(trace, company);
      if (wrong.empty() && !is_unsupported_) wrong = difference(trace, alone_);
      if (!wrong.empty()) break;
      if (company == Instances::together)
        what += is_unsupported_ ? "; one at a time" : ", and together with one";
    }
    return find("instances", "a unit gives the same bits " + what, wrong);
  }

  bool nan() {
    Trace trace = without_numbers(inputs_);
    return find("NaN", "inputs that are no numbers end no step", fault_with(trace));
  }

  const HostOptions& options_;
  std::string profile_;
  const std::function<void(const SmokeFinding&)>& report_;
  std::unique_ptr<PortHost> host_;
  Trace inputs_, alone_;
  bool is_unsupported_ = false;  // the trace before
};

}  // namespace

bool smoke(const HostOptions& options, const std::string& profile,
           const std::function<void(const SmokeFinding&)>& report) {
  return Smoke(options, profile, report).all();
}

}  // namespace attest
