// Mistakes of the attitude law of the cascade that show at half turns: opposite thrust directions,
// axes of a half turn, headings near the poles.
#include <cmath>

#include "controller/elementary/elementary.hpp"
#include "controller/faults/cascade_change.hpp"
#include "controller/faults/groups.hpp"

namespace attest::faults::in_cascade {
namespace {

using cascade::inverse;
using cascade::product;

// Replaces the test whether the thrust directions are opposite. Test is bool(const Quat& tilt).
template <typename Test>
void change_opposite(FaultyLaw& law, Test test) {
  law.attitude_unit.attitude.is_opposite = test;
}

// Makes w positive. The law makes the first component that is not almost 0 positive.
Quat with_positive_w(const Quat& q) { return q[0] < 0 ? Quat(-q) : q; }

// tilt_rotation() with another axis for opposite directions. Axis, Vector(const Vector& a), returns
// it for the present thrust direction `a`.
template <typename Axis>
void change_half_turn_axis(FaultyLaw& law, Axis axis) {
  change_stage(law.attitude_unit.attitude.tilt_rotation, [axis](const auto& then, const Quat& q_WB,
                                                                const Quat& q_WD) {
    const Vector a = cascade::z_axis(q_WB), b = cascade::z_axis(q_WD);
    const bool opposite = cascade::length(cascade::cross(a, b)) < 1e-5f && cascade::dot(a, b) < 0;
    if (!opposite) return then(q_WB, q_WD);
    const Vector turn = axis(a);
    return cascade::unit<Scalar>({0, turn[0], turn[1], turn[2]});
  });
}

// The heading by the general formula, also at the poles, where yaw and roll are about one axis.
Scalar heading_without_poles(const Quat& q, const CascadeTraits& law) {
  const float R00 = law.squares_heading ? q[0] * q[0] + q[1] * q[1] - q[2] * q[2] - q[3] * q[3]
                                        : 1 - 2 * (q[2] * q[2] + q[3] * q[3]);
  return elementary::atan2(2 * (q[1] * q[2] + q[0] * q[3]), R00);
}

const Fault half_turn_list[] = {
    {"cascade-opposite-ignored", "large_angle", Stage::tilt,
     "has no case for opposite thrust directions", "a roll or pitch of 180 deg", "a missing case",
     [](FaultyLaw& law) { change_opposite(law, [](const Quat&) { return false; }); }},
    {"cascade-opposite-roll-only", "large_angle", Stage::tilt,
     "sees opposite thrust directions in a roll only", "a pitch of 180 deg", "a missing axis",
     [](FaultyLaw& law) {
       change_opposite(law, [](const Quat& r) { return std::abs(r[1]) > 0.99999f; });
     }},
    {"cascade-opposite-pitch-only", "large_angle", Stage::tilt,
     "sees opposite thrust directions in a pitch only", "a roll of 180 deg", "a missing axis",
     [](FaultyLaw& law) {
       change_opposite(law, [](const Quat& r) { return std::abs(r[2]) > 0.99999f; });
     }},
    {"cascade-opposite-positive-only", "large_angle", Stage::tilt,
     "sees opposite thrust directions only if the axis points forward or right",
     "a half turn about an axis that points backward or left", "a missing absolute value",
     [](FaultyLaw& law) {
       change_opposite(law, [](const Quat& r) { return r[1] > 0.99999f || r[2] > 0.99999f; });
     }},
    {"cascade-opposite-by-w", "large_angle", Stage::tilt,
     "tests for opposite thrust directions with w, about any axis",
     "a half turn about an oblique axis", "another test",
     [](FaultyLaw& law) {
       change_opposite(law, [](const Quat& r) { return std::abs(r[0]) < 1e-3f; });
     }},
    {"cascade-opposite-from-90", "large_angle", Stage::tilt,
     "skips the reduction of yaw from tilt errors of 90 deg on",
     "a roll of more than 90 deg with a yaw error", "a wrong threshold",
     [](FaultyLaw& law) {
       change_opposite(law, [](const Quat& r) {
         return std::abs(r[1]) > 0.70710678f || std::abs(r[2]) > 0.70710678f;
       });
     }},
    {"cascade-opposite-from-162", "large_angle", Stage::tilt,
     "skips the reduction of yaw from tilt errors of 162 deg on",
     "a roll of 170 deg with a yaw error", "a wrong threshold",
     [](FaultyLaw& law) {
       change_opposite(law, [](const Quat& r) {
         return std::abs(r[1]) > 0.98768834f || std::abs(r[2]) > 0.98768834f;
       });
     }},
    {"cascade-opposite-keeps-attitude", "large_angle", Stage::tilt,
     "gives up at opposite thrust directions: no tilt is corrected", "a roll of 180 deg",
     "a wrong fallback",
     [](FaultyLaw& law) {
       auto& stages = law.attitude_unit.attitude;
       auto opposite = std::make_shared<bool>(false);
       change_stage(stages.is_opposite, [opposite](const auto& then, const Quat& tilt) {
         *opposite = then(tilt);
         return *opposite;
       });
       change_stage(stages.error,
                    [opposite](const auto& then, const Quat& q_WB, const Quat& target) {
                      if (*opposite) return cascade::identity<Scalar>();
                      return then(q_WB, target);
                    });
     }},
    {"cascade-half-turn-about-x", "large_angle", Stage::tilt,
     "turns about the world's x axis at opposite thrust directions",
     "a half turn with the thrust axis along x", "another axis",
     [](FaultyLaw& law) {
       change_half_turn_axis(
           law, [](const Vector& a) { return cascade::cross(a, Vector(Vector::UnitX())); });
     }},
    {"cascade-half-turn-nearest-axis", "large_angle", Stage::tilt,
     "takes the coordinate axis that is nearest to the thrust axis, not the farthest",
     "a half turn from level", "a comparison reversed",
     [](FaultyLaw& law) {
       change_half_turn_axis(law, [](const Vector& a) {
         int nearest = 0;
         a.cwiseAbs().maxCoeff(&nearest);
         return cascade::cross(a, Vector(Vector::Unit(nearest)));
       });
     }},
    {"cascade-half-turn-missing", "large_angle", Stage::tilt,
     "divides by zero at opposite thrust directions", "a half turn from level", "a missing case",
     [](FaultyLaw& law) {
       change_half_turn_axis(law, [](const Vector&) { return Vector(Vector::Zero()); });
     }},
    {"cascade-half-turn-is-identity", "large_angle", Stage::tilt,
     "takes opposite thrust directions for equal ones", "a half turn from level", "a missing case",
     [](FaultyLaw& law) {
       change_stage(law.attitude_unit.attitude.tilt_rotation,
                    [](const auto& then, const Quat& q_WB, const Quat& q_WD) {
                      const Vector a = cascade::z_axis(q_WB), b = cascade::z_axis(q_WD);
                      if (cascade::length(cascade::cross(a, b)) < 1e-5f)
                        return cascade::identity<Scalar>();
                      return then(q_WB, q_WD);
                    });
     }},
    {"cascade-tilt-of-unit-axis-angle", "large_angle", Stage::tilt,
     "computes the tilt angle with asin: it is at most 90 deg", "a tilt error beyond 90 deg",
     "another angle",
     [](FaultyLaw& law) {
       change_stage(law.attitude_unit.attitude.tilt_rotation, [](const auto& then, const Quat& q_WB,
                                                                 const Quat& q_WD) {
         const Quat r = then(q_WB, q_WD);
         const Vector axis = cascade::imaginary_part(r);
         const float half = cascade::length(axis);
         if (half < 0.70710678f) return r;
         const float angle = elementary::asin(std::min(1.0f, 2 * half * std::abs(r[0])));
         const Vector imaginary = axis * (elementary::sin(angle / 2) / half);
         return Quat(elementary::cos(angle / 2), imaginary[0], imaginary[1], imaginary[2]);
       });
     }},
    {"cascade-error-sign-of-w", "large_angle", Stage::tilt,
     "takes the sign of the error from w alone, also if w is 0", "a half turn backwards",
     "two signs of a quaternion",
     [](FaultyLaw& law) {
       law.attitude_unit.attitude.error = [](const Quat& q_WB, const Quat& target) {
         return with_positive_w(product(inverse(q_WB), target));
       };
     }},
    {"cascade-m-sign-of-w", "large_angle", Stage::yaw,
     "takes the sign of the remaining yaw from w alone, also if w is 0", "a yaw error of 180 deg",
     "two signs of a quaternion",
     [](FaultyLaw& law) {
       law.attitude_unit.attitude.remaining_yaw = [](const Quat& tilted, const Quat& q_WD) {
         return with_positive_w(product(inverse(tilted), q_WD));
       };
     }},
    {"cascade-sign-of-0-is-0", "large_angle", Stage::p,
     "multiplies the error by a sign of w that is 0 for 0", "a half turn", "sign of zero",
     [](FaultyLaw& law) {
       change_stage(law.attitude_unit.attitude.proportional,
                    [](const auto& then, const Quat& error, const QuaternionGains& gains) {
                      const Vector rates = then(error, gains);
                      return error[0] == 0 ? Vector(Vector::Zero()) : rates;
                    });
     }},
    {"cascade-heading-without-poles", "sticks", Stage::sticks,
     "computes the heading near the poles with the usual formula", "sticks at a pitch of 90 deg",
     "a missing case",
     [](FaultyLaw& law) { law.attitude_unit.sticks.heading = heading_without_poles; }},
};

}  // namespace

std::span<const Fault> large_angle_faults() { return half_turn_list; }

}  // namespace attest::faults::in_cascade
