#include "harness/compare/compare.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <vector>

#include <fmt/format.h>

#include "harness/compare/events.hpp"
#include "harness/compare/tilt.hpp"

namespace attest {
namespace {

// Floats in their order as consecutive integers, -0 and +0 one step apart.
std::int64_t ordinal(float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  const auto magnitude = static_cast<std::int64_t>(bits & 0x7fffffffu);
  return (bits >> 31) ? -magnitude - 1 : magnitude;
}

std::int64_t ulp_distance(float a, float b) {
  if (std::isnan(a) || std::isnan(b)) return 0;
  return std::abs(ordinal(a) - ordinal(b));
}

// Bits, where every NaN is the same.
bool same_bits(float a, float b) {
  if (std::isnan(a) || std::isnan(b)) return std::isnan(a) && std::isnan(b);
  return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b);
}

bool truth(std::uint8_t flag) { return flag != 0; }

std::vector<std::size_t> compared_channels(const Trace& want) {
  std::vector<std::size_t> chosen;
  const auto table = channels();
  for (std::size_t i = 0; i < table.size(); ++i) {
    if (table[i].is_output() && want.present[i]) chosen.push_back(i);
  }
  return chosen;
}

class Comparer {
 public:
  Comparer(const Trace& got, const Trace& want, const Tolerances& tolerances)
      : got_(got), want_(want), tolerances_(tolerances), gain_(want) {}

  Comparison run() {
    result_.mismatch = structural_mismatch();
    if (!result_.mismatch.empty()) return result_;
    result_.ticks = want_.samples.size();
    if (tolerances_.level() == Level::events) {
      compare_events();
      return result_;
    }
    const std::vector<std::size_t> chosen = compared_channels(want_);
    for (std::size_t tick = 0; tick < want_.samples.size(); ++tick) compare_tick(tick, chosen);
    return result_;
  }

 private:
  std::string structural_mismatch() const {
    const std::size_t common = std::min(got_.samples.size(), want_.samples.size());
    for (std::size_t tick = 0; tick < common; ++tick) {
      const auto got = got_.samples[tick].in.timestamp;
      const auto want = want_.samples[tick].in.timestamp;
      if (got != want) {
        return fmt::format(
            "tick {} is at {} us, expected at {} us; traces are compared tick by "
            "tick, so record both at the same times",
            tick, got, want);
      }
    }
    if (got_.samples.size() != want_.samples.size()) {
      return fmt::format("{} ticks, expected {}", got_.samples.size(), want_.samples.size());
    }
    const std::vector<std::size_t> chosen = compared_channels(want_);
    for (const std::size_t channel : chosen) {
      if (!got_.present[channel])
        return fmt::format("{} was not recorded", channels()[channel].name);
    }
    return chosen.empty() ? "nothing to compare: no out/ channels" : "";
  }

  void compare_events() {
    const auto difference = first_event_difference(got_, want_);
    if (!difference) return;
    note(difference->tick, difference->channel, 0, 0);
    result_.event = difference->what;
    result_.deviating_ticks = 1;
  }

  void compare_tick(std::size_t tick, const std::vector<std::size_t>& chosen) {
    const Sample& got = got_.samples[tick];
    const Sample& want = want_.samples[tick];
    if (want.in.updated & ATTEST_UPDATED_VEHICLE_ATTITUDE_SETPOINT) setpoint_ = tick;
    if (std::memcmp(&got.out, &want.out, sizeof got.out) == 0) return;

    bool deviates = false;
    for (const std::size_t channel : chosen) deviates |= !channel_agrees(tick, channel);
    result_.deviating_ticks += deviates ? 1 : 0;
  }

  bool channel_agrees(std::size_t tick, std::size_t channel) {
    const Channel& what = channels()[channel];
    const Sample& got = got_.samples[tick];
    const Sample& want = want_.samples[tick];
    if (what.type != ChannelType::f32) {
      const auto g = static_cast<std::uint8_t>(value_of(what, got));
      const auto w = static_cast<std::uint8_t>(value_of(what, want));
      if (truth(g) == truth(w)) return true;
      note(tick, channel, 0, 0);
      return false;
    }
    const float g = float_of(what, got);
    const float w = float_of(what, want);
    if (same_bits(g, w)) return true;
    const bool both_finite = std::isfinite(g) && std::isfinite(w);
    const double tolerance = both_finite ? tolerance_at(tick, channel, g, w) : 0;
    const double difference = std::abs(static_cast<double>(g) - static_cast<double>(w));
    // Written so that a NaN difference is outside.
    if (tolerances_.level() == Level::numeric && both_finite && difference <= tolerance) {
      note_headroom(tick, channel, difference, tolerance);
      return true;
    }
    if (!result_.first) result_.got_non_finite = !std::isfinite(g) && std::isfinite(w);
    note(tick, channel, ulp_distance(g, w), tolerance);
    return false;
  }

  double tolerance_at(std::size_t tick, std::size_t channel, float got, float want) {
    const Tolerance base = tolerances_.of(channel);
    const double w = want;
    const double tolerance = std::max(base.absolute, base.relative * std::abs(w));
    const double difference = std::abs(static_cast<double>(got) - w);
    const attest_inputs& in = want_.samples[tick].in;
    const bool widens = channels()[channel].quantity == Quantity::rate &&
                        tolerances_.level() == Level::numeric &&
                        in.vehicle_control_mode.flag_control_attitude_enabled != 0;
    if (!widens || difference <= tolerance) return tolerance;
    const double tilt = tilt_error(in, want_.samples[setpoint_].in);
    const double wider = tolerances_.widening(tilt, gain_.at(tick));
    // No attitude, or a time constant of zero: nothing that floats could be near to.
    return std::isfinite(wider) ? tolerance + wider : tolerance;
  }

  void note(std::size_t tick, std::size_t channel, std::int64_t ulp, double tolerance) {
    if (result_.first) return;
    const Channel& what = channels()[channel];
    result_.first = Deviation{tick,
                              want_.samples[tick].in.timestamp,
                              channel,
                              value_of(what, got_.samples[tick]),
                              value_of(what, want_.samples[tick]),
                              ulp,
                              tolerance};
  }

  void note_headroom(std::size_t tick, std::size_t channel, double difference, double tolerance) {
    // -0 against +0 differs in bits, not in value.
    const double ratio =
        difference > 0 ? tolerance / difference : std::numeric_limits<double>::infinity();
    if (result_.tightest && result_.tightest->ratio <= ratio) return;
    result_.tightest = Headroom{ratio, tick, channel};
  }

  const Trace& got_;
  const Trace& want_;
  const Tolerances& tolerances_;
  AttitudeGain gain_;
  std::size_t setpoint_ = 0;  // tick of the last attitude setpoint
  Comparison result_;
};

}  // namespace

Comparison compare(const Trace& got, const Trace& want, const Tolerances& tolerances) {
  return Comparer(got, want, tolerances).run();
}

namespace {

// The parameters in force at each tick, walking forward.
class ParametersInForce {
 public:
  explicit ParametersInForce(const Trace& trace) : changes_(trace.parameters) {}

  const std::map<std::string, float>& at(std::size_t tick) {
    for (; next_ < changes_.size() && changes_[next_].tick <= tick; ++next_) {
      values_[changes_[next_].name] = changes_[next_].value;
    }
    return values_;
  }

 private:
  const std::vector<ParameterChange>& changes_;
  std::size_t next_ = 0;
  std::map<std::string, float> values_;
};

bool same_parameters(const std::map<std::string, float>& a, const std::map<std::string, float>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const auto& x, const auto& y) {
    return x.first == y.first && same_bits(x.second, y.second);
  });
}

bool same_inputs(const Sample& a, const Sample& b) {
  const auto table = channels();
  return std::all_of(table.begin(), table.end(), [&](const Channel& channel) {
    if (channel.is_output()) return true;
    return channel.type == ChannelType::f32 ? same_bits(float_of(channel, a), float_of(channel, b))
                                            : value_of(channel, a) == value_of(channel, b);
  });
}

}  // namespace

std::optional<std::size_t> first_input_difference(const Trace& a, const Trace& b) {
  const std::size_t common = std::min(a.samples.size(), b.samples.size());
  ParametersInForce of_a(a), of_b(b);
  for (std::size_t tick = 0; tick < common; ++tick) {
    if (!same_inputs(a.samples[tick], b.samples[tick])) return tick;
    if (!same_parameters(of_a.at(tick), of_b.at(tick))) return tick;
  }
  if (a.samples.size() != b.samples.size()) return common;
  return std::nullopt;
}

}  // namespace attest
