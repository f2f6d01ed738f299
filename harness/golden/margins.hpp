// How near a vector comes to the places where the law decides: two right controllers differ in
// their last bits, and where a decision hangs on those a numeric comparison would accuse one of
// them.
//
// The distances are measured in double, on the law itself: its stages are policies, and here they
// take notes. Where a clamp or a blend passes from one branch to the other without a jump (dt, the
// rate limits, the tilt error at 90 deg) nothing hangs on it, and it is no decision.
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
  quaternion_norm,    // | |q| - 1 |, the other way round: how far from being an attitude
  thrust_gate,        // thrust > 0.2
  integrator_gate,    // |u| < thrust, -0.3 < n < 0.3, -0.3 < u < 0.3, whichever would flip first
  rattitude,          // a stick against MC_RATT_TH
  shorter_rotation,   // q_e.w >= 0, beyond 90 deg
  yaw_wrap,           // the yaw error at +-pi
  tilt_axis,          // the tilt error at 180 deg, where its axis is any
  battery_scale,      // scale > 0
  recovery_latch,     // the tailsitter's 30 and 5 deg
  recovery_rotation,  // its q_e.w > 0
  mixer_limit,        // a rotor's share of roll, pitch and thrust against 0 and 1
  mixer_branch,       // which end has more room than the other lacks
  mixer_yaw,          // yaw against the rotors' limits, which it sets the flag by
};
inline constexpr auto decision_count = static_cast<std::size_t>(Decision::mixer_yaw) + 1;

std::string_view name_of(Decision decision);  // "integrator gate"

// The least distance that a numeric vector may have: several times what right builds were measured
// to differ by in that quantity (DESIGN of the tolerances: 8e-7 on controls, 5e-7 on integrals,
// some 1e-6 rad on angles over 10 s of open loop). For the norm: the most.
double least_margin(Decision decision);

// The same with a port in fixed point, if it says its bits: at least as many of the last as its
// controls were measured to differ by (Tolerances::control_lsb has what is allowed).
inline constexpr double decision_lsb = 750;
double least_margin(Decision decision, std::optional<int> fraction_bits);

struct Margin {
  double distance = std::numeric_limits<double>::infinity();  // infinite: never measured
  std::size_t tick = 0;
};

// Whether `one` is nearer to the decision than `other`: the smaller distance; of the norm, the
// larger. A distance that was never measured is nearer than no other.
bool is_nearer(Decision decision, const Margin& one, const Margin& other);

struct Margins {
  std::array<Margin, decision_count> of{};

  const Margin& operator[](Decision decision) const {
    return of[static_cast<std::size_t>(decision)];
  }
  bool is_safe(Decision decision) const;
};

// How near a unit comes at each tick, one after the other.
class MarginMeter {
 public:
  // In the power-on state. REQUIRES: the reference has the profile.
  explicit MarginMeter(std::string_view profile);
  ~MarginMeter();

  // Of the next tick alone; valid until the one after it.
  const Margins& step(std::span<const ParameterChange> changes, const attest_inputs& in);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// Of all inputs of `given`. A battery estimate decides nothing: it is continuous.
Margins margins(const Trace& given, const Subject& subject);

}  // namespace attest
