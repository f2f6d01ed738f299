// The margins of a vector: its distances from the decisions of the law. Two correct controllers
// differ in their last bits. Where a decision depends on these bits, a numeric comparison would
// fail one of the two.
//
// The distances are measured in double, on the law itself: its stages are policies, and the stages
// here record the distances. Clamps and blends are not decisions where they pass from one branch to
// the other without a jump: both branches give the same output there. Examples are dt, the rate
// limits, and the tilt error at 90 deg.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "harness/loop/open_loop.hpp"
#include "harness/trace/trace.hpp"

namespace attest {

enum class Decision {
  quaternion_norm,  // | |q| - 1 |: here a small distance is safe, and a large one not
  thrust_gate,      // thrust > 0.2
  // |u| < thrust, -0.3 < n < 0.3, -0.3 < u < 0.3 (u: control, n: next integral). If all hold, the
  // distance is that of the nearest to failing, otherwise that of the farthest from holding.
  integrator_gate,
  rattitude,          // a stick against MC_RATT_TH
  shorter_rotation,   // q_e.w >= 0, beyond 90 deg
  yaw_wrap,           // the yaw error at +-pi
  tilt_axis,          // the tilt error at 180 deg, where its axis is arbitrary
  battery_scale,      // scale > 0
  recovery_latch,     // the tailsitter's 30 and 5 deg
  recovery_rotation,  // its q_e.w > 0
  mixer_limit,        // a rotor's share of roll, pitch and thrust against 0 and 1
  mixer_branch,       // one end of 0..1 exceeded: its excess against the room at the other end
  mixer_yaw,          // yaw against the rotors' limits, where its flag is set
};
inline constexpr auto decision_count = static_cast<std::size_t>(Decision::mixer_yaw) + 1;

std::string_view name_of(Decision decision);  // "integrator gate"

// The least distance that a numeric vector may have; for the norm, the largest. It is several times
// the difference between correct builds in that quantity. Measured over 10 s of open loop: 8e-7 on
// controls, 5e-7 on integrals (compare/tolerance.hpp), some 1e-6 rad on angles.
double least_margin(Decision decision);

// The same for a port in fixed point, if `fraction_bits` is given: at least `decision_lsb` of its
// LSBs, the measured difference of its controls. Tolerances::control_lsb is the allowed difference.
inline constexpr double decision_lsb = 750;
double least_margin(Decision decision, std::optional<int> fraction_bits);

struct Margin {
  double distance = std::numeric_limits<double>::infinity();  // infinite: never measured
  std::size_t tick = 0;
};

// Whether `one` is nearer to the decision than `other`: the smaller distance; of the norm, the
// larger. False if `one` was never measured.
bool is_nearer(Decision decision, const Margin& one, const Margin& other);

struct Margins {
  std::array<Margin, decision_count> of{};

  const Margin& operator[](Decision decision) const {
    return of[static_cast<std::size_t>(decision)];
  }
  bool is_safe(Decision decision) const;
};

// The margins of a unit at each tick, one tick after the other.
class MarginMeter {
 public:
  // In the power-on state. REQUIRES: the reference has the profile.
  explicit MarginMeter(std::string_view profile);
  ~MarginMeter();

  // Of the next tick alone; valid until the next call.
  const Margins& step(std::span<const ParameterChange> changes, const attest_inputs& in);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// Of all inputs of `given`. A battery estimate has no decisions: it is continuous.
Margins margins(const Trace& given, const Subject& subject);

}  // namespace attest
