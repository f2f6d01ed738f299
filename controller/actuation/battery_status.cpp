#include "controller/actuation/battery_status.hpp"

#include <algorithm>
#include <cmath>

namespace attest::actuation {
namespace {

constexpr float filter_keep = 0.99f;
constexpr float filter_take = 0.01f;
constexpr float scale_max = 1.3f;

// The drop under load is fitted to throttle plus this share, so that it is not zero at idle.
constexpr float idle_share = 0.1f;

}  // namespace

float BatteryStatus::update(const BatterySample& sample) {
  const float cell_V = sample.voltage_V / static_cast<float>(options_.cell_count);
  const float range_V = options_.full_cell_V - options_.empty_cell_V;
  filter_remaining((cell_V - (options_.empty_cell_V - load_drop_V(sample))) / range_V);
  return scale();
}

float BatteryStatus::load_drop_V(const BatterySample& sample) const {
  if (options_.internal_resistance_ohm) return sample.current_A * *options_.internal_resistance_ohm;
  if (!sample.armed) return 0.0f;
  return options_.load_drop_V * (std::abs(sample.throttle) + idle_share) / (1.0f + idle_share);
}

void BatteryStatus::filter_remaining(float measured) {
  const float filtered = started_ ? remaining_ * filter_keep + measured * filter_take : measured;
  started_ = true;
  remaining_ = std::clamp(filtered, 0.0f, 1.0f);
}

// The rest voltage of a full cell over that of this one.
float BatteryStatus::scale() const {
  const float range_V = options_.full_cell_V - options_.empty_cell_V;
  const float factor = options_.full_cell_V / (options_.empty_cell_V + range_V * remaining_);
  if (!std::isfinite(factor) || factor < 1.0f) return 1.0f;
  return std::min(factor, scale_max);
}

}  // namespace attest::actuation
