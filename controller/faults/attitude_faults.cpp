// Wrong attitudes, wrong tilt errors and wrong gains of the attitude loop.
#include <algorithm>
#include <cmath>
#include <utility>

#include "controller/elementary/elementary.hpp"
#include "controller/faults/groups.hpp"

namespace attest::faults {
namespace {

namespace ordered = mc_att_control::ordered;

using Q = float[4];

// Changes the quaternions of the state and of the setpoint.
template <typename Change>
void change_attitudes(FaultyLaw& law, Change change) {
  also_before(law, [change](attest_inputs& in) {
    change(in.control_state.q);
    change(in.vehicle_attitude_setpoint.q_d);
  });
}

void rotate_order(Q& q) { std::rotate(q, q + 1, q + 4); }
void conjugate(Q& q) {
  for (int i = 1; i < 4; ++i) q[i] = -q[i];
}
void normalise(Q& q) {
  const float norm = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  if (!(norm > 0)) return;
  for (float& component : q) component /= norm;
}

// The tilt error with another function from sine and cosine to the angle.
template <typename Angle>
void change_tilt_angle(FaultyLaw& law, Angle angle) {
  change_stage(law.attitude.tilt_error,
               [angle](const auto& then, const Matrix& R_WB, const Matrix& R_WD) {
                 Tilt tilt = then(R_WB, R_WD);
                 if (tilt.sine > 0) tilt.rotation_B = tilt.axis_B * angle(tilt.sine, tilt.cosine);
                 return tilt;
               });
}

// The tilt error with an axis other than R^T (z x z_sp).
template <typename Axis>
void change_tilt_axis(FaultyLaw& law, Axis axis) {
  law.attitude.tilt_error = [axis](const Matrix& R_WB, const Matrix& R_WD) {
    Tilt tilt;
    tilt.rotation_B = axis(R_WB, Vector(R_WB.col(2)), Vector(R_WD.col(2)));
    tilt.sine = ordered::length(tilt.rotation_B);
    tilt.cosine = ordered::dot<float>(R_WB.col(2), R_WD.col(2));
    if (tilt.sine > 0) {
      tilt.axis_B = tilt.rotation_B / tilt.sine;
      tilt.rotation_B = tilt.axis_B * elementary::atan2(tilt.sine, tilt.cosine);
    }
    return tilt;
  };
}

const Fault attitude_list[] = {
    {"quat-order-xyzw", "attitude", Stage::input, "takes quaternions as x, y, z, w",
     "any attitude except level", "quaternion order",
     [](FaultyLaw& law) { change_attitudes(law, [](Q& q) { rotate_order(q); }); }},
    {"quat-order-state", "attitude", Stage::input, "takes the state's quaternion as x, y, z, w",
     "any attitude", "quaternion order",
     [](FaultyLaw& law) {
       also_before(law, [](attest_inputs& in) { rotate_order(in.control_state.q); });
     }},
    {"quat-order-setpoint", "attitude", Stage::input,
     "takes the setpoint's quaternion as x, y, z, w", "any setpoint", "quaternion order",
     [](FaultyLaw& law) {
       also_before(law, [](attest_inputs& in) { rotate_order(in.vehicle_attitude_setpoint.q_d); });
     }},
    {"quat-conjugated-state", "attitude", Stage::input,
     "takes the state's quaternion as world to body", "any attitude except level", "transposition",
     [](FaultyLaw& law) {
       also_before(law, [](attest_inputs& in) { conjugate(in.control_state.q); });
     }},
    {"quat-conjugated-setpoint", "attitude", Stage::input,
     "takes the setpoint's quaternion as world to body", "any setpoint except level",
     "transposition",
     [](FaultyLaw& law) {
       also_before(law, [](attest_inputs& in) { conjugate(in.vehicle_attitude_setpoint.q_d); });
     }},
    {"quat-conjugated-both", "attitude", Stage::input, "takes both quaternions as world to body",
     "tilted away from the setpoint while both are tilted", "transposition",
     [](FaultyLaw& law) { change_attitudes(law, [](Q& q) { conjugate(q); }); }},
    {"attitudes-exchanged", "attitude", Stage::input, "exchanges the setpoint and the state",
     "any error", "handedness",
     [](FaultyLaw& law) {
       also_before(law, [](attest_inputs& in) {
         std::swap_ranges(in.control_state.q, in.control_state.q + 4,
                          in.vehicle_attitude_setpoint.q_d);
       });
     }},
    {"frame-flu", "attitude", Stage::input, "takes attitudes in FLU and ENU as in FRD and NED",
     "pitch or yaw", "handedness",
     [](FaultyLaw& law) {
       change_attitudes(law, [](Q& q) {
         q[2] = -q[2];
         q[3] = -q[3];
       });
     }},
    {"quat-left-handed", "attitude", Stage::input, "multiplies quaternions left-handedly",
     "two axes at once", "handedness",
     [](FaultyLaw& law) { change_attitudes(law, [](Q& q) { q[3] = -q[3]; }); }},
    {"quat-normalised", "attitude", Stage::input, "normalises quaternions",
     "a quaternion whose norm is not 1", "a helpful extra",
     [](FaultyLaw& law) { change_attitudes(law, [](Q& q) { normalise(q); }); }},
    {"quat-positive-w", "attitude", Stage::input, "drops the sign of w",
     "the other quaternion of an attitude", "quaternion order",
     [](FaultyLaw& law) { change_attitudes(law, [](Q& q) { q[0] = std::abs(q[0]); }); }},
    {"tilt-in-world", "attitude", Stage::tilt, "leaves the tilt axis in world axes",
     "a heading, or a tilted vehicle", "transposition",
     [](FaultyLaw& law) {
       change_tilt_axis(law, [](const Matrix&, const Vector& z, const Vector& z_sp) {
         return ordered::cross(z, z_sp);
       });
     }},
    {"tilt-by-R", "attitude", Stage::tilt, "turns the tilt axis by R instead of its transpose",
     "a heading, or a tilted vehicle", "transposition",
     [](FaultyLaw& law) {
       change_tilt_axis(law, [](const Matrix& R, const Vector& z, const Vector& z_sp) {
         return ordered::times<float>(R, ordered::cross(z, z_sp));
       });
     }},
    {"tilt-cross-reversed", "attitude", Stage::tilt, "computes z_sp x z instead of z x z_sp",
     "any tilt error", "handedness",
     [](FaultyLaw& law) {
       change_tilt_axis(law, [](const Matrix& R, const Vector& z, const Vector& z_sp) {
         return ordered::transpose_times<float>(R, ordered::cross(z_sp, z));
       });
     }},
    {"tilt-cross-sign", "attitude", Stage::tilt, "has one sign wrong in the cross product",
     "a tilt error about pitch", "handedness",
     [](FaultyLaw& law) {
       change_tilt_axis(law, [](const Matrix& R, const Vector& z, const Vector& z_sp) {
         Vector e = ordered::cross(z, z_sp);
         e[1] = z[2] * z_sp[0] + z[0] * z_sp[2];
         return ordered::transpose_times<float>(R, e);
       });
     }},
    {"tilt-as-sine", "attitude", Stage::tilt, "uses the sine as the angle", "a tilt of 20 deg",
     "a small-angle shortcut",
     [](FaultyLaw& law) { change_tilt_angle(law, [](float s, float) { return s; }); }},
    {"tilt-sine-is-0", "attitude", Stage::tilt, "takes the sine of the tilt error for 0",
     "any tilt", "a missing term",
     [](FaultyLaw& law) {
       change_tilt_angle(law, [](float, float c) { return elementary::atan2(0.0f, c); });
     }},
    {"tilt-by-asin", "attitude", Stage::tilt, "uses asin instead of atan2", "a tilt beyond 90 deg",
     "atan2 arguments",
     [](FaultyLaw& law) {
       change_tilt_angle(law, [](float s, float) { return elementary::asin(std::min(s, 1.0f)); });
     }},
    {"tilt-by-acos", "attitude", Stage::tilt, "uses acos, which has no resolution near 0",
     "a tilt of a fraction of a degree", "atan2 arguments",
     [](FaultyLaw& law) {
       change_tilt_angle(
           law, [](float, float c) { return elementary::acos(std::clamp(c, -1.0f, 1.0f)); });
     }},
    {"tilt-atan2-exchanged", "attitude", Stage::tilt, "exchanges the arguments of atan2",
     "any tilt except 45 deg", "atan2 arguments",
     [](FaultyLaw& law) {
       change_tilt_angle(law, [](float s, float c) { return elementary::atan2(c, s); });
     }},
    {"tilt-atan", "attitude", Stage::tilt, "uses atan(s / c)", "a tilt beyond 90 deg",
     "atan2 arguments",
     [](FaultyLaw& law) {
       change_tilt_angle(law, [](float s, float c) { return elementary::atan2(s / c, 1.0f); });
     }},
    {"tilt-in-degrees", "attitude", Stage::tilt, "leaves the tilt in degrees", "any tilt error",
     "degrees",
     [](FaultyLaw& law) {
       change_tilt_angle(law,
                         [](float s, float c) { return elementary::atan2(s, c) * (180 / pi); });
     }},
    {"tilt-halved", "attitude", Stage::tilt, "uses half of the angle, as in a quaternion",
     "any tilt error", "quaternion order",
     [](FaultyLaw& law) {
       change_tilt_angle(law, [](float s, float c) { return elementary::atan2(s, c) / 2; });
     }},
    {"tilt-not-normalised", "attitude", Stage::tilt, "does not divide the axis by its length",
     "any tilt error", "a missing normalisation",
     [](FaultyLaw& law) {
       change_tilt_angle(law, [](float s, float c) { return elementary::atan2(s, c) * s; });
     }},
    {"tilt-dead-zone", "attitude", Stage::tilt, "treats tilts below 0.01 rad as 0",
     "a tilt error below 0.6 deg", "a helpful extra",
     [](FaultyLaw& law) {
       change_tilt_angle(law, [](float sine, float cosine) {
         const float angle = elementary::atan2(sine, cosine);
         return angle < 0.01f ? 0.0f : angle;
       });
     }},
    {"tilt-dead-band", "attitude", Stage::tilt, "treats tilts below 0.06 deg as 0", "a tiny error",
     "wrong branch threshold",
     [](FaultyLaw& law) {
       change_stage(law.attitude.tilt_error,
                    [](const auto& then, const Matrix& R_WB, const Matrix& R_WD) {
                      Tilt tilt = then(R_WB, R_WD);
                      if (tilt.sine < 1e-3f) {
                        tilt.sine = 0;
                        tilt.rotation_B.setZero();
                      }
                      return tilt;
                    });
     }},
    {"fast-atan2", "attitude", Stage::tilt, "approximates atan2 to 4e-3", "a tilt of 10 to 80 deg",
     "fast math",
     [](FaultyLaw& law) {
       change_tilt_angle(law, [](float s, float c) {
         const float a = std::min(s, std::abs(c)) / std::max(s, std::abs(c));
         float angle = a * (pi / 4 + 0.273f * (1 - a));
         if (s > std::abs(c)) angle = pi / 2 - angle;
         return c < 0 ? pi - angle : angle;
       });
     }},
    {"gains-roll-pitch-exchanged", "attitude", Stage::p, "exchanges the gains of roll and pitch",
     "gains that differ", "wrong axis",
     [](FaultyLaw& law) {
       law.attitude.proportional = [](const Vector& e, const AttitudeGains& gains) {
         const Vector& k = gains.proportional_1_s;
         return Vector(e[0] * k[1], e[1] * k[0], e[2] * k[2]);
       };
     }},
    {"gain-of-roll-for-all", "attitude", Stage::p, "uses the roll gain for all axes",
     "gains that differ", "wrong axis",
     [](FaultyLaw& law) {
       law.attitude.proportional = [](const Vector& e, const AttitudeGains& gains) {
         return Vector(e * gains.proportional_1_s[0]);
       };
     }},
    {"direct-everywhere", "attitude", Stage::blend, "uses the quaternion error at all tilts",
     "a tilt of 30 deg, or a tilted setpoint with a yaw error", "another law",
     [](FaultyLaw& law) {
       law.attitude.is_upset = [](float) { return true; };
       law.attitude.blend = [](const Vector&, const Vector& direct, float, float) {
         return direct;
       };
     }},
    {"direct-weighted", "attitude", Stage::blend,
     "uses the quaternion error at all tilts, with the yaw weight on its yaw",
     "a tilt of 30 deg, or a tilted setpoint with a yaw error", "another law",
     [](FaultyLaw& law) {
       law.attitude.is_upset = [](float) { return true; };
       law.attitude.blend = [](const Vector&, const Vector& direct, float, float weight) {
         return Vector(direct[0], direct[1], direct[2] * weight);
       };
     }},
    {"outputs-late", "attitude", Stage::output, "publishes its outputs one tick late",
     "anything that changes", "one-tick delay",
     [](FaultyLaw& law) {
       also_after(law,
                  [last = attest_outputs{}](const attest_inputs&, attest_outputs& out) mutable {
                    std::swap(last, out);
                  });
     }},
    {"state-late", "attitude", Stage::input, "uses the state of the previous tick",
     "an attitude that moves", "one-tick delay",
     [](FaultyLaw& law) {
       also_before(law, [last = decltype(attest_inputs::control_state){},
                         first = true](attest_inputs& in) mutable {
         if (first) last = in.control_state;
         first = false;
         std::swap(last, in.control_state);
       });
     }},
    {"setpoint-late", "attitude", Stage::input, "uses the setpoint of the previous tick",
     "a setpoint that moves", "one-tick delay",
     [](FaultyLaw& law) {
       also_before(law, [last = decltype(attest_inputs::vehicle_attitude_setpoint){},
                         first = true](attest_inputs& in) mutable {
         if (first) last = in.vehicle_attitude_setpoint;
         first = false;
         std::swap(last, in.vehicle_attitude_setpoint);
         in.updated |= ATTEST_UPDATED_VEHICLE_ATTITUDE_SETPOINT;
       });
     }},
    {"state-in-12-bits", "attitude", Stage::input, "holds quaternions in 12 bits",
     "any attitude except level", "fixed point",
     [](FaultyLaw& law) {
       change_attitudes(law, [](Q& q) {
         for (float& component : q) component = std::round(component * 2048) / 2048;
       });
     }},
};

}  // namespace

std::span<const Fault> attitude_faults() { return attitude_list; }

}  // namespace attest::faults
