// vehicle_land_detected from the plant's true state: whether the vehicle rests on the floor.
//
//     on the floor     the lowest point of the feet is less than 0.1 arm above z = 0
//     at rest          on the floor, vertical speed and body rate small, low thrust commanded
//     maybe_landed     at rest for 0.25 s
//     landed           0.3 s later, if still at rest
//
// Both become false with the first sample that is not at rest, with one exception: a disarmed
// vehicle on the floor is landed at once, also while it moves. A flight that starts at rest on the
// floor starts landed. Without a floor a vehicle never lands. models/README.md has the reasons for
// the numbers.
//
// No allocation; one thread at a time.
#pragma once

#include <optional>
#include <vector>

#include "harness/core/frames.hpp"
#include "harness/core/time.hpp"
#include "harness/plant/plant.hpp"
#include "harness/plant/vehicle.hpp"

namespace attest {

struct LandDetected {
  bool maybe_landed = false;
  bool landed = false;

  friend bool operator==(const LandDetected&, const LandDetected&) = default;
};

// The height of the centre of mass above the floor when the level vehicle's feet touch it.
double height_on_floor_m(const Vehicle& vehicle);

class LandDetector {
 public:
  static constexpr Nanoseconds maybe_landed_after{250'000'000};
  static constexpr Nanoseconds landed_after{550'000'000};
  static constexpr double height_limit_of_arm = 0.1;
  static constexpr double vertical_speed_limit_m_s = 0.25;
  static constexpr double rate_limit_rad_s = 0.35;  // about 20 deg/s; norm of the body rate
  static constexpr double thrust_limit_of_hover = 0.3;

  // The vehicle is not kept.
  LandDetector(const Vehicle& vehicle, bool floor);

  // `thrust` is the commanded collective thrust, 0..1, positive upwards: the cascade's
  // -vehicle_thrust_setpoint.xyz[2]. With NaN the vehicle is not at rest. REQUIRES: times do not
  // decrease.
  LandDetected sample(Nanoseconds now, const PlantState& state, float thrust, bool armed);

 private:
  bool is_on_floor(const PlantState& state) const;
  bool is_at_rest(const PlantState& state, float thrust) const;

  bool floor_;
  std::vector<Vector3> feet_m_;  // centres of their spheres, FRD, from the centre of mass
  double foot_radius_m_, height_limit_m_, thrust_limit_;
  std::optional<Nanoseconds> at_rest_since_ = -landed_after;  // at the start: at rest for long
};

}  // namespace attest
