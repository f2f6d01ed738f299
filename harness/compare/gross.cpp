#include "harness/compare/gross.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <fmt/format.h>

#include "harness/compare/followed_setpoint.hpp"
#include "harness/trace/output_topics.hpp"

namespace attest {
namespace {

// The floor of the slack. For comparison: by default integrals are limited to 0.3, controls to 1.
double floor_of(Quantity quantity) {
  switch (quantity) {
    case Quantity::rate:
      return 0.1;  // rad/s
    case Quantity::integral:
      return 0.02;
    default:
      return 0.05;
  }
}

std::vector<std::size_t> float_outputs_of(const Trace& got, const Trace& want) {
  std::vector<std::size_t> chosen = outputs_by_stage(got.present & want.present);
  std::erase_if(chosen, [](std::size_t i) { return channels()[i].type != ChannelType::f32; });
  return chosen;
}

// Marks the ticks at which the law controls the attitude and either the error is near a half turn,
// where the direction of rotation changes, or attitude or setpoint is zero or not finite.
std::vector<bool> half_turns_in(const Trace& want) {
  constexpr double near_rad = 0.2;  // 11 deg short of a half turn
  const Module module = module_of(want.present);
  std::vector<bool> is_half_turn(want.samples.size());
  if (!follows_attitude(module)) return is_half_turn;
  FollowedSetpoint setpoint(module);
  for (std::size_t tick = 0; tick < want.samples.size(); ++tick) {
    const Sample& sample = want.samples[tick];
    setpoint.next(sample);
    const double error = attitude_error(attitude_at(sample, module), setpoint.q_d());
    // Written so that a NaN error is near.
    is_half_turn[tick] =
        uses_attitude_law(sample, module) && !(error <= std::numbers::pi - near_rad);
  }
  return is_half_turn;
}

struct Bounds {
  double low = 0, high = 0;
  bool hold(double value) const { return value >= low && value <= high; }
};

// Empty where one of the three values is not finite or not published.
std::optional<Bounds> bounds_at(const Trace& want, std::size_t tick, const Channel& channel) {
  std::array<double, 3> values{};
  for (std::size_t i = 0; i < 3; ++i) {
    const Sample& sample = want.samples[tick - 1 + i];
    values[i] = static_cast<double>(float_of(channel, sample));
    if (!std::isfinite(values[i]) || !is_published(channel, sample)) return std::nullopt;
  }
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  const double size = std::max(std::abs(*low), std::abs(*high));
  const double slack = floor_of(channel.quantity) + (*high - *low) + size / 2;
  return Bounds{*low - slack, *high + slack};
}

}  // namespace

std::optional<EventDifference> first_gross_difference(const Trace& got, const Trace& want) {
  const auto half_turn = half_turns_in(want);
  const auto chosen = float_outputs_of(got, want);
  for (std::size_t tick = 1; tick + 1 < want.samples.size(); ++tick) {
    if (half_turn[tick - 1] || half_turn[tick] || half_turn[tick + 1]) continue;
    for (const std::size_t index : chosen) {
      const Channel& channel = channels()[index];
      if (!is_published(channel, got.samples[tick])) continue;
      const auto bounds = bounds_at(want, tick, channel);
      const auto value = static_cast<double>(float_of(channel, got.samples[tick]));
      if (!bounds || !std::isfinite(value) || bounds->hold(value)) continue;
      return EventDifference{tick, index,
                             fmt::format("{} is {:.3g}, expected {:.3g} to {:.3g} at this level",
                                         channel.name.substr(4), value, bounds->low, bounds->high)};
    }
  }
  return std::nullopt;
}

Tolerances gross_tolerances() {
  Tolerances tolerances;
  for (const Channel& channel : channels()) {
    if (!channel.is_output()) continue;
    tolerances.set(channel.name.substr(4), {floor_of(channel.quantity), 0.5});
  }
  return tolerances;
}

std::optional<EventDifference> first_non_finite_event(const Trace& got, const Trace& want) {
  const auto chosen = float_outputs_of(got, want);
  const std::size_t ticks = want.samples.size();
  for (std::size_t tick = 0; tick < ticks; ++tick) {
    for (const std::size_t index : chosen) {
      const Channel& channel = channels()[index];
      if (std::isfinite(float_of(channel, got.samples[tick]))) continue;
      bool is_expected = false;
      for (std::size_t at = tick == 0 ? 0 : tick - 1; at <= std::min(tick + 1, ticks - 1); ++at) {
        is_expected = is_expected || !std::isfinite(float_of(channel, want.samples[at]));
      }
      if (is_expected) continue;
      return EventDifference{tick, index, fmt::format("{} is not finite", channel.name.substr(4))};
    }
  }
  return std::nullopt;
}

}  // namespace attest
