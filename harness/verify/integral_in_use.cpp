#include "harness/verify/integral_in_use.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace attest {
namespace {

// The topic rate_ctrl_status has no time of its sample. The reader of logs gives it to a step if it
// is at most so much later. In a fast loop it may then be of a later step.
constexpr double latest_status_us = 2000;

std::array<double, 3> integrals(const Sample& sample) {
  const auto& status = sample.rate_out.rate_ctrl_status;
  return {status.rollspeed_integ, status.pitchspeed_integ, status.yawspeed_integ};
}

}  // namespace

void IntegralInUse::remove_from(Sample& logged, const Sample& reference) {
  const auto now = logged.rate_in.vehicle_angular_velocity.timestamp_sample;
  // The reference's dt (LAW-CASCADE 6.1). The loop's own is not in the log.
  const double dt_us = std::clamp(static_cast<double>(now - last_us_), 125.0, 20000.0);
  last_us_ = now;
  const auto& battery = logged.rate_in.battery_status;
  const double scale = battery.connected != 0 ? static_cast<double>(battery.scale) : 1;
  const double steps = 1 + (period_us_ > 0 ? std::floor(latest_status_us / period_us_) : 0);
  const auto after = integrals(logged), increments = integrals(reference);
  for (std::size_t axis = 0; axis < after.size(); ++axis) {
    const auto [least, most] =
        std::minmax({after[axis], after[axis] - steps * increments[axis] * period_us_ / dt_us});
    float& torque = logged.rate_out.vehicle_torque_setpoint.xyz[axis];
    const double rest = reference.rate_out.vehicle_torque_setpoint.xyz[axis];
    const double used = std::clamp((static_cast<double>(torque) - rest) / scale, least, most);
    torque = static_cast<float>(static_cast<double>(torque) - scale * used);
  }
}

}  // namespace attest
