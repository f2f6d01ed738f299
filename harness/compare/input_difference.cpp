#include "harness/compare/input_difference.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "harness/core/agreement.hpp"

namespace attest {
namespace {

constexpr const char* not_set = "not set";

// The timestamp is an input, too.
ChannelSet inputs_of(Module module) { return channels_of(module, "in/").set(timestamp_channel); }

std::string decimal(const Channel& channel, const Sample& sample) {
  if (channel.type == ChannelType::f32) return fmt::format("{}", float_of(channel, sample));
  return fmt::format("{:.0f}", value_of(channel, sample));
}

void set_all(std::span<const ParameterChange> changes, std::map<std::string, float>& values) {
  for (const ParameterChange& change : changes) values[change.name] = change.value;
}

}  // namespace

std::string text_of(const InputDifference& found, const std::string& one,
                    const std::string& other) {
  if (found.column.empty()) return "one trace is longer than the other";
  return fmt::format("{} is {} in {} and {} in {}", found.column, found.one, one, found.other,
                     other);
}

InputComparer::InputComparer(const ChannelSet& one, const ChannelSet& other, Compared compared)
    : compared_(compared), inputs_(inputs_of(module_of(one | other))) {
  if (compared_ == Compared::in_both) inputs_ &= one & other;
}

void InputComparer::add(const Trace& one, const Trace& other) {
  const bool say_profile = !one.profile.empty() && !other.profile.empty();
  if (tick_ == 0 && say_profile && one.profile != other.profile) {
    first_ = {0, "the profile", one.profile, other.profile};
  }
  PendingChanges changes_of_one(one.parameters), changes_of_other(other.parameters);
  const std::size_t common = std::min(one.samples.size(), other.samples.size());
  for (std::size_t i = 0; i < common && !first_; ++i, ++tick_) {
    const auto changes = changes_of_one.take_until(i);
    const auto other_changes = changes_of_other.take_until(i);
    set_all(changes, of_one_);
    set_all(other_changes, of_other_);
    compare_inputs(one.samples[i], other.samples[i]);
    if (!changes.empty() || !other_changes.empty()) compare_parameters();
  }
  if (!first_ && one.samples.size() != other.samples.size()) first_ = {tick_, "", "", ""};
}

void InputComparer::compare_inputs(const Sample& one, const Sample& other) {
  for (std::size_t i = inputs_._Find_first(); i < inputs_.size(); i = inputs_._Find_next(i)) {
    const Channel& channel = channels()[i];
    if (same_bits(channel, one, other)) continue;
    first_ = {tick_, std::string(channel.name), decimal(channel, one), decimal(channel, other)};
    return;
  }
}

void InputComparer::compare_parameters() {
  if (first_) return;
  const auto differ = [&](const std::string& name, const std::string& one,
                          const std::string& other) {
    first_ = {tick_, std::string(parameter_prefix) + name, one, other};
  };
  for (const auto& [name, value] : of_one_) {
    const auto other = of_other_.find(name);
    if (other == of_other_.end()) {
      if (compared_ == Compared::all) return differ(name, fmt::format("{}", value), not_set);
    } else if (!same_bits(value, other->second)) {
      return differ(name, fmt::format("{}", value), fmt::format("{}", other->second));
    }
  }
  if (compared_ == Compared::in_both) return;
  for (const auto& [name, value] : of_other_) {
    if (!of_one_.contains(name)) return differ(name, not_set, fmt::format("{}", value));
  }
}

std::optional<InputDifference> first_input_difference(const Trace& one, const Trace& other) {
  InputComparer comparer(one.present, other.present, InputComparer::Compared::all);
  comparer.add(one, other);
  return comparer.first();
}

}  // namespace attest
