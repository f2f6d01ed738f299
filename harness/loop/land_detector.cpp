#include "harness/loop/land_detector.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "harness/casefile/stimulus.hpp"

namespace attest {
namespace {

// The feet of the MuJoCo models: for each rotor, one sphere of radius 0.05 arm, whose centre is
// 0.35 arm below the rotor's hub.
constexpr double foot_below_hub_of_arm = 0.35;
constexpr double foot_radius_of_arm = 0.05;

constexpr double default_hover_thrust = 0.5, default_manual_thrust_min = 0.08;

double length(double x, double y) { return std::sqrt(x * x + y * y); }

bool is_reached(std::optional<Nanoseconds>& since, Nanoseconds now, bool condition) {
  if (!condition) {
    since.reset();
  } else if (!since) {
    since = now;
  }
  return since && now - *since >= LandDetector::stage_time;
}

}  // namespace

double height_on_floor_m(const Vehicle& vehicle) {
  const double arm_m = vehicle.arm_m();
  double lowest = 0;
  for (const VehicleRotor& rotor : vehicle.rotors) {
    lowest = std::max(lowest, rotor.position_m[2] + foot_below_hub_of_arm * arm_m);
  }
  return lowest + foot_radius_of_arm * arm_m;
}

LandDetector::LandDetector(const Case& the_case, const Rate& rate)
    : hover_thrust_(the_case.parameter("MPC_THR_HOVER", default_hover_thrust),
                    timeline_of(the_case, rate)),
      manual_thrust_min_(the_case.parameter("MPC_MANTHR_MIN", default_manual_thrust_min),
                         timeline_of(the_case, rate)),
      was_landed_(the_case.flight->start.on_floor) {
  if (was_landed_) ground_contact_ = maybe_landed_ = landed_ = -stage_time;
}

LandDetected LandDetector::sample(Nanoseconds now, const PlantState& state, float thrust,
                                  bool armed) {
  const auto commanded = static_cast<double>(thrust);
  const bool contact = is_reached(ground_contact_, now, !armed || touches(now, state, commanded));
  const bool maybe_landed =
      is_reached(maybe_landed_, now, !armed || (contact && is_still(now, state, commanded)));
  was_landed_ = is_reached(landed_, now, !armed || maybe_landed);
  return {maybe_landed, was_landed_};
}

bool LandDetector::touches(Nanoseconds now, const PlantState& state, double thrust) const {
  const auto [north, east, down] = state.velocity_m_s;
  const double low_thrust = thrust_min + low_thrust_of_range * (hover_thrust_.at(now) - thrust_min);
  return std::abs(down) <= vertical_speed_limit_m_s &&
         length(north, east) <= horizontal_speed_limit_m_s && thrust <= low_thrust;
}

bool LandDetector::is_still(Nanoseconds now, const PlantState& state, double thrust) const {
  constexpr double limit_rad_s = rate_limit_deg_s * std::numbers::pi / 180;
  const double factor = was_landed_ ? rate_limit_factor_when_landed : 1;
  return length(state.rate_rad_s[0], state.rate_rad_s[1]) <= factor * limit_rad_s &&
         thrust <= manual_thrust_min_.at(now) + thrust_margin;
}

}  // namespace attest
