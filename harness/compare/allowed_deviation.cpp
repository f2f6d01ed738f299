#include "harness/compare/allowed_deviation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace attest {

void AllowedDeviation::next(const attest_inputs& in, std::span<const ParameterChange> changes) {
  for (const ParameterChange& change : changes) gain_.set(change);
  const bool has_setpoint = (in.updated & ATTEST_UPDATED_VEHICLE_ATTITUDE_SETPOINT) != 0;
  if (is_first_ || has_setpoint) setpoint_ = in;
  is_first_ = false;
}

double AllowedDeviation::of(std::size_t channel, const attest_inputs& in, float got,
                            float want) const {
  const Tolerance base = tolerances_.of(channel);
  const double w = want;
  const double tolerance = std::max(base.absolute, base.relative * std::abs(w));
  const double difference = std::abs(static_cast<double>(got) - w);
  const bool widens = channels()[channel].module == Module::mc_att_control &&
                      channels()[channel].quantity == Quantity::rate &&
                      tolerances_.level() == Level::numeric &&
                      in.vehicle_control_mode.flag_control_attitude_enabled != 0;
  if (!widens || difference <= tolerance) return tolerance;
  const double wider = tolerances_.widening(tilt_error(in, setpoint_), gain_.value());
  // Not finite without an attitude, or with a time constant of zero: then nothing is added.
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
  AllowedDeviation deviation(tolerances);
  PendingChanges changes(want.parameters);
  for (std::size_t tick = 0; tick < want.samples.size(); ++tick) {
    const Sample& sample = want.samples[tick];
    deviation.next(sample.in, changes.take_until(tick));
    allowed.samples[tick].in.timestamp = sample.in.timestamp;
    for (std::size_t i = 0; i < channels().size(); ++i) {
      const Channel& channel = channels()[i];
      if (!allowed.present[i] || channel.type != ChannelType::f32) continue;
      const float value = float_of(channel, sample);
      set_value(channel, allowed.samples[tick],
                std::isfinite(value) ? deviation.of(i, sample.in, any, value) : 0);
    }
  }
  return allowed;
}

}  // namespace attest
