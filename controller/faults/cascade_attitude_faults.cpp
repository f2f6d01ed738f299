// Wrong errors of the attitude and wrong gains in the attitude law of the cascade.
#include <algorithm>
#include <cmath>

#include "controller/elementary/elementary.hpp"
#include "controller/faults/cascade_change.hpp"
#include "controller/faults/groups.hpp"

namespace attest::faults::in_cascade {
namespace {

using cascade::canonical;
using cascade::inverse;
using cascade::product;

// Changes the quaternions of the attitude and of the setpoint.
template <typename Change>
void change_both_attitudes(FaultyLaw& law, Change change) {
  also_before(law.attitude_unit, [change](AttitudeIn& in) {
    change(in.vehicle_attitude.q);
    change(in.vehicle_attitude_setpoint.q_d);
  });
}

// The rotation vector: axis times angle. The law uses axis times twice the sine of half the angle.
Vector rotation_angle(const Quat& error) {
  const Vector axis = cascade::imaginary_part(error);
  const float sine = cascade::length(axis);
  return sine < 1e-9f ? Vector(axis * 2)
                      : Vector(axis * (2 * elementary::atan2(sine, error[0]) / sine));
}

template <int one, int other>
void exchange_gains(FaultyLaw& law) {
  change_gains(law.attitude_unit, [](AttitudeUnitGains& gains, const CascadeParameters&) {
    std::swap(gains.attitude.proportional_1_s[one], gains.attitude.proportional_1_s[other]);
  });
}

const Fault quaternion_list[] = {
    {"cascade-m-not-canonical", "attitude", Stage::yaw,
     "computes the remaining yaw without the canonical form of the quaternion",
     "attitudes of half of all headings", "two signs of a quaternion",
     [](FaultyLaw& law) {
       law.attitude_unit.attitude.remaining_yaw = [](const Quat& tilted, const Quat& q_WD) {
         return product(inverse(tilted), q_WD);
       };
     }},
    {"cascade-m-sign-of-q", "attitude", Stage::yaw,
     "takes the sign of the remaining yaw from the attitude", "a negative q0",
     "two signs of a quaternion",
     [](FaultyLaw& law) {
       auto sign = std::make_shared<float>(1.0f);
       auto& stages = law.attitude_unit.attitude;
       change_stage(stages.tilt_rotation,
                    [sign](const auto& then, const Quat& q_WB, const Quat& q_WD) {
                      *sign = q_WB[0] < 0 ? -1.0f : 1.0f;
                      return then(q_WB, q_WD);
                    });
       stages.remaining_yaw = [sign](const Quat& tilted, const Quat& q_WD) {
         return Quat(product(inverse(tilted), q_WD) * *sign);
       };
     }},
    {"cascade-error-not-canonical", "large_angle", Stage::tilt,
     "computes the error without the canonical form", "a half turn", "two signs of a quaternion",
     [](FaultyLaw& law) {
       law.attitude_unit.attitude.error = [](const Quat& q_WB, const Quat& target) {
         return product(inverse(q_WB), target);
       };
     }},
    {"cascade-quat-order-xyzw", "attitude", Stage::input, "takes quaternions as x, y, z, w",
     "any attitude", "quaternion order",
     [](FaultyLaw& law) {
       change_both_attitudes(law, [](float(&q)[4]) { std::rotate(q, q + 1, q + 4); });
     }},
    {"cascade-attitudes-conjugated", "attitude", Stage::input,
     "takes attitude and setpoint as rotations of the world into the body",
     "a tilt of the attitude together with a yaw", "transposed rotation",
     [](FaultyLaw& law) {
       change_both_attitudes(law, [](float(&q)[4]) {
         for (int i = 1; i < 4; ++i) q[i] = -q[i];
       });
     }},
    {"cascade-attitude-from-enu", "attitude", Stage::input,
     "takes both attitudes in the axes FLU and ENU", "any tilt", "another frame",
     [](FaultyLaw& law) {
       change_both_attitudes(law, [](float(&q)[4]) { q[2] = -q[2], q[3] = -q[3]; });
     }},
    {"cascade-error-in-world", "attitude", Stage::tilt, "computes the error in world axes",
     "a yaw or a tilt of the attitude", "factors exchanged",
     [](FaultyLaw& law) {
       law.attitude_unit.attitude.error = [](const Quat& q_WB, const Quat& target) {
         return canonical(product(target, inverse(q_WB)));
       };
     }},
    {"cascade-error-reversed", "attitude", Stage::tilt, "turns away from the setpoint", "any error",
     "a sign",
     [](FaultyLaw& law) {
       law.attitude_unit.attitude.error = [](const Quat& q_WB, const Quat& target) {
         return canonical(product(inverse(target), q_WB));
       };
     }},
    {"cascade-error-not-doubled", "attitude", Stage::p,
     "takes the imaginary part of the error once, not twice", "any error", "a missing factor",
     [](FaultyLaw& law) {
       law.attitude_unit.attitude.proportional = [](const Quat& error,
                                                    const QuaternionGains& gains) {
         return Vector(cascade::imaginary_part(error).cwiseProduct(gains.proportional_1_s));
       };
     }},
    {"cascade-error-is-angle", "attitude", Stage::p,
     "takes the angle of the error instead of twice the sine of its half", "an error of 60 deg",
     "another error",
     [](FaultyLaw& law) {
       law.attitude_unit.attitude.proportional = [](const Quat& error,
                                                    const QuaternionGains& gains) {
         return Vector(rotation_angle(error).cwiseProduct(gains.proportional_1_s));
       };
     }},
    {"cascade-error-is-sine", "attitude", Stage::p,
     "takes the sine of the whole error, not of its half", "an error of 60 deg", "another error",
     [](FaultyLaw& law) {
       law.attitude_unit.attitude.proportional = [](const Quat& error,
                                                    const QuaternionGains& gains) {
         const Vector sine = cascade::imaginary_part(error) * (2 * error[0]);
         return Vector(sine.cwiseProduct(gains.proportional_1_s));
       };
     }},
    {"cascade-tilt-in-body", "attitude", Stage::tilt,
     "applies the tilt rotation in the body frame: q r", "a tilt at a heading other than north",
     "factors exchanged",
     [](FaultyLaw& law) {
       law.attitude_unit.attitude.tilted = [](const Quat& tilt, const Quat& q_WB) {
         return product(q_WB, tilt);
       };
     }},
    {"cascade-tilt-backwards", "attitude", Stage::tilt,
     "turns the desired thrust axis to the present one", "any tilt error", "arguments exchanged",
     [](FaultyLaw& law) {
       change_stage(
           law.attitude_unit.attitude.tilt_rotation,
           [](const auto& then, const Quat& q_WB, const Quat& q_WD) { return then(q_WD, q_WB); });
     }},
    {"cascade-tilt-axes-in-body", "attitude", Stage::tilt,
     "compares the world's z axis in the two bodies, not the bodies' z axes in the world",
     "a tilt error at a heading other than north", "transposed rotation",
     [](FaultyLaw& law) {
       change_stage(law.attitude_unit.attitude.tilt_rotation,
                    [](const auto& then, const Quat& q_WB, const Quat& q_WD) {
                      return then(conjugated(q_WB), conjugated(q_WD));
                    });
     }},
    {"cascade-target-elementwise", "attitude", Stage::blend,
     "multiplies the target's quaternions element by element", "any yaw error", "another product",
     [](FaultyLaw& law) {
       law.attitude_unit.attitude.target = [](const Quat& tilted, const Quat& yaw) {
         return Quat(tilted.cwiseProduct(yaw));
       };
     }},
    {"cascade-target-yaw-in-world", "attitude", Stage::blend,
     "turns the target's yaw about the world's z axis", "a tilted setpoint and a yaw error",
     "factors exchanged",
     [](FaultyLaw& law) {
       law.attitude_unit.attitude.target = [](const Quat& tilted, const Quat& yaw) {
         return product(yaw, tilted);
       };
     }},
    {"cascade-setpoint-not-normalised", "attitude", Stage::input,
     "does not normalise the attitude setpoint", "a setpoint of another norm", "a missing step",
     [](FaultyLaw& law) {
       law.attitude_unit.attitude.setpoint = [](const Quat& given) { return given; };
     }},
    {"cascade-roll-yaw-gains", "attitude", Stage::p, "exchanges the gains of roll and yaw",
     "any error", "wrong axis", exchange_gains<0, 2>},
    {"cascade-pitch-yaw-gains", "attitude", Stage::p, "exchanges the gains of pitch and yaw",
     "any error", "wrong axis", exchange_gains<1, 2>},
    {"cascade-pitch-reversed", "attitude", Stage::p, "reverses pitch", "a pitch error", "a sign",
     [](FaultyLaw& law) {
       change_stage(law.attitude_unit.attitude.proportional,
                    [](const auto& then, const Quat& error, const QuaternionGains& gains) {
                      Vector rates = then(error, gains);
                      rates[1] = -rates[1];
                      return rates;
                    });
     }},
    {"cascade-thrust-z-only", "attitude", Stage::output,
     "passes on the z component of the thrust only", "a setpoint with thrust along x or y",
     "a missing axis",
     [](FaultyLaw& law) {
       also_after(law.attitude_unit, [](const AttitudeIn&, AttitudeOut& out) {
         float(&thrust)[3] = out.vehicle_rates_setpoint.thrust_body;
         thrust[0] = thrust[1] = 0;
       });
     }},
    {"cascade-thrust-up", "attitude", Stage::output, "passes on the thrust with the other sign",
     "any thrust", "a sign",
     [](FaultyLaw& law) {
       also_after(law.attitude_unit, [](const AttitudeIn&, AttitudeOut& out) {
         float& thrust = out.vehicle_rates_setpoint.thrust_body[2];
         if (out.vehicle_rates_setpoint.published != 0) thrust = -thrust;
       });
     }},
    {"cascade-thrust-clamped", "attitude", Stage::output, "clamps the thrust to -1 .. 0",
     "a thrust beyond that", "a helpful extra",
     [](FaultyLaw& law) {
       also_after(law.attitude_unit, [](const AttitudeIn&, AttitudeOut& out) {
         float& thrust = out.vehicle_rates_setpoint.thrust_body[2];
         thrust = std::clamp(thrust, -1.0f, 0.0f);
       });
     }},
};

}  // namespace

std::span<const Fault> attitude_faults() { return quaternion_list; }

}  // namespace attest::faults::in_cascade
