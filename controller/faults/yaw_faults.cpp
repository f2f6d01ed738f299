// Wrong yaw errors, and wrong weights of them.
#include <cmath>
#include <utility>

#include "controller/elementary/elementary.hpp"
#include "controller/faults/groups.hpp"

namespace attest::faults {
namespace {

namespace ordered = mc_att_control::ordered;

// The nose is the first column of R (I + by_sine K + by_square K K). Terms returns by_sine and
// by_square.
template <typename Terms>
void change_rodrigues(FaultyLaw& law, Terms terms) {
  law.attitude.nose_after_tilt = [terms](const Matrix& R_WB, const Tilt& tilt) -> Vector {
    if (!(tilt.sine > 0)) return R_WB.col(0);
    const Matrix K = mc_att_control::cross_product_matrix(tilt.axis_B);
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

const Fault yaw_list[] = {
    {"yaw-dropped", "attitude", Stage::yaw, "leaves the yaw error out", "any yaw error",
     "a missing term",
     [](FaultyLaw& law) { change_yaw_error(law, [](float, float) { return 0.0f; }); }},
    {"yaw-reversed", "attitude", Stage::yaw, "has the yaw error's sign wrong", "any yaw error",
     "handedness",
     [](FaultyLaw& law) {
       change_yaw_error(law, [](float s, float c) { return -elementary::atan2(s, c); });
     }},
    {"yaw-as-sine", "attitude", Stage::yaw, "uses the sine as the yaw error",
     "a yaw error of 20 deg", "a small-angle shortcut",
     [](FaultyLaw& law) { change_yaw_error(law, [](float s, float) { return s; }); }},
    {"yaw-atan2-exchanged", "attitude", Stage::yaw, "exchanges the arguments of the yaw's atan2",
     "any yaw error except 45 deg", "atan2 arguments",
     [](FaultyLaw& law) {
       change_yaw_error(law, [](float s, float c) { return elementary::atan2(c, s); });
     }},
    {"yaw-positive", "attitude", Stage::yaw, "wraps the yaw error to 0 .. 2 pi",
     "a yaw error to the left", "angle wrapping",
     [](FaultyLaw& law) {
       change_yaw_error(law, [](float s, float c) {
         const float angle = elementary::atan2(s, c);
         return angle < 0 ? angle + 2 * pi : angle;
       });
     }},
    {"yaw-about-vertical", "attitude", Stage::yaw,
     "computes the yaw error about the world's vertical", "a yaw error with a tilted setpoint",
     "wrong axis",
     [](FaultyLaw& law) {
       law.attitude.yaw_error = [](const Vector& nose, const Matrix& R_WD, float weight) {
         const Vector x = R_WD.col(0);
         return elementary::atan2(ordered::cross(nose, x)[2], ordered::dot(nose, x)) * weight;
       };
     }},
    {"yaw-about-x", "attitude", Stage::yaw, "computes the yaw error's sine along x_sp",
     "any yaw error", "wrong axis",
     [](FaultyLaw& law) {
       law.attitude.yaw_error = [](const Vector& nose, const Matrix& R_WD, float weight) {
         const Vector x = R_WD.col(0);
         return elementary::atan2(ordered::dot(ordered::cross(nose, x), x), ordered::dot(nose, x)) *
                weight;
       };
     }},
    {"yaw-before-tilt", "attitude", Stage::yaw,
     "uses the nose direction before the tilt correction", "yaw and tilt error together",
     "a missing step",
     [](FaultyLaw& law) {
       law.attitude.nose_after_tilt = [](const Matrix& R, const Tilt&) -> Vector {
         return R.col(0);
       };
     }},
    {"yaw-added", "attitude", Stage::yaw, "adds the yaw error to the third component",
     "a tilted vehicle with a yaw error", "a missing step",
     [](FaultyLaw& law) {
       auto third = std::make_shared<float>(0.0f);
       change_stage(law.attitude.nose_after_tilt,
                    [third](const auto& then, const Matrix& R, const Tilt& tilt) {
                      *third = tilt.rotation_B[2];
                      return then(R, tilt);
                    });
       change_stage(law.attitude.yaw_error,
                    [third](const auto& then, const Vector& nose, const Matrix& R_WD,
                            float weight) { return then(nose, R_WD, weight) + *third; });
     },
     "z x z_sp is normal to z, so the component of R^T (z x z_sp) along the body's z is a rounding "
     "error"},
    {"rodrigues-no-square", "attitude", Stage::yaw, "drops the K K term of Rodrigues' formula",
     "a large tilt with a yaw error", "a missing term",
     [](FaultyLaw& law) {
       change_rodrigues(law, [](const Tilt& t) { return std::pair(t.sine, 0.0f); });
     }},
    {"rodrigues-plus-cosine", "attitude", Stage::yaw, "uses 1 + cos instead of 1 - cos",
     "yaw with a tilt error", "a sign",
     [](FaultyLaw& law) {
       change_rodrigues(law, [](const Tilt& t) { return std::pair(t.sine, 1 + t.cosine); });
     }},
    {"rodrigues-reversed", "attitude", Stage::yaw, "turns the wrong way in Rodrigues' formula",
     "yaw with a tilt error", "transposition",
     [](FaultyLaw& law) {
       change_rodrigues(law, [](const Tilt& t) { return std::pair(-t.sine, 1 - t.cosine); });
     }},
    {"rodrigues-by-angle", "attitude", Stage::yaw, "uses the angle as its sine",
     "yaw with a large tilt error", "a small-angle shortcut",
     [](FaultyLaw& law) {
       change_rodrigues(law, [](const Tilt& t) {
         return std::pair(elementary::atan2(t.sine, t.cosine), 1 - t.cosine);
       });
     }},
    {"cross-matrix-not-zeroed", "attitude", Stage::yaw,
     "never zeroes the diagonal of the cross-product matrix", "yaw with a tilt error",
     "uninitialised memory",
     [](FaultyLaw& law) {
       law.attitude.nose_after_tilt = [](const Matrix& R, const Tilt& tilt) -> Vector {
         if (!(tilt.sine > 0)) return R.col(0);
         const Matrix K = mc_att_control::cross_product_matrix(tilt.axis_B) + Matrix::Identity();
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
         const Matrix R = mc_att_control::rotation_matrix(
             mc_att_control::quaternion_from<float>(in.control_state.q));
         *weight = R(2, 2) * R(2, 2);
       });
       law.attitude.yaw_weight = [weight](const Matrix&) { return *weight; };
     }},
    {"yaw-weight-not-inverted", "large_angle", Stage::yaw,
     "gives an upside-down setpoint no yaw weight", "an inverted setpoint", "wrong weight",
     [](FaultyLaw& law) {
       law.attitude.yaw_weight = [](const Matrix& R) {
         return R(2, 2) > 0 ? R(2, 2) * R(2, 2) : 0.0f;
       };
     }},
};

}  // namespace

std::span<const Fault> yaw_faults() { return yaw_list; }

}  // namespace attest::faults
