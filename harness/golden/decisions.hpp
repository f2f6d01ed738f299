// The decisions of the laws, and how near a vector (a case at one rate) comes to them. A decision
// is a comparison with a threshold at which outputs jump. Two correct ports differ in their last
// bits. If a decision depends on these bits, a numeric comparison would fail one of the two.
//
// Clamps and blends without a jump are not decisions, because both branches give the same output at
// the threshold. Examples are dt, the limits of rates and integrals, the deadzone, the hover thrust
// at a centred throttle, and the tilt error at 90 deg of v1.5.5. Flags, and comparisons between two
// times in whole microseconds, are no decisions either, because every port gets the same integers.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <string_view>

namespace attest {

enum class Decision {
  // Of the controller of v1.5.5 and v1.3.4; those with * of the cascade, too.
  quaternion_norm,  // |q| against 1: here a small distance is safe, a large one unsafe
  thrust_gate,      // thrust > 0.2
  // |u| < thrust, -0.3 < n < 0.3, -0.3 < u < 0.3 (u: control, n: next integral). If all hold, the
  // distance is that of the condition nearest to its limit. Otherwise it is that of the failed
  // condition farthest from its limit.
  integrator_gate,
  rattitude,  // a stick against MC_RATT_TH
  // * q_e.w >= 0: of the controller only beyond 90 deg of tilt; of v1.18 also from the reference
  // model to the setpoint
  shorter_rotation,
  yaw_wrap,           // * the yaw error at +-pi
  tilt_axis,          // * the tilt error at 180 deg, where its axis is arbitrary
  battery_scale,      // * scale > 0
  recovery_begin,     // tilt against 30 deg: a tailsitter's recovery
  recovery_end,       // tilt against 5 deg
  recovery_side,      // the direction of the tilt at 0 and +-pi, where roll and yaw change sign
  recovery_rotation,  // q_e.w > 0 outside of a recovery
  // Of the mixer.
  mixer_limit,   // a rotor's output without yaw against 0 and 1
  mixer_branch,  // if outputs exceed only one end of 0..1: excess against room at the other end
  mixer_yaw,     // a rotor's output with yaw against 0 and 1, beyond which the yaw flag is set
  // Of the attitude unit.
  opposite_thrust,  // x or y of the tilt rotation against 1 - 1e-5
  yaw_weight,       // MC_YAW_WEIGHT > 1e-4
  spool_up,         // time since arming > COM_SPOOLUP_TIME [s]
  lowest_throttle,  // throttle < -0.9
  heading_pole,     // pitch against 0.001 rad from +-90 deg
  heading_wrap,     // at +-pi: the yaw of the sticks' setpoint, the error of the heading
  convergence,      // the change of the heading's error against 1 deg
  yaw_lock,         // |yaw rate| > FLT_EPSILON, as a ratio; also in the reference model
  // Of the rate unit.
  saturation_flag,  // |unallocated torque| > FLT_EPSILON, as a ratio
  yaw_cutoff,       // MC_YAW_TQ_CUTOFF > FLT_EPSILON, as a ratio
  overflow,         // torque and next integral against the largest float, as a ratio
};
inline constexpr auto decision_count = static_cast<std::size_t>(Decision::overflow) + 1;

std::string_view name_of(Decision decision);  // "integrator gate"

// The least distance that a vector may have, if it is compared numerically; for quaternion_norm,
// the largest. It is several times the difference between correct builds in the value that is
// compared with the threshold. Differences measured over 10 s of open loop: 8e-7 on controls, 5e-7
// on integrals (compare/tolerance.hpp), about 1e-6 rad on angles.
double least_margin(Decision decision);

// The same. `fraction_bits` is given for a port in fixed point; the result is then at least
// decision_lsb times its LSB, 2^-fraction_bits. The number is the measured difference of the
// controls of such ports. Tolerances::control_lsb is the allowed difference.
inline constexpr double decision_lsb = 750;
double least_margin(Decision decision, std::optional<int> fraction_bits);

struct Margin {
  double distance = std::numeric_limits<double>::infinity();  // infinite: never measured
  std::size_t tick = 0;

  bool is_measured() const { return distance < std::numeric_limits<double>::infinity(); }
};

// Whether `one` is nearer to the decision than `other`: its distance is smaller; for
// quaternion_norm, larger. False if `one` was never measured.
bool is_nearer(Decision decision, const Margin& one, const Margin& other);

// Where a value is, seen from the threshold of a decision.
enum class Side { below, above };
inline constexpr std::array both_sides = {Side::below, Side::above};

// The nearest margin of each decision on each side.
class Margins {
 public:
  const Margin& at(Decision decision, Side side) const {
    return nearest_[static_cast<std::size_t>(decision)][static_cast<std::size_t>(side)];
  }
  const Margin& operator[](Decision decision) const;  // of the nearer side
  bool is_safe(Decision decision) const;

  // Keeps the distance of `from_threshold` (the value minus its threshold) if it is the nearest of
  // its decision on its side. A value on the threshold counts as above it. A NaN is ignored.
  void note(Decision decision, double from_threshold, std::size_t tick);
  // The same for all margins of a tick.
  void note(const Margins& at_tick, std::size_t tick);

 private:
  Margin& at(Decision decision, Side side) {
    return nearest_[static_cast<std::size_t>(decision)][static_cast<std::size_t>(side)];
  }

  std::array<std::array<Margin, 2>, decision_count> nearest_{};
};

// The largest distance of a value that is on the threshold. Inputs can have the float of the
// threshold itself. The distances of computed values are measured in double, where the float of the
// threshold is some roundings away.
double on_threshold(Decision decision);

// A place where the suite needs a case: on the threshold at the level `exact`, and on each side,
// within `near_margins` of its least_margin(), at the level `numeric`.
enum class Place { below, on, above };
inline constexpr std::array all_places = {Place::below, Place::on, Place::above};
inline constexpr double near_margins = 30;

std::string_view name_of(Place place);

// Why no case can have a value there; empty if a case can.
std::string_view reason_for_none(Decision decision, Place place);

}  // namespace attest
