// vehicle_land_detected from the plant's true state, by the rules of PX4's land detector for
// multicopters. models/README.md has the source of the numbers.
//
//     ground contact   low thrust, low vertical and horizontal speed
//     maybe_landed     ground contact, minimal thrust, low body rate about x and y
//     landed           maybe_landed
//
// A stage is reached when its conditions have held for a third of a second, and is lost at the
// first sample at which one of them fails. Disarmed, the conditions of all stages hold. A flight
// that starts on the floor starts landed.
//
// No allocation; one thread at a time.
#pragma once

#include <optional>

#include "harness/casefile/case.hpp"
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
  static constexpr Nanoseconds stage_time{1'000'000'000 / 3};  // of LNDMC_TRIG_TIME = 1 s
  static constexpr double vertical_speed_limit_m_s = 0.25;     // LNDMC_Z_VEL_MAX
  static constexpr double horizontal_speed_limit_m_s = 1.5;    // LNDMC_XY_VEL_MAX
  static constexpr double rate_limit_deg_s = 20;               // LNDMC_ROT_MAX
  static constexpr double rate_limit_factor_when_landed = 2.5;
  static constexpr double thrust_min = 0.12;          // MPC_THR_MIN
  static constexpr double low_thrust_of_range = 0.3;  // from MPC_THR_MIN to MPC_THR_HOVER
  static constexpr double thrust_margin = 0.01;       // above MPC_MANTHR_MIN

  // For a flight that bound_to_vehicle() made (flight.hpp). `rate` is that of the unit that
  // commands the motors. The case is not kept.
  LandDetector(const Case& the_case, const Rate& rate);

  // `thrust` is the commanded collective thrust, 0..1, positive upwards: the cascade's
  // -vehicle_thrust_setpoint.xyz[2]. Conditions on a number that is not finite do not hold.
  // REQUIRES: times do not decrease.
  LandDetected sample(Nanoseconds now, const PlantState& state, float thrust, bool armed);

 private:
  using Since = std::optional<Nanoseconds>;  // the time from which on all conditions have held

  bool touches(Nanoseconds now, const PlantState& state, double thrust) const;
  bool is_still(Nanoseconds now, const PlantState& state, double thrust) const;

  Sampler hover_thrust_, manual_thrust_min_;  // MPC_THR_HOVER, MPC_MANTHR_MIN
  Since ground_contact_, maybe_landed_, landed_;
  bool was_landed_;
};

}  // namespace attest
