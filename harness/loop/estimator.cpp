#include "harness/loop/estimator.hpp"

#include <cmath>
#include <numbers>

namespace attest {
namespace {

// q followed by a small rotation about the body axes. `half_angle`: half its rotation vector [rad].
Quaternion turned(const Quaternion& q, const Vector3& half_angle) {
  const auto [x, y, z] = half_angle;
  const double scale = 1 / std::sqrt(1 + x * x + y * y + z * z);
  return {scale * (q.w - q.x * x - q.y * y - q.z * z), scale * (q.x + q.w * x + q.y * z - q.z * y),
          scale * (q.y + q.w * y - q.x * z + q.z * x), scale * (q.z + q.w * z + q.x * y - q.y * x)};
}

}  // namespace

ControlState control_state_of(const PlantState& state) {
  const auto single = [](double value) { return static_cast<float>(value); };
  const Quaternion& q = state.attitude;
  const Vector3& rate = state.rate_rad_s;
  return {{single(q.w), single(q.x), single(q.y), single(q.z)},
          single(rate[0]),
          single(rate[1]),
          single(rate[2])};
}

ControlState NoisyEstimator::sample(const PlantState& state) {
  constexpr double radians = std::numbers::pi / 180;
  PlantState estimated = state;
  if (options_.attitude_noise_deg > 0) {
    estimated.attitude = turned(state.attitude, normal(options_.attitude_noise_deg * radians / 2));
  }
  if (options_.rate_noise_rad_s > 0) {
    const Vector3 noise = normal(options_.rate_noise_rad_s);
    for (std::size_t i = 0; i < 3; ++i) estimated.rate_rad_s[i] += noise[i];
  }
  return control_state_of(estimated);
}

namespace {

Estimator options_for(const Case& the_case) {
  Estimator options = the_case.flight->estimator;
  if (the_case.module == Module::rate_unit) ++options.seed;
  return options;
}

Quaternion product(const Quaternion& a, const Quaternion& b) {
  return {
      a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
      a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x, a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
}

std::array<float, 4> in_single(const Quaternion& q) {
  return {static_cast<float>(q.w), static_cast<float>(q.x), static_cast<float>(q.y),
          static_cast<float>(q.z)};
}

std::array<float, 3> in_single(const Vector3& v) {
  return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
}

}  // namespace

UnitEstimator::UnitEstimator(const Case& the_case, const Rate& own, const Rate& timeline)
    : noisy_(options_for(the_case)) {
  const auto& reset = the_case.flight->estimator.reset;
  if (reset && the_case.module == Module::attitude_unit) {
    reset_ = {reset->at.on(timeline), reset->turn};
  }
  if (the_case.module == Module::rate_unit) gyro_filter_.emplace(own);
}

Estimate UnitEstimator::sample(Nanoseconds now, const PlantState& state) {
  PlantState seen = state;
  Estimate estimate{now, {}, {}, 0, {1, 0, 0, 0}};
  if (reset_ && now >= reset_->at) {
    seen.attitude = product(reset_->turn, state.attitude);
    estimate.resets = 1;
    estimate.delta_q_reset = in_single(reset_->turn);
  }
  estimate.state = noisy_.sample(seen);
  if (gyro_filter_) filter(estimate);
  return estimate;
}

void UnitEstimator::filter(Estimate& estimate) {
  ControlState& state = estimate.state;
  gyro_filter_->sample(estimate.sampled, {state.roll_rate, state.pitch_rate, state.yaw_rate});
  const std::array rate = in_single(gyro_filter_->rate_rad_s());
  state.roll_rate = rate[0];
  state.pitch_rate = rate[1];
  state.yaw_rate = rate[2];
  estimate.acceleration_rad_s2 = in_single(gyro_filter_->acceleration_rad_s2());
}

// The sum of twelve uniform numbers has variance 1, and is close enough to a normal distribution.
// It stays within +-6 standard deviations. It needs no logarithm or cosine, whose bits differ
// between platforms.
Vector3 NoisyEstimator::normal(double deviation) {
  Vector3 noise{};
  for (double& component : noise) {
    double sum = -6;
    for (int i = 0; i < 12; ++i) sum += random_.uniform();
    component = deviation * sum;
  }
  return noise;
}

}  // namespace attest
