#include "harness/compare/allowed_deviation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "harness/core/agreement.hpp"

namespace attest {

void AllowedDeviation::next(const Sample& want, std::span<const ParameterChange> changes) {
  for (const ParameterChange& change : changes) gain_.set(change);
  if (follows_attitude(module_)) setpoint_.next(want);
}

bool AllowedDeviation::widens(std::size_t channel, const Sample& tick) const {
  const Channel& what = channels()[channel];
  if (what.quantity != Quantity::rate || tolerances_.level() != Level::numeric) return false;
  if (module_ == Module::attitude_unit) return what.stage == Stage::attitude_law;
  return module_ == Module::mc_att_control && uses_attitude_law(tick, module_);
}

double AllowedDeviation::widening(const Sample& tick) const {
  if (module_ == Module::mc_att_control) {
    const double error = tilt_error(attitude_at(tick, module_), setpoint_.q_d());
    return tolerances_.widening(error, gain_.value());
  }
  // The law of the cascade computes yaw from the error that remains after the tilt correction, so
  // its noise is larger than that of the controller: float and double differ by 1.3e-4 rad/s at 179
  // deg, and by 1.5e-3 at 179.9 (measured on random attitudes).
  constexpr double noise = 10.0 / 3;
  const double error = attitude_error(attitude_at(tick, module_), setpoint_.q_d());
  return tolerances_.widening(error, noise * gain_.value());
}

double AllowedDeviation::of(std::size_t channel, const Sample& tick, float got, float want) const {
  const double tolerance = tolerances_.of(channel).at(want);
  const double difference = distance(got, want);
  if (difference * ample_headroom <= tolerance || !widens(channel, tick)) return tolerance;
  const double wider = widening(tick);
  // The widening is not finite if an attitude is zero or not finite, or a time constant is zero.
  // Then the tolerance is not widened.
  return std::isfinite(wider) ? tolerance + wider : tolerance;
}

Trace allowed_deviations(const Trace& want, const Tolerances& tolerances) {
  constexpr float any = std::numeric_limits<float>::infinity();
  Trace allowed;
  allowed.source = want.source;
  allowed.present = want.present;
  for (std::size_t i = 0; i < channels().size(); ++i) {
    if (!channels()[i].is_output() && channels()[i].type != ChannelType::u64)
      allowed.present[i] = false;
  }
  allowed.samples.resize(want.samples.size());
  AllowedDeviation deviation(tolerances, module_of(want.present));
  PendingChanges changes(want.parameters);
  for (std::size_t tick = 0; tick < want.samples.size(); ++tick) {
    const Sample& sample = want.samples[tick];
    deviation.next(sample, changes.take_until(tick));
    allowed.samples[tick].in.timestamp = sample.in.timestamp;
    for (std::size_t i = 0; i < channels().size(); ++i) {
      const Channel& channel = channels()[i];
      if (!allowed.present[i] || channel.type != ChannelType::f32) continue;
      const float value = float_of(channel, sample);
      set_value(channel, allowed.samples[tick],
                std::isfinite(value) ? deviation.of(i, sample, any, value) : 0);
    }
  }
  return allowed;
}

}  // namespace attest
