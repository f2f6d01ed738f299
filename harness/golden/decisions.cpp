#include "harness/golden/decisions.hpp"

#include <algorithm>
#include <cmath>

namespace attest {
namespace {

struct DecisionTraits {
  Decision decision;
  std::string_view name;
  double least_margin;
  double on;  // on_threshold(), as a fraction of the least margin
  // reason_for_none()
  std::string_view none_below{}, none_on{}, none_above{};
};

constexpr double of_input = 1e-6;  // inputs differ only by the port's number format
constexpr double of_law = 1e-5;
constexpr double of_ratio = 1e-4;

constexpr double exactly = 0;
constexpr double rounded = 0.2;

constexpr std::string_view no_threshold = "the law has no threshold there: it does not normalise";
constexpr std::string_view one_sided = "the angle between two directions is at most 180 deg";

// In the order of the enumerators.
constexpr std::array<DecisionTraits, decision_count> all_traits{{
    {Decision::quaternion_norm, "norm of quaternions", 1e-6,
     exactly,  // floats' are within 1e-7 of 1
     no_threshold, no_threshold, no_threshold},
    {Decision::thrust_gate, "thrust gate", of_input, exactly},
    {Decision::integrator_gate, "integrator gate", of_law, rounded},
    {Decision::rattitude, "rattitude", of_input, exactly},
    {Decision::shorter_rotation, "shorter rotation", of_law, rounded},
    {Decision::yaw_wrap, "yaw at +-180 deg", of_law, rounded},
    {Decision::tilt_axis, "tilt at 180 deg", 1.7e-3, rounded,  // where Tolerances::widening ends
     one_sided},
    {Decision::battery_scale,
     "battery scale",
     of_input,
     exactly,
     {},
     "0 is the same float in every port, so cases of all levels have it"},
    {Decision::recovery_begin, "recovery's begin", of_law, rounded},
    {Decision::recovery_end, "recovery's end", of_law, rounded},
    {Decision::recovery_side, "recovery's side", of_law, rounded},
    {Decision::recovery_rotation, "recovery's rotation", of_law, rounded},
    {Decision::mixer_limit, "mixer limit", of_law, rounded},
    {Decision::mixer_branch, "mixer branch", of_law, rounded},
    {Decision::mixer_yaw, "mixer yaw", of_law, rounded},
    {Decision::opposite_thrust, "opposite thrust", of_input, rounded},
    {Decision::yaw_weight, "yaw weight", of_input, exactly},
    {Decision::spool_up, "spool-up time", 2e-6, exactly},  // float32's resolution at 30 s
    {Decision::lowest_throttle, "lowest throttle", of_input, exactly},
    {Decision::heading_pole, "heading's pole", 3e-4, rounded},  // rounding of the pitch there: 1e-4
    {Decision::heading_wrap, "heading at +-180 deg", of_law, rounded},
    {Decision::convergence, "heading's convergence", of_law, rounded},
    {Decision::yaw_lock, "yaw lock", of_ratio, rounded},
    {Decision::saturation_flag, "saturation flag", of_ratio, exactly},
    {Decision::yaw_cutoff, "yaw cutoff", of_ratio, exactly},
    {Decision::overflow,
     "overflow",
     of_ratio,
     rounded,
     {},
     {},
     "a correct port in double does not overflow there"},
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

double on_threshold(Decision decision) {
  return traits_of(decision).on * traits_of(decision).least_margin;
}

std::string_view name_of(Place place) {
  return place == Place::on ? "on" : place == Place::below ? "below" : "above";
}

std::string_view reason_for_none(Decision decision, Place place) {
  const DecisionTraits& traits = traits_of(decision);
  return place == Place::on      ? traits.none_on
         : place == Place::below ? traits.none_below
                                 : traits.none_above;
}

bool is_nearer(Decision decision, const Margin& one, const Margin& other) {
  if (!one.is_measured() || !other.is_measured()) return one.is_measured();
  const bool larger_is_nearer = decision == Decision::quaternion_norm;
  return larger_is_nearer ? one.distance > other.distance : one.distance < other.distance;
}

const Margin& Margins::operator[](Decision decision) const {
  const Margin &below = at(decision, Side::below), &above = at(decision, Side::above);
  return is_nearer(decision, below, above) ? below : above;
}

bool Margins::is_safe(Decision decision) const {
  return !is_nearer(decision, (*this)[decision], {least_margin(decision)});
}

void Margins::note(Decision decision, double from_threshold, std::size_t tick) {
  Margin& nearest = at(decision, from_threshold < 0 ? Side::below : Side::above);
  const Margin one{std::abs(from_threshold), tick};
  if (!std::isnan(from_threshold) && is_nearer(decision, one, nearest)) nearest = one;
}

void Margins::note(const Margins& at_tick, std::size_t tick) {
  for (const DecisionTraits& traits : all_traits) {
    for (const Side side : both_sides) {
      Margin& nearest = at(traits.decision, side);
      const Margin one{at_tick.at(traits.decision, side).distance, tick};
      if (is_nearer(traits.decision, one, nearest)) nearest = one;
    }
  }
}

double least_margin(Decision decision, std::optional<int> fraction_bits) {
  const double of_floats = least_margin(decision);
  return fraction_bits ? std::max(of_floats, std::ldexp(decision_lsb, -*fraction_bits)) : of_floats;
}

}  // namespace attest
