#include "harness/host/smoke.hpp"

#include <limits>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/host/smoke_inputs.hpp"
#include "harness/loop/open_loop.hpp"
#include "harness/port/profiles.hpp"
#include "harness/trace/channels.hpp"

namespace attest {
namespace {

// "out/vehicle_rates_setpoint.roll at tick 3 is 1, it was 2"; empty when all outputs are equal. NaN
// equals NaN.
std::string difference(const Trace& now, const Trace& before, Module module) {
  const ChannelSet outputs = channels_of(module, "out/");
  for (std::size_t tick = 0; tick < now.samples.size(); ++tick) {
    for (std::size_t i = 0; i < channels().size(); ++i) {
      const Channel& channel = channels()[i];
      if (!outputs[i]) continue;
      if (same_bits(channel, now.samples[tick], before.samples[tick])) continue;
      return fmt::format("{} at tick {} is {:g}, it was {:g}", channel.name, tick,
                         value_of(channel, now.samples[tick]),
                         value_of(channel, before.samples[tick]));
    }
  }
  return "";
}

class Smoke {
 public:
  Smoke(const HostOptions& options, const std::string& profile, Module module,
        const std::function<void(const SmokeFinding&)>& report)
      : options_(options), subject_{profile, module}, report_(report) {
    const bool is_controller = module == Module::mc_att_control;
    name_ = is_controller ? profile : fmt::format("{} of {}", info_of(module).title, profile);
  }

  bool all() {
    auto started = start_host(options_);
    if (!started) return find("steps", "", started.error().to_string());
    host_ = *std::move(started);
    const Rate rate = host_->declarations().fixed_step.value_or(Rate::hz(250));
    inputs_ = shaken_vehicle(subject_.module, rate, smoke_steps);
    alone_ = inputs_;
    if (!steps()) return false;
    if (!unsupported_.empty()) return true;
    if (!outputs() || !repeatable()) return false;
    // All three checks run, even if one is bad.
    const bool parameters_are_good = parameters(), instances_are_good = instances();
    const bool takes_nan = nan();
    return parameters_are_good && instances_are_good && takes_nan;
  }

 private:
  bool find(const std::string& check, const std::string& what, const std::string& wrong,
            bool is_remark = false) {
    const std::string whole = what.empty() ? wrong : what + (wrong.empty() ? "" : ": " + wrong);
    report_({check, whole, wrong.empty(), is_remark && wrong.empty()});
    return wrong.empty();
  }

  // "step at tick 3 returned ATTEST_FAILED"; empty when the port made all steps, or does not
  // support the trace: then unsupported_ has the reason.
  std::string fault_with(Trace& trace, Instances instances = Instances::one) {
    if (auto ensured = ensure_host(host_, options_); !ensured) return ensured.error().to_string();
    ModuleUnderTest subject = subject_;
    subject.instances = instances;
    const auto fault = host_->drive(subject, trace);
    using enum PortFault::Kind;
    const bool is_unsupported = fault && (fault->kind == module || fault->kind == unsupported);
    unsupported_ = is_unsupported ? fault->what : "";
    return fault && !is_unsupported ? fault->what : "";
  }

  bool steps() {
    const std::string wrong = fault_with(alone_);
    const std::string what = fmt::format("{} of {}", smoke_steps, name_);
    const bool is_supported = unsupported_.empty();
    return find("steps", is_supported ? what : "unsupported: " + unsupported_, wrong,
                !is_supported);
  }

  bool outputs() {
    const std::vector<std::string> topics = expected_topics(subject_.module);
    std::string wrong;
    for (const std::string& topic : topics) {
      if (wrong.empty()) wrong = wrong_topic(topic);
    }
    return find("outputs", fmt::format("{} of {}", fmt::join(topics, ", "), name_), wrong);
  }

  // "vehicle_rates_setpoint is not published although ..."; empty if it is published, with numbers.
  std::string wrong_topic(const std::string& topic) {
    const Sample& last = alone_.samples.back();
    const ChannelSet fields = channels_of(subject_.module, fmt::format("out/{}.", topic));
    for (std::size_t i = 0; i < channels().size(); ++i) {
      const Channel& channel = channels()[i];
      if (!fields[i]) continue;
      const double value = value_of(channel, last);
      if (!std::isfinite(value)) return fmt::format("{} is not finite", channel.name);
      if (channel.quantity != Quantity::flag || value != 0) continue;
      return fmt::format(
          "{} is not published although every topic had a sample, and its control is enabled",
          topic);
    }
    return "";
  }

  bool repeatable() {
    host_ = nullptr;
    Trace again = inputs_;
    std::string wrong = fault_with(again);
    if (wrong.empty()) wrong = difference(again, alone_, subject_.module);
    return find("repeatable", "a second process gives the same bits", wrong);
  }

  bool parameters() {
    if (info_of(subject_.module).is_law()) return true;  // it has none
    Trace known = inputs_, unknown = inputs_;
    const std::string name = known_parameter(subject_.module);
    known.parameters = {{0, name, 0.5f}};
    unknown.parameters = {{0, "MC_NO_SUCH_NAME", 1}};
    const std::string wrong = fault_with(known);
    const bool takes_any = wrong.empty() && fault_with(unknown).empty() && unsupported_.empty();
    const std::string finding =
        takes_any ? "but so is MC_NO_SUCH_NAME: return ATTEST_INVALID, so that a misspelled name "
                    "is noticed"
                  : "an unknown name is not";
    return find("parameters", fmt::format("{} is accepted, {}", name, finding), wrong, takes_any);
  }

  bool instances() {
    std::string wrong, what = "after another one";
    bool is_one_at_a_time = false;
    for (const Instances company : {Instances::again, Instances::together}) {
      Trace trace = inputs_;
      wrong = fault_with(trace, company);
      if (wrong.empty() && unsupported_.empty()) wrong = difference(trace, alone_, subject_.module);
      if (!wrong.empty()) break;
      if (company != Instances::together) continue;
      is_one_at_a_time = !unsupported_.empty();
      what += is_one_at_a_time ? "; one at a time" : ", and together with one";
    }
    return find("instances", "a unit gives the same bits " + what, wrong, is_one_at_a_time);
  }

  bool nan() {
    Trace trace = without_numbers(inputs_, subject_.module);
    return find("NaN", "inputs that are no numbers end no step", fault_with(trace));
  }

  const HostOptions& options_;
  ModuleUnderTest subject_;
  std::string name_;  // "px4-v1.5.5", "rate unit of px4-v1.16.0"
  const std::function<void(const SmokeFinding&)>& report_;
  std::unique_ptr<PortHost> host_;
  Trace inputs_, alone_;
  std::string unsupported_;  // why the port does not support the last trace; empty if it does
};

}  // namespace

bool smoke(const HostOptions& options, const std::string& profile,
           const std::function<void(const SmokeFinding&)>& report) {
  const auto host = start_host(options);
  if (!host) {
    report({"steps", host.error().to_string(), false});
    return false;
  }
  const ProfileInfo* const known = find_profile(profile);
  ModuleSet own = only(Module::mc_att_control);
  if (known) own = known->modules & (*host)->declarations().modules;
  bool is_good = true;
  for (const ModuleInfo& info : modules()) {
    if (!contains(own, info.module) || !info.has_law()) continue;
    is_good = Smoke(options, profile, info.module, report).all() && is_good;
  }
  return is_good;
}

}  // namespace attest
