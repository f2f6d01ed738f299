#include "harness/diagnosis/hunt_generator.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "harness/diagnosis/hunt_lacks.hpp"
#include "harness/diagnosis/hunt_trial.hpp"
#include "harness/diagnosis/hunt_values.hpp"
#include "harness/diagnosis/hunt_writer.hpp"
#include "harness/golden/recorded.hpp"

namespace attest {
namespace {

constexpr std::size_t least_ticks = 12, most_ticks = 300;
constexpr std::uint32_t quiet_stretch = 100'000;

HuntWindow window_in(std::size_t ticks, HuntRandom& random) {
  const std::size_t begin = random.below(ticks);
  return {begin, std::min(ticks, begin + random.skewed(1, ticks))};
}

// REQUIRES: a fixed step.
void choose_rate_of_port(const HuntTarget& target, HuntInputs& inputs) {
  inputs.rate = *target.fixed_step;
  inputs.start_us = static_cast<std::uint64_t>(inputs.rate.tick(1).count() / 1000);
}

void choose_times(const HuntTarget& target, HuntInputs& inputs, HuntRandom& random) {
  if (target.fixed_step) return choose_rate_of_port(target, inputs);
  const ModuleInfo& info = info_of(target.subject.module);
  if (info.default_rates_hz.empty()) {
    inputs.rate = random.one_of(standard_rates());
  } else {
    inputs.rate = Rate::hz(random.one_of(info.default_rates_hz));
  }
  if (!info.is_unit()) return;
  const auto period_us = static_cast<std::uint64_t>(inputs.rate.period_s() * 1e6);
  constexpr std::array<std::uint64_t, 5> starts = {0, 1U << 24, std::uint64_t{1} << 32, 60'000'000,
                                                   20'000};
  if (random.chance(0.6)) return;
  const std::uint64_t start = random.one_of(starts), before = random.below(40) * period_us;
  inputs.start_us = start > before ? start - before : start;
}

// Ticks that are left out, and stretches without news.
void choose_gaps(const HuntTarget& target, HuntInputs& inputs, HuntRandom& random) {
  const std::size_t ticks = inputs.ticks.size();
  const bool has_drops = info_of(target.subject.module).is_unit() && !target.fixed_step;
  if (has_drops && random.chance(0.2)) {
    const double drops = random.chance(0.5) ? 0.02 : 0.3;
    for (HuntTick& tick : inputs.ticks) {
      if (random.chance(drops)) tick.periods = static_cast<std::uint32_t>(random.skewed(2, 60));
    }
  }
  if (random.chance(0.12)) {
    inputs.ticks[random.below(ticks)].quiet = static_cast<std::uint32_t>(random.skewed(10, 1500));
  }
  if (random.chance(0.001)) inputs.ticks[random.below(ticks)].quiet = quiet_stretch;
}

// Recordings of the firmware show the rates of a recovery within 1e-5 rad/s, not to the bit.
bool is_left_out(const HuntTarget& target, std::string_view parameter) {
  return target.level == Level::exact && parameter == "VT_OPT_RECOV_EN";
}

void set_parameter(const HuntTarget& target, const Parameter& parameter, HuntInputs& inputs,
                   HuntRandom& random) {
  const std::string name(parameter.name);
  if (is_left_out(target, name)) return;
  std::erase_if(inputs.parameters,
                [&](const ParameterChange& change) { return change.name == name; });
  const auto set = [&](std::size_t tick) {
    ParameterChange change{tick, name, hunt_parameter(parameter, target.level, random)};
    if (check_parameter(target.subject, change)) inputs.parameters.push_back(std::move(change));
  };
  set(0);
  const bool may_change = info_of(target.subject.module).is_unit();
  const std::size_t tick = random.below(inputs.ticks.size());
  if (may_change && tick > 0 && random.chance(0.25)) set(tick);
}

void choose_parameters(const HuntTarget& target, HuntInputs& inputs, HuntRandom& random) {
  const ProfileInfo* const profile = find_profile(target.subject.profile);
  if (profile == nullptr) return;
  const double share = random.chance(0.3) ? 0 : random.chance(0.5) ? 0.1 : 0.6;
  for (const Parameter& parameter : parameters_of(target.subject.module, *profile)) {
    const bool is_cells = parameter.name == "BAT_N_CELLS";  // without it the scale is constant
    if (is_cells && random.chance(0.9)) {
      inputs.parameters.push_back({0, std::string(parameter.name), 3});
    } else if (random.chance(share)) {
      set_parameter(target, parameter, inputs, random);
    }
  }
}

// With the times of a port that has a fixed step.
void take_fixed_step(const HuntTarget& target, HuntInputs& inputs) {
  choose_rate_of_port(target, inputs);
  for (HuntTick& tick : inputs.ticks) {
    tick.periods = 1;
    for (const HuntTopic& topic : hunt_topics(target.subject.module)) {
      for (const Channel* time : topic.times) {
        if (time->field() == "timestamp_sample") set_relative_us(*time, tick.sample, 0);
      }
    }
  }
}

// NaN in a few fields; at the level exact also infinities and other extremes.
void add_extremes(const HuntTarget& target, HuntInputs& inputs, HuntRandom& random) {
  const auto topics = hunt_topics(target.subject.module);
  for (std::size_t count = 1 + random.below(3); count > 0; --count) {
    const HuntTopic& topic = topics[random.below(topics.size())];
    const Channel& field = *topic.fields[random.below(topic.fields.size())];
    if (field.type != ChannelType::f32) continue;
    const double value = target.level == Level::exact ? extreme_value(random) : std::nan("");
    const HuntWindow window = window_in(inputs.ticks.size(), random);
    const double share = random.chance(0.5) ? 1 : 0.1;
    for (std::size_t tick = window.begin; tick < window.end; ++tick) {
      if (random.chance(share)) set_value(field, inputs.ticks[tick].sample, value);
    }
  }
}

// At the level numeric, the step of the old rate law is at least 2 ms, as in its unit: the law
// divides by it.
void limit_step(const HuntTarget& target, HuntInputs& inputs) {
  const auto dt = find_channel(target.subject.module, "in/law.dt");
  const ProfileInfo* const profile = find_profile(target.subject.profile);
  const bool divides = profile != nullptr && contains(profile->modules, Module::mc_att_control);
  if (!dt || !divides || target.level == Level::exact) return;
  constexpr double least_s = 0.002;
  for (HuntTick& tick : inputs.ticks) {
    const double value = value_of(channels()[*dt], tick.sample);
    if (value < least_s) set_value(channels()[*dt], tick.sample, least_s);
  }
}

// The port can judge these inputs.
void make_possible(const HuntTarget& target, HuntInputs& inputs) {
  limit_step(target, inputs);
  make_orderly(target.lacks, inputs);
  leave_out_lacking(target.lacks, inputs);
  make_orderly(target.lacks, inputs);
}

HuntInputs fresh_trial(const HuntTarget& target, HuntRandom& random) {
  HuntInputs inputs;
  inputs.subject = target.subject;
  if (target.subject.module == Module::mixer) {
    constexpr std::array<const char*, 8> definitions = {
        "R: 4x 10000 10000 10000 0",    "R: 4+ 10000 10000 10000 0",
        "R: 4x 9000 9500 8000 1200",    "R: 6x 10000 10000 10000 0",
        "R: 8x 10000 10000 10000 0",    "R: 4+ 9000 14000 -12000 700",
        "R: 8x -11000 13000 8000 2100", "R: 6x 12000 -9000 15000 1200"};
    inputs.subject.mixer = random.one_of(definitions);
  }
  choose_times(target, inputs, random);
  inputs.ticks.resize(random.skewed(least_ticks, most_ticks));
  for (const HuntTopic& topic : hunt_topics(target.subject.module)) {
    write_topic(target, topic, {0, inputs.ticks.size()}, inputs, random);
  }
  choose_gaps(target, inputs, random);
  choose_parameters(target, inputs, random);
  const double extremes = target.level == Level::exact ? 0.4 : 0.06;
  if (random.chance(extremes)) add_extremes(target, inputs, random);
  return inputs;
}

void erase_ticks(const HuntWindow& window, HuntInputs& inputs) {
  if (window.begin == 0 || window.end - window.begin >= inputs.ticks.size()) return;
  const auto begin = inputs.ticks.begin();
  inputs.ticks.erase(begin + static_cast<std::ptrdiff_t>(window.begin),
                     begin + static_cast<std::ptrdiff_t>(window.end));
  for (ParameterChange& change : inputs.parameters) {
    if (change.tick >= window.end)
      change.tick -= window.end - window.begin;
    else if (change.tick > window.begin)
      change.tick = window.begin;
    change.tick = std::min(change.tick, inputs.ticks.size() - 1);
  }
}

void repeat_ticks(const HuntWindow& window, HuntInputs& inputs) {
  const std::vector<HuntTick> again(
      inputs.ticks.begin() + static_cast<std::ptrdiff_t>(window.begin),
      inputs.ticks.begin() + static_cast<std::ptrdiff_t>(window.end));
  if (inputs.ticks.size() + again.size() > 2 * most_ticks) return;
  inputs.ticks.insert(inputs.ticks.end(), again.begin(), again.end());
}

// One change of a trial that was kept.
void mutate(const HuntTarget& target, std::span<const HuntInputs> kept, HuntInputs& inputs,
            HuntRandom& random) {
  const auto topics = hunt_topics(target.subject.module);
  const HuntTopic& topic = topics[random.below(topics.size())];
  const HuntWindow window = window_in(inputs.ticks.size(), random);
  const Channel& field = *topic.fields[random.below(topic.fields.size())];
  switch (random.below(8)) {
    case 0:
      return write_topic(target, topic, window, inputs, random);
    case 1:
      return write_values(target, topic, window, inputs, random);
    case 2:
    case 3:
      if (field.quantity == Quantity::quaternion) return;
      return write_field(target, topic, field, window, inputs, random);
    case 4: {
      const HuntInputs& other = kept[random.below(kept.size())];
      for (std::size_t i = window.begin; i < std::min(window.end, other.ticks.size()); ++i) {
        topic.copy(other.ticks[i].sample, inputs.ticks[i].sample);
      }
      return;
    }
    case 5:
      return erase_ticks(window, inputs);
    case 6:
      return repeat_ticks(window, inputs);
    default:
      const ProfileInfo* const profile = find_profile(target.subject.profile);
      const auto parameters = profile != nullptr ? parameters_of(target.subject.module, *profile)
                                                 : std::vector<Parameter>();
      if (parameters.empty()) return;
      return set_parameter(target, parameters[random.below(parameters.size())], inputs, random);
  }
}

}  // namespace

HuntInputs make_trial(const HuntTarget& target, std::uint64_t seed, std::uint64_t trial,
                      std::span<const HuntInputs> kept) {
  HuntRandom random(seed, trial);
  HuntInputs inputs;
  if (kept.empty() || random.chance(0.5)) {
    inputs = fresh_trial(target, random);
  } else {
    // The later half was kept for rarer features.
    const std::size_t newer = random.chance(0.5) ? kept.size() / 2 : 0;
    inputs = kept[newer + random.below(kept.size() - newer)];
    for (std::size_t count = 1 + random.below(4); count > 0; --count) {
      mutate(target, kept, inputs, random);
    }
  }
  make_possible(target, inputs);
  return inputs;
}

HuntInputs fit_trial(const HuntTarget& target, HuntInputs inputs) {
  if (target.fixed_step) take_fixed_step(target, inputs);
  std::erase_if(inputs.parameters,
                [&](const ParameterChange& change) { return is_left_out(target, change.name); });
  make_possible(target, inputs);
  return inputs;
}

}  // namespace attest
