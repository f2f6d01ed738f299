#include "harness/loop/land_detector.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace attest {
namespace {

// The feet of the MuJoCo models: for each rotor, one sphere of radius 0.05 arm. The centre of the
// sphere is 0.35 arm below the rotor's hub. Its x and y are 0.6 times those of the hub.
constexpr double foot_of_hub = 0.6;
constexpr double foot_below_hub_of_arm = 0.35;
constexpr double foot_radius_of_arm = 0.05;

// The world's z of a body vector: the last row of the rotation matrix.
double down(const Quaternion& q, const Vector3& v) {
  return 2 * (q.x * q.z - q.w * q.y) * v[0] + 2 * (q.y * q.z + q.w * q.x) * v[1] +
         (1 - 2 * (q.x * q.x + q.y * q.y)) * v[2];
}

double foot_below_m(const VehicleRotor& rotor, double arm_m) {
  return rotor.position_m[2] + foot_below_hub_of_arm * arm_m;
}

}  // namespace

double height_on_floor_m(const Vehicle& vehicle) {
  const double arm_m = vehicle.arm_m();
  double lowest = 0;
  for (const VehicleRotor& rotor : vehicle.rotors) {
    lowest = std::max(lowest, foot_below_m(rotor, arm_m));
  }
  return lowest + foot_radius_of_arm * arm_m;
}

LandDetector::LandDetector(const Vehicle& vehicle, bool floor)
    : floor_(floor),
      foot_radius_m_(foot_radius_of_arm * vehicle.arm_m()),
      height_limit_m_(height_limit_of_arm * vehicle.arm_m()),
      thrust_limit_(thrust_limit_of_hover * vehicle.hover_thrust()) {
  for (const VehicleRotor& rotor : vehicle.rotors) {
    feet_m_.push_back({foot_of_hub * rotor.position_m[0], foot_of_hub * rotor.position_m[1],
                       foot_below_m(rotor, vehicle.arm_m())});
  }
}

LandDetected LandDetector::sample(Nanoseconds now, const PlantState& state, float thrust,
                                  bool armed) {
  const bool disarmed_on_floor = !armed && is_on_floor(state);
  if (disarmed_on_floor) {
    at_rest_since_ = now - landed_after;
  } else if (!is_at_rest(state, thrust)) {
    at_rest_since_.reset();
  } else if (!at_rest_since_) {
    at_rest_since_ = now;
  }
  if (!at_rest_since_) return {};
  const Nanoseconds rested = now - *at_rest_since_;
  return {rested >= maybe_landed_after, rested >= landed_after};
}

bool LandDetector::is_on_floor(const PlantState& state) const {
  if (!floor_) return false;
  double lowest = -std::numeric_limits<double>::infinity();  // z points down
  for (const Vector3& foot : feet_m_) lowest = std::max(lowest, down(state.attitude, foot));
  return -(state.position_m[2] + lowest + foot_radius_m_) < height_limit_m_;
}

bool LandDetector::is_at_rest(const PlantState& state, float thrust) const {
  const auto [x, y, z] = state.rate_rad_s;
  return is_on_floor(state) && std::abs(state.velocity_m_s[2]) < vertical_speed_limit_m_s &&
         std::sqrt(x * x + y * y + z * z) < rate_limit_rad_s &&
         static_cast<double>(thrust) < thrust_limit_;
}

}  // namespace attest
