#include "harness/golden/decisions.hpp"

#include <algorithm>
#include <cmath>

namespace attest {
namespace {

struct DecisionTraits {
  Decision decision;
  std::string_view name;
  double least_margin;
};

constexpr double of_input = 1e-6;  // inputs differ only by the port's number format
constexpr double of_law = 1e-5;
constexpr double of_ratio = 1e-4;

// In the order of the enumerators.
constexpr std::array<DecisionTraits, decision_count> all_traits{{
    {Decision::quaternion_norm, "norm of quaternions", 1e-6},  // float32 norms are within 1e-7 of 1
    {Decision::thrust_gate, "thrust gate", of_input},
    {Decision::integrator_gate, "integrator gate", of_law},
    {Decision::rattitude, "rattitude", of_input},
    {Decision::shorter_rotation, "shorter rotation", of_law},
    {Decision::yaw_wrap, "yaw at +-180 deg", of_law},
    {Decision::tilt_axis, "tilt at 180 deg", 1.7e-3},  // where Tolerances::widening ends
    {Decision::battery_scale, "battery scale", of_input},
    {Decision::recovery_latch, "recovery's latch", of_law},
    {Decision::recovery_rotation, "recovery's rotation", of_law},
    {Decision::mixer_limit, "mixer limit", of_law},
    {Decision::mixer_branch, "mixer branch", of_law},
    {Decision::mixer_yaw, "mixer yaw", of_law},
    {Decision::opposite_thrust, "opposite thrust", of_input},
    {Decision::yaw_weight, "yaw weight", of_input},
    {Decision::spool_up, "spool-up time", 2e-6},  // float32's resolution at the longest, 30 s
    {Decision::lowest_throttle, "lowest throttle", of_input},
    {Decision::heading_pole, "heading's pole", 3e-4},  // rounding changes the pitch there by 1e-4
    {Decision::heading_wrap, "heading at +-180 deg", of_law},
    {Decision::convergence, "heading's convergence", of_law},
    {Decision::yaw_lock, "yaw lock", of_ratio},
    {Decision::saturation_flag, "saturation flag", of_ratio},
    {Decision::yaw_cutoff, "yaw cutoff", of_ratio},
    {Decision::overflow, "overflow", of_ratio},
}};

constexpr bool is_in_order() {
  for (std::size_t i = 0; i < all_traits.size(); ++i) {
    if (all_traits[i].decision != static_cast<Decision>(i)) return false;
  }
  return true;
}
static_assert(is_in_order());

const DecisionTraits& traits_of(Decision decision) {
  return all_traits[static_cast<std::size_t>(decision)];
}

}  // namespace

std::string_view name_of(Decision decision) { return traits_of(decision).name; }

double least_margin(Decision decision) { return traits_of(decision).least_margin; }

bool is_nearer(Decision decision, const Margin& one, const Margin& other) {
  if (std::isinf(one.distance) || std::isinf(other.distance)) return !std::isinf(one.distance);
  const bool larger_is_nearer = decision == Decision::quaternion_norm;
  return larger_is_nearer ? one.distance > other.distance : one.distance < other.distance;
}

bool Margins::is_safe(Decision decision) const {
  return !is_nearer(decision, (*this)[decision], {least_margin(decision)});
}

void Margins::note(Decision decision, double distance, std::size_t tick) {
  Margin& nearest = of[static_cast<std::size_t>(decision)];
  const Margin one{distance, tick};
  if (!std::isnan(distance) && is_nearer(decision, one, nearest)) nearest = one;
}

double least_margin(Decision decision, std::optional<int> fraction_bits) {
  const double of_floats = least_margin(decision);
  return fraction_bits ? std::max(of_floats, std::ldexp(decision_lsb, -*fraction_bits)) : of_floats;
}

}  // namespace attest
