#include "harness/loop/other_instance.hpp"

#include <algorithm>
#include <cmath>

#include "harness/port/profiles.hpp"

namespace attest {
namespace {

std::vector<Parameter> parameters_of(Module module, const std::string& profile) {
  const ProfileInfo* const known = find_profile(profile);
  return known ? attest::parameters_of(module, *known) : std::vector<Parameter>{};
}

// An integer parameter is a switch: the law distinguishes its bounds, but not always values
// between.
float other_value(const Parameter& parameter, float value) {
  if (parameter.is_integer) return value == parameter.max ? parameter.min : parameter.max;
  return value == 0 ? 0.25f : 0.75f * value;
}

void change_parameters(Trace& trace, const std::vector<Parameter>& known) {
  for (ParameterChange& change : trace.parameters) {
    const auto is_it = [&](const Parameter& parameter) { return parameter.name == change.name; };
    const auto found = std::find_if(known.begin(), known.end(), is_it);
    if (found != known.end()) change.value = other_value(*found, change.value);
  }
}

// With the other sign, and with another absolute value, also for 0.
double of_another_size(double value) { return -0.6 * value + 0.07; }

double other_value(const Channel& channel, double value, bool is_even_tick) {
  constexpr double later_us = 1000;  // if the time is shared, the judged dt is wrong by this
  switch (channel.quantity) {
    case Quantity::time:
      return value + later_us;
    case Quantity::flag:
      if (channel.type == ChannelType::bit) return 1;
      return is_even_tick ? (value == 0 ? 1 : 0) : value;
    case Quantity::count:
      return std::fmod(value + 1, 256);
    case Quantity::rate:
    case Quantity::angular_acceleration:
    case Quantity::angle:
    case Quantity::stick:
      return of_another_size(value);
    case Quantity::quaternion:
      return channel.name.ends_with("[0]") ? value : of_another_size(value);
    case Quantity::control:
    case Quantity::motor:
      return 1 - value;
    case Quantity::thrust:
      return 0.75 * value;
    case Quantity::duration:
    case Quantity::integral:
    case Quantity::scale:
    case Quantity::voltage:
    case Quantity::current:
      return 0.9 * value;
  }
  return value;
}

}  // namespace

Trace other_inputs(Trace judged, Module module, const std::string& profile) {
  change_parameters(judged, parameters_of(module, profile));
  const ChannelSet inputs = channels_of(module, "in/") | channels_of(module, "timestamp");
  for (std::size_t i = 0; i < channels().size(); ++i) {
    const Channel& channel = channels()[i];
    if (!inputs[i]) continue;
    for (std::size_t tick = 0; tick < judged.samples.size(); ++tick) {
      Sample& sample = judged.samples[tick];
      set_value(channel, sample, other_value(channel, value_of(channel, sample), tick % 2 == 0));
    }
  }
  return judged;
}

std::vector<ParameterChange> other_defaults(const Trace& judged, Module module,
                                            const std::string& profile) {
  std::vector<ParameterChange> changes;
  for (const Parameter& parameter : parameters_of(module, profile)) {
    const auto sets_it = [&](const ParameterChange& change) {
      return change.tick == 0 && change.name == parameter.name;
    };
    if (std::any_of(judged.parameters.begin(), judged.parameters.end(), sets_it)) continue;
    changes.push_back(
        {0, std::string(parameter.name), other_value(parameter, parameter.default_value)});
  }
  return changes;
}

}  // namespace attest
