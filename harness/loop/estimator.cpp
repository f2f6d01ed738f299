#include "harness/loop/estimator.hpp"

#include <cmath>
#include <numbers>

namespace attest {
namespace {

// q turned by the small rotation `half_angle` (half its angle, about the body axes).
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

// The sum of twelve uniform numbers has variance 1 and is close enough to normal, within +-6
// standard deviations. It needs no logarithm or cosine, whose bits differ between platforms.
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
