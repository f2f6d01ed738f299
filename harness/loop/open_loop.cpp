#include "harness/loop/open_loop.hpp"

#include <algorithm>
#include <memory>
#include <span>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "harness/port/profiles.hpp"

namespace attest {
namespace {

// A unit on its way through a trace.
class Drive {
 public:
  Drive(Unit& unit, Module module, Trace& trace)
      : driver_(unit, module),
        max_batch_(unit.max_batch()),
        trace_(trace),
        changes_(trace.parameters) {}

  bool is_over() const { return tick_ == trace_.samples.size(); }

  std::optional<PortFault> step() {
    auto fault = driver_.step(tick_, changes_.take_until(tick_), trace_.samples[tick_]);
    ++tick_;
    return fault;
  }

  // As many steps as the unit takes at once: up to the next change of a parameter.
  std::optional<PortFault> advance() {
    if (max_batch_ == 0) return step();
    const auto due = changes_.take_until(tick_);
    const std::size_t end =
        std::min({tick_ + max_batch_, changes_.next_tick(), trace_.samples.size()});
    auto fault = driver_.batch(tick_, due, std::span(trace_.samples).subspan(tick_, end - tick_));
    tick_ = end;
    return fault;
  }

 private:
  UnitDriver driver_;
  std::size_t max_batch_;
  Trace& trace_;
  PendingChanges changes_;
  std::size_t tick_ = 0;
};

// Parameters of the module that a trace may leave at their default.
std::vector<std::string> some_gains(Module module) {
  switch (module) {
    case Module::mc_att_control:
      return {"MC_PITCH_P", "MC_YAW_P", "MC_ROLLRATE_P", "MC_PITCHRATE_D"};
    case Module::attitude_unit:
      return {"MC_PITCH_P", "MC_YAW_P"};
    case Module::rate_unit:
      return {"MC_ROLLRATE_P", "MC_PITCHRATE_D"};
    case Module::mixer:
    case Module::battery_status:
      break;
  }
  return {};
}

// Other gains from the first step on: those of the trace, and some that it leaves at their default.
void change_gains(Trace& trace, Module module) {
  constexpr float factor = 0.75f;
  if (!info_of(module).has_updated) return;
  for (ParameterChange& change : trace.parameters) {
    const bool is_gain =
        change.name.starts_with("MC_") && !is_integer_parameter(module, change.name);
    if (is_gain) change.value *= factor;
  }
  for (const std::string& name : some_gains(module)) {
    const auto is_it = [&](const ParameterChange& change) { return change.name == name; };
    if (std::any_of(trace.parameters.begin(), trace.parameters.end(), is_it)) continue;
    trace.parameters.insert(trace.parameters.begin(), {0, name, 1.0f});
  }
}

double mirrored(const Channel& channel, double value) {
  switch (channel.quantity) {
    case Quantity::rate:
    case Quantity::angular_acceleration:
      return -value;
    case Quantity::quaternion:
      return channel.name.ends_with("[0]") ? value : -value;
    case Quantity::control:
      return 1 - value;
    case Quantity::voltage:
      return 0.9 * value;
    default:
      return channel.name.ends_with(".flag_armed") ? 1 - value : value;
  }
}

// Other inputs at the same times, and other gains, so that the states of two instances differ in
// everything.
Trace mirrored(Trace trace, Module module) {
  change_gains(trace, module);
  const ChannelSet inputs = channels_of(module, "in/");
  for (std::size_t i = 0; i < channels().size(); ++i) {
    const Channel& channel = channels()[i];
    if (!inputs[i] || channel.type == ChannelType::u64) continue;
    for (Sample& sample : trace.samples) {
      set_value(channel, sample, mirrored(channel, value_of(channel, sample)));
    }
  }
  return trace;
}

std::optional<PortFault> drive_alternately(Unit& judged, Trace& trace, Unit& other, Trace& of_other,
                                           Module module) {
  Drive drive(judged, module, trace), along(other, module, of_other);
  while (!drive.is_over()) {
    if (auto fault = along.step()) return fault;
    if (auto fault = drive.step()) return fault;
  }
  return std::nullopt;
}

PortFault makes_only_one() {
  return {PortFault::Kind::unsupported, 0,
          "the port makes no second instance while it has one: create() returned NULL"};
}

PortFault makes_no_other() {
  return {
      PortFault::Kind::protocol, 0,
      "create() returned NULL after the first instance was destroyed; create() is always legal"};
}

// `create` makes a fresh instance.
template <typename Create>
std::optional<PortFault> drive_in_company(std::unique_ptr<Unit> first, Create create,
                                          const Subject& subject, Trace& trace) {
  const auto& [instances, module] = std::tie(subject.instances, subject.module);
  Trace of_first = mirrored(trace, module);
  // After a fault of the first instance, the judged trace has no outputs.
  const auto drive_first = [&] {
    auto fault = drive(*first, of_first, subject.module);
    if (fault) fault->tick = 0;
    return fault;
  };
  if (instances == Instances::again) {
    if (auto fault = drive_first()) return fault;
    first.reset();
  }
  const std::unique_ptr<Unit> judged = create();
  if (!judged) return instances == Instances::again ? makes_no_other() : makes_only_one();
  if (instances == Instances::together) {
    return drive_alternately(*judged, trace, *first, of_first, module);
  }
  if (instances == Instances::crossed) {
    if (auto fault = drive_first()) return fault;
    first.reset();
  }
  return drive(*judged, trace, module);
}

PortFault no_profile(const Subject& subject) {
  return {PortFault::Kind::profile, 0,
          fmt::format("the port does not support profile {}", subject.profile)};
}

// A port that has no module of a profile does not support the profile.
PortFault lacks_module(const Port& port, const Subject& subject) {
  const ModuleInfo& info = info_of(subject.module);
  const ProfileInfo* const profile = find_profile(subject.profile);
  const bool has_another = profile && (profile->modules & port.modules()).any();
  if (!info.extension || (profile && !has_another)) return no_profile(subject);
  return {PortFault::Kind::unsupported, 0,
          fmt::format("the port has no {} (extension {})", info.title, info.extension)};
}

PortFault makes_none(const Subject& subject) {
  if (subject.module == Module::mixer) {
    return {
        PortFault::Kind::unsupported, 0,
        fmt::format("the port makes no mixer `{}` of profile {}", subject.mixer, subject.profile)};
  }
  return no_profile(subject);
}

}  // namespace

std::optional<PortFault> drive(Unit& unit, Trace& trace, Module module) {
  Drive drive(unit, module, trace);
  while (!drive.is_over()) {
    if (auto fault = drive.advance()) return fault;
  }
  return std::nullopt;
}

Subject subject_of(const Case& the_case) {
  return {the_case.profile, the_case.module, the_case.mixer, the_case.instances};
}

std::optional<PortFault> drive(Port& port, const Subject& subject, Trace& trace) {
  if (!contains(port.modules(), subject.module)) return lacks_module(port, subject);
  const auto create = [&] {
    return port.create_unit(subject.module, subject.profile, subject.mixer);
  };
  auto unit = create();
  if (!unit) return makes_none(subject);
  if (subject.instances == Instances::one) return drive(*unit, trace, subject.module);
  return drive_in_company(std::move(unit), create, subject, trace);
}

}  // namespace attest
