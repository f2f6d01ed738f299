// Wrong ways from an attitude and its setpoint to the rotation error.
#include <algorithm>
#include <cmath>
#include <utility>

#include "controller/faults/groups.hpp"

namespace attest::faults {
namespace {

namespace ordered = reference::ordered;

constexpr float pi = 3.14159265358979323846f;

using Q = float[4];

// Both attitudes, each by its own.
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

// The tilt error with another way from sine and cosine to the angle.
template <typename Angle>
void change_tilt_angle(FaultyLaw& law, Angle angle) {
  law.attitude.tilt_error = [angle](const Matrix& R_WB, const Matrix& R_WD) {
    Tilt tilt = AttitudeStages::Law::tilt_error(R_WB, R_WD);
    if (tilt.sine > 0) tilt.rotation_B = tilt.axis_B * angle(tilt.sine, tilt.cosine);
    return tilt;
  };
}

// The tilt error with another axis than R^T (z x z_sp).
template <typename Axis>
void change_tilt_axis(FaultyLaw& law, Axis axis) {
  law.attitude.tilt_error = [axis](const Matrix& R_WB, const Matrix& R_WD) {
    Tilt tilt;
    tilt.rotation_B = axis(R_WB, Vector(R_WB.col(2)), Vector(R_WD.col(2)));
    tilt.sine = ordered::length(tilt.rotation_B);
    tilt.cosine = ordered::dot<float>(R_WB.col(2), R_WD.col(2));
    if (tilt.sine > 0) {
      tilt.axis_B = tilt.rotation_B / tilt.sine;
      tilt.rotation_B = tilt.axis_B * std::atan2(tilt.sine, tilt.cosine);
    }
    return tilt;
  };
}

// R (I + by_sine K + by_square K K), its first column.
template <typename Terms>
void change_rodrigues(FaultyLaw& law, Terms terms) {
  law.attitude.nose_after_tilt = [terms](const Matrix& R_WB, const Tilt& tilt) -> Vector {
    if (!(tilt.sine > 0)) return R_WB.col(0);
    const Matrix K = reference::cross_product_matrix(tilt.axis_B);
    const auto [by_sine, by_square] = terms(tilt);
    const Matrix turn = Matrix::Identity() + K * by_sine + (K * K) * by_square;
    return R_WB * Vector(turn.col(0));
  };
}

template <typename Change>
void change_yaw_error(FaultyLaw& law, Change change) {
  law.attitude.yaw_error = [change](const Vector& nose, const Matrix& R_WD, float weight) {
    const Vector x = R_WD.col(0), z = R_WD.col(2);
    const float sine = ordered::dot(ordered::cross(nose, x), z);
    return change(sine, ordered::dot(nose, x)) * weight;
  };
}

const Fault faults[] = {
    {"quat-order-xyzw", "attitude", Stage::input, "takes quaternions as x, y, z, w",
     "any attitude but level", "quaternion order",
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
     "takes the state's quaternion as world to body", "any attitude but level", "transposition",
     [](FaultyLaw& law) {
       also_before(law, [](attest_inputs& in) { conjugate(in.control_state.q); });
     }},
    {"quat-conjugated-setpoint", "attitude", Stage::input,
     "takes the setpoint's quaternion as world to body", "any setpoint but level", "transposition",
     [](FaultyLaw& law) {
       also_before(law, [](attest_inputs& in) { conjugate(in.vehicle_attitude_setpoint.q_d); });
     }},
    {"quat-conjugated-both", "attitude", Stage::input, "takes both quaternions as world to body",
     "tilted away from the setpoint while both are tilted", "transposition",
     [](FaultyLaw& law) { change_attitudes(law, [](Q& q) { conjugate(q); }); }},
    {"attitudes-exchanged", "attitude", Stage::input, "takes the setpoint for the state",
     "any error", "handedness",
     [](FaultyLaw& law) {
       also_before(law, [](attest_inputs& in) {
         std::swap_ranges(in.control_state.q, in.control_state.q + 4,
                          in.vehicle_attitude_setpoint.q_d);
       });
     }},
    {"frame-flu", "attitude", Stage::input, "takes attitudes in FLU and ENU as if FRD and NED",
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
    {"tilt-cross-reversed", "attitude", Stage::tilt, "takes z_sp x z", "any tilt error",
     "handedness",
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
    {"tilt-as-sine", "attitude", Stage::tilt, "takes the sine for the angle", "a tilt of 20 deg",
     "a small-angle shortcut",
     [](FaultyLaw& law) { change_tilt_angle(law, [](float s, float) { return s; }); }},
    {"tilt-by-asin", "attitude", Stage::tilt, "takes asin for atan2", "a tilt beyond 90 deg",
     "atan2 arguments",
     [](FaultyLaw& law) {
       change_tilt_angle(law, [](float s, float) { return std::asin(std::min(s, 1.0f)); });
     }},
    {"tilt-by-acos", "attitude", Stage::tilt, "takes acos, which has no resolution near 0",
     "a tilt of a fraction of a degree", "atan2 arguments",
     [](FaultyLaw& law) {
       change_tilt_angle(law, [](float, float c) { return std::acos(std::clamp(c, -1.0f, 1.0f)); });
     }},
    {"tilt-atan2-exchanged", "attitude", Stage::tilt, "exchanges the arguments of atan2",
     "any tilt but 45 deg", "atan2 arguments",
     [](FaultyLaw& law) {
       change_tilt_angle(law, [](float s, float c) { return std::atan2(c, s); });
     }},
    {"tilt-atan", "attitude", Stage::tilt, "takes atan(s / c)", "a tilt beyond 90 deg",
     "atan2 arguments",
     [](FaultyLaw& law) {
       change_tilt_angle(law, [](float s, float c) { return std::atan(s / c); });
     }},
    {"tilt-in-degrees", "attitude", Stage::tilt, "leaves the tilt in degrees", "any tilt error",
     "degrees",
     [](FaultyLaw& law) {
       change_tilt_angle(law, [](float s, float c) { return std::atan2(s, c) * (180 / pi); });
     }},
    {"tilt-halved", "attitude", Stage::tilt, "takes half of the angle, as in a quaternion",
     "any tilt error", "quaternion order",
     [](FaultyLaw& law) {
       change_tilt_angle(law, [](float s, float c) { return std::atan2(s, c) / 2; });
     }},
    {"tilt-not-normalised", "attitude", Stage::tilt, "does not divide the axis by its length",
     "any tilt error", "a missing normalisation",
     [](FaultyLaw& law) {
       change_tilt_angle(law, [](float s, float c) { return std::atan2(s, c) * s; });
     }},
    {"tilt-dead-band", "attitude", Stage::tilt, "takes tilts below 0.06 deg for none",
     "a tiny error", "wrong branch threshold",
     [](FaultyLaw& law) {
       law.attitude.tilt_error = [](const Matrix& R_WB, const Matrix& R_WD) {
         Tilt tilt = AttitudeStages::Law::tilt_error(R_WB, R_WD);
         if (tilt.sine < 1e-3f) {
           tilt.sine = 0;
           tilt.rotation_B.setZero();
         }
         return tilt;
       };
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
    {"yaw-dropped", "attitude", Stage::yaw, "leaves the yaw error out", "any yaw error",
     "a missing term",
     [](FaultyLaw& law) { change_yaw_error(law, [](float, float) { return 0.0f; }); }},
    {"yaw-reversed", "attitude", Stage::yaw, "has the yaw error's sign wrong", "any yaw error",
     "handedness",
     [](FaultyLaw& law) {
       change_yaw_error(law, [](float s, float c) { return -std::atan2(s, c); });
     }},
    {"yaw-as-sine", "attitude", Stage::yaw, "takes the sine for the yaw error",
     "a yaw error of 20 deg", "a small-angle shortcut",
     [](FaultyLaw& law) { change_yaw_error(law, [](float s, float) { return s; }); }},
    {"yaw-atan2-exchanged", "attitude", Stage::yaw, "exchanges the arguments of the yaw's atan2",
     "any yaw error but 45 deg", "atan2 arguments",
     [](FaultyLaw& law) {
       change_yaw_error(law, [](float s, float c) { return std::atan2(c, s); });
     }},
    {"yaw-positive", "attitude", Stage::yaw, "wraps the yaw error to 0 .. 2 pi",
     "a yaw error to the left", "angle wrapping",
     [](FaultyLaw& law) {
       change_yaw_error(law, [](float s, float c) {
         const float angle = std::atan2(s, c);
         return angle < 0 ? angle + 2 * pi : angle;
       });
     }},
    {"yaw-about-vertical", "attitude", Stage::yaw, "takes the yaw error about the world's vertical",
     "a yaw error with a tilted setpoint", "wrong axis",
     [](FaultyLaw& law) {
       law.attitude.yaw_error = [](const Vector& nose, const Matrix& R_WD, float weight) {
         const Vector x = R_WD.col(0);
         return std::atan2(ordered::cross(nose, x)[2], ordered::dot(nose, x)) * weight;
       };
     }},
    {"yaw-about-x", "attitude", Stage::yaw, "takes the yaw error's sine along x_sp",
     "any yaw error", "wrong axis",
     [](FaultyLaw& law) {
       law.attitude.yaw_error = [](const Vector& nose, const Matrix& R_WD, float weight) {
         const Vector x = R_WD.col(0);
         return std::atan2(ordered::dot(ordered::cross(nose, x), x), ordered::dot(nose, x)) *
                weight;
       };
     }},
    {"yaw-before-tilt", "attitude", Stage::yaw, "takes the nose before the tilt is corrected",
     "yaw and tilt error together", "a missing step",
     [](FaultyLaw& law) {
       law.attitude.nose_after_tilt = [](const Matrix& R, const Tilt&) -> Vector {
         return R.col(0);
       };
     }},
    {"yaw-added", "attitude", Stage::yaw, "adds the yaw error to the third component",
     "a tilted vehicle with a yaw error", "a missing step",
     [](FaultyLaw& law) {
       auto third = std::make_shared<float>(0.0f);
       law.attitude.nose_after_tilt = [third](const Matrix& R, const Tilt& tilt) {
         *third = tilt.rotation_B[2];
         return AttitudeStages::Law::nose_after_tilt(R, tilt);
       };
       law.attitude.yaw_error = [third](const Vector& nose, const Matrix& R_WD, float weight) {
         return AttitudeStages::Law::yaw_error(nose, R_WD, weight) + *third;
       };
     },
     "z x z_sp is normal to z, so R^T (z x z_sp) has no component along the body's z but rounding"},
    {"rodrigues-no-square", "attitude", Stage::yaw, "drops the K K term of Rodrigues' formula",
     "a large tilt with a yaw error", "a missing term",
     [](FaultyLaw& law) {
       change_rodrigues(law, [](const Tilt& t) { return std::pair(t.sine, 0.0f); });
     }},
    {"rodrigues-plus-cosine", "attitude", Stage::yaw, "takes 1 + cos for 1 - cos",
     "yaw with a tilt error", "a sign",
     [](FaultyLaw& law) {
       change_rodrigues(law, [](const Tilt& t) { return std::pair(t.sine, 1 + t.cosine); });
     }},
    {"rodrigues-reversed", "attitude", Stage::yaw, "turns the wrong way in Rodrigues' formula",
     "yaw with a tilt error", "transposition",
     [](FaultyLaw& law) {
       change_rodrigues(law, [](const Tilt& t) { return std::pair(-t.sine, 1 - t.cosine); });
     }},
    {"rodrigues-by-angle", "attitude", Stage::yaw, "takes the angle for its sine",
     "yaw with a large tilt error", "a small-angle shortcut",
     [](FaultyLaw& law) {
       change_rodrigues(law, [](const Tilt& t) {
         return std::pair(std::atan2(t.sine, t.cosine), 1 - t.cosine);
       });
     }},
    {"cross-matrix-not-zeroed", "attitude", Stage::yaw,
     "never zeroes the diagonal of the cross-product matrix", "yaw with a tilt error",
     "uninitialised memory",
     [](FaultyLaw& law) {
       law.attitude.nose_after_tilt = [](const Matrix& R, const Tilt& tilt) -> Vector {
         if (!(tilt.sine > 0)) return R.col(0);
         const Matrix K = reference::cross_product_matrix(tilt.axis_B) + Matrix::Identity();
         const Matrix turn = Matrix::Identity() + K * tilt.sine + (K * K) * (1 - tilt.cosine);
         return R * Vector(turn.col(0));
       };
     }},
    {"yaw-weight-dropped", "attitude", Stage::yaw, "does not weigh the yaw error",
     "a yaw error with a tilted setpoint", "wrong weight",
     [](FaultyLaw& law) { law.attitude.yaw_weight = [](const Matrix&) { return 1.0f; }; }},
    {"yaw-weight-not-squared", "attitude", Stage::yaw, "weighs yaw by the cosine, not its square",
     "a yaw error with a tilted setpoint", "wrong weight",
     [](FaultyLaw& law) { law.attitude.yaw_weight = [](const Matrix& R) { return R(2, 2); }; }},
    {"yaw-weight-of-x", "attitude", Stage::yaw, "weighs yaw by R_sp[0][0]",
     "a setpoint with a heading", "wrong weight",
     [](FaultyLaw& law) {
       law.attitude.yaw_weight = [](const Matrix& R) { return R(0, 0) * R(0, 0); };
     }},
    {"yaw-weight-of-vehicle", "attitude", Stage::yaw, "weighs yaw by the vehicle's tilt",
     "a level vehicle with a tilted setpoint", "wrong weight",
     [](FaultyLaw& law) {
       auto weight = std::make_shared<float>(1.0f);
       also_before(law, [weight](attest_inputs& in) {
         const Matrix R =
             reference::rotation_matrix(reference::quaternion_from<float>(in.control_state.q));
         *weight = R(2, 2) * R(2, 2);
       });
       law.attitude.yaw_weight = [weight](const Matrix&) { return *weight; };
     }},
    {"yaw-weight-not-inverted", "attitude", Stage::yaw,
     "gives an upside-down setpoint no yaw weight", "an inverted setpoint", "wrong weight",
     [](FaultyLaw& law) {
       law.attitude.yaw_weight = [](const Matrix& R) {
         return R(2, 2) > 0 ? R(2, 2) * R(2, 2) : 0.0f;
       };
     }},
    {"gains-roll-pitch-exchanged", "attitude", Stage::p, "exchanges the gains of roll and pitch",
     "gains that differ", "wrong axis",
     [](FaultyLaw& law) {
       law.attitude.proportional = [](const Vector& e, const AttitudeGains& gains) {
         const Vector& k = gains.proportional_1_s;
         return Vector(e[0] * k[1], e[1] * k[0], e[2] * k[2]);
       };
     }},
    {"gain-of-roll-for-all", "attitude", Stage::p, "takes the roll gain for all axes",
     "gains that differ", "wrong axis",
     [](FaultyLaw& law) {
       law.attitude.proportional = [](const Vector& e, const AttitudeGains& gains) {
         return Vector(e * gains.proportional_1_s[0]);
       };
     }},
    {"direct-everywhere", "attitude", Stage::blend, "flies the quaternion error at all tilts",
     "a tilt of 30 deg, or a tilted setpoint with a yaw error", "another law",
     [](FaultyLaw& law) {
       law.attitude.is_upset = [](float) { return true; };
       law.attitude.blend = [](const Vector&, const Vector& direct, float, float) {
         return direct;
       };
     }},
    {"outputs-late", "attitude", Stage::output, "answers one tick late", "anything that changes",
     "one-tick delay",
     [](FaultyLaw& law) {
       also_after(law,
                  [last = attest_outputs{}](const attest_inputs&, attest_outputs& out) mutable {
                    std::swap(last, out);
                  });
     }},
    {"state-late", "attitude", Stage::input, "uses the state of the tick before",
     "an attitude that moves", "one-tick delay",
     [](FaultyLaw& law) {
       also_before(law, [last = decltype(attest_inputs::control_state){},
                         first = true](attest_inputs& in) mutable {
         if (first) last = in.control_state;
         first = false;
         std::swap(last, in.control_state);
       });
     }},
    {"setpoint-late", "attitude", Stage::input, "uses the setpoint of the tick before",
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
     "any attitude but level", "fixed point",
     [](FaultyLaw& law) {
       change_attitudes(law, [](Q& q) {
         for (float& component : q) component = std::round(component * 2048) / 2048;
       });
     }},
};

}  // namespace

std::span<const Fault> attitude_faults() { return faults; }

}  // namespace attest::faults
