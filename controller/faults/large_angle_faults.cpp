// Wrong blends of the tilt and yaw error with the shortest rotation.
#include <algorithm>
#include <cmath>

#include "controller/faults/groups.hpp"

namespace attest::faults {
namespace {

namespace ordered = mc_att_control::ordered;

// Blends error * (1 - share) + direct * share, with another share.
template <typename Share>
void change_share(FaultyLaw& law, Share share) {
  law.attitude.blend = [share](const Vector& error, const Vector& direct, float c, float weight) {
    const float s = share(c, weight);
    return Vector(error * (1 - s) + direct * s);
  };
}

template <typename Quaternions>
void change_direct(FaultyLaw& law, Quaternions direct) {
  law.attitude.direct_error = [direct](const Matrix& R_WB, const Matrix& R_WD) {
    return direct(R_WB, R_WD,
                  mc_att_control::quaternion_of(ordered::transpose_product(R_WB, R_WD)));
  };
}

Vector imaginary(const Quaternion& q) { return mc_att_control::imaginary_part(q); }

Vector shorter(const Quaternion& q) { return imaginary(q) * (q.w() >= 0 ? 2.0f : -2.0f); }

const Fault large_angle_list[] = {
    {"blend-missing", "large_angle", Stage::blend, "never blends with the shortest rotation",
     "a tilt error beyond 90 deg", "a missing step",
     [](FaultyLaw& law) { law.attitude.is_upset = [](float) { return false; }; }},
    {"blend-always", "large_angle", Stage::blend, "blends below 90 deg too", "a tilt of 30 deg",
     "wrong branch threshold",
     [](FaultyLaw& law) { law.attitude.is_upset = [](float) { return true; }; }},
    {"blend-from-60", "large_angle", Stage::blend, "blends from 60 deg", "a tilt of 60 to 90 deg",
     "wrong branch threshold",
     [](FaultyLaw& law) { law.attitude.is_upset = [](float c) { return c < 0.5f; }; }},
    {"blend-from-120", "large_angle", Stage::blend, "blends from 120 deg only",
     "a tilt of 90 to 120 deg", "wrong branch threshold",
     [](FaultyLaw& law) { law.attitude.is_upset = [](float c) { return c < -0.5f; }; }},
    {"blend-by-sine", "large_angle", Stage::blend, "weighs by the sine's square",
     "a tilt error beyond 90 deg", "wrong weight",
     [](FaultyLaw& law) {
       change_share(law, [](float c, float weight) { return (1 - c * c) * weight; });
     }},
    {"blend-not-squared", "large_angle", Stage::blend, "weighs by -cos, not its square",
     "a tilt error beyond 90 deg", "wrong weight",
     [](FaultyLaw& law) { change_share(law, [](float c, float weight) { return -c * weight; }); }},
    {"blend-signed", "large_angle", Stage::blend, "weighs by cos, which is negative",
     "a tilt error beyond 90 deg", "wrong weight",
     [](FaultyLaw& law) { change_share(law, [](float c, float weight) { return c * weight; }); }},
    {"blend-cubed", "large_angle", Stage::blend, "weighs by the cosine's cube",
     "a tilt error beyond 90 deg", "wrong weight",
     [](FaultyLaw& law) {
       change_share(law, [](float c, float weight) { return -c * c * c * weight; });
     }},
    {"blend-without-yaw-weight", "large_angle", Stage::blend,
     "leaves the yaw weight out of the share", "an upset with a tilted setpoint", "wrong weight",
     [](FaultyLaw& law) { change_share(law, [](float c, float) { return c * c; }); }},
    {"blend-yaw-weight-twice", "large_angle", Stage::blend, "squares the yaw weight in the share",
     "an upset with a tilted setpoint", "wrong weight",
     [](FaultyLaw& law) {
       change_share(law, [](float c, float weight) { return c * c * weight * weight; });
     }},
    {"blend-adds", "large_angle", Stage::blend, "does not reduce the share of the error",
     "a tilt error beyond 90 deg", "a missing term",
     [](FaultyLaw& law) {
       law.attitude.blend = [](const Vector& error, const Vector& direct, float c, float weight) {
         return Vector(error + direct * (c * c * weight));
       };
     }},
    {"blend-exchanged", "large_angle", Stage::blend, "exchanges the shares",
     "a tilt error beyond 90 deg", "wrong weight",
     [](FaultyLaw& law) {
       change_stage(law.attitude.blend,
                    [](const auto& then, const Vector& error, const Vector& direct, float c,
                       float weight) { return then(direct, error, c, weight); });
     }},
    {"blend-not-yaw", "large_angle", Stage::blend, "leaves yaw out of the blend",
     "an upset with a yaw error", "wrong axis",
     [](FaultyLaw& law) {
       change_stage(law.attitude.blend, [](const auto& then, const Vector& error,
                                           const Vector& direct, float c, float weight) {
         Vector blended = then(error, direct, c, weight);
         blended[2] = error[2];
         return blended;
       });
     }},
    {"direct-not-doubled", "large_angle", Stage::blend, "does not double the imaginary part",
     "a tilt error beyond 90 deg", "quaternion order",
     [](FaultyLaw& law) {
       change_direct(law, [](const Matrix&, const Matrix&, const Quaternion& q) {
         return Vector(shorter(q) / 2);
       });
     }},
    {"direct-is-angle", "large_angle", Stage::blend,
     "takes the rotation vector, not twice the imaginary part", "a tilt error beyond 90 deg",
     "another error",
     [](FaultyLaw& law) {
       change_direct(law, [](const Matrix&, const Matrix&, const Quaternion& q) {
         const Vector twice = shorter(q);
         const float sine = twice.norm() / 2;
         if (sine == 0) return twice;
         return Vector(twice * (elementary::atan2(sine, std::abs(q.w())) / sine));
       });
     }},
    {"direct-longer-way", "large_angle", Stage::blend, "ignores the sign of w",
     "an upset whose error quaternion has w < 0", "quaternion order",
     [](FaultyLaw& law) {
       change_direct(law, [](const Matrix&, const Matrix&, const Quaternion& q) {
         return Vector(imaginary(q) * 2);
       });
     }},
    {"direct-reversed", "large_angle", Stage::blend, "uses the longer rotation",
     "a tilt error beyond 90 deg", "a sign",
     [](FaultyLaw& law) {
       change_direct(law, [](const Matrix&, const Matrix&, const Quaternion& q) {
         return Vector(-shorter(q));
       });
     }},
    {"direct-in-world", "large_angle", Stage::blend, "uses R_sp R^T, an error in world axes",
     "an upset with a heading", "transposition",
     [](FaultyLaw& law) {
       change_direct(law, [](const Matrix& R, const Matrix& R_sp, const Quaternion&) {
         return shorter(mc_att_control::quaternion_of(Matrix(R_sp * R.transpose())));
       });
     }},
    {"direct-transposed", "large_angle", Stage::blend, "uses R_sp^T R instead of R^T R_sp",
     "a tilt error beyond 90 deg", "transposition",
     [](FaultyLaw& law) {
       change_direct(law, [](const Matrix& R, const Matrix& R_sp, const Quaternion&) {
         return shorter(mc_att_control::quaternion_of(ordered::transpose_product(R_sp, R)));
       });
     }},
    {"direct-imag-0-to-2", "large_angle", Stage::blend, "uses q[0..2] as the imaginary part",
     "a tilt error beyond 90 deg", "quaternion order",
     [](FaultyLaw& law) {
       change_direct(law, [](const Matrix&, const Matrix&, const Quaternion& q) {
         return Vector(Vector(q.w(), q.x(), q.y()) * (q.w() >= 0 ? 2.0f : -2.0f));
       });
     }},
    {"direct-axes-rolled", "large_angle", Stage::blend,
     "mixes up the axes where the trace is not positive", "an upset of more than 120 deg",
     "wrong axis",
     [](FaultyLaw& law) {
       change_direct(law, [](const Matrix& R, const Matrix& R_sp, const Quaternion& q) {
         const Matrix D = ordered::transpose_product(R, R_sp);
         if (D.trace() > 0) return shorter(q);
         return Vector(Vector(q.y(), q.z(), q.x()) * (q.w() >= 0 ? 2.0f : -2.0f));
       });
     }},
    {"direct-trace-only", "large_angle", Stage::blend,
     "computes a quaternion from the trace of a matrix alone", "an error of more than 120 deg",
     "wrong branch",
     [](FaultyLaw& law) {
       change_direct(law, [](const Matrix& R, const Matrix& R_sp, const Quaternion&) {
         const Matrix D = ordered::transpose_product(R, R_sp);
         const float w = std::sqrt(std::max(D.trace() + 1, 0.0f)) / 2;
         const float s = w > 1e-3f ? 0.25f / w : 0.0f;
         return Vector(Vector(D(2, 1) - D(1, 2), D(0, 2) - D(2, 0), D(1, 0) - D(0, 1)) * (2 * s));
       });
     }},
    {"direct-w-reversed", "large_angle", Stage::blend,
     "has the sign of w wrong where the trace is not positive", "an upset of more than 120 deg",
     "a sign",
     [](FaultyLaw& law) {
       change_direct(law, [](const Matrix& R, const Matrix& R_sp, const Quaternion& q) {
         const Matrix D = ordered::transpose_product(R, R_sp);
         return D.trace() > 0 ? shorter(q) : Vector(-shorter(q));
       });
     }},
    {"direct-at-w-0", "large_angle", Stage::blend, "treats w = 0 as negative",
     "an error of exactly 180 deg", "a condition made strict",
     [](FaultyLaw& law) {
       change_direct(law, [](const Matrix&, const Matrix&, const Quaternion& q) {
         return Vector(imaginary(q) * (q.w() > 0 ? 2.0f : -2.0f));
       });
     }},
    {"upset-tilt-bounded", "large_angle", Stage::tilt, "bounds the tilt error at 90 deg",
     "a tilt error beyond 90 deg", "misplaced clamp",
     [](FaultyLaw& law) {
       change_stage(law.attitude.tilt_error,
                    [](const auto& then, const Matrix& R_WB, const Matrix& R_WD) {
                      Tilt tilt = then(R_WB, R_WD);
                      if (tilt.cosine < 0) tilt.rotation_B = tilt.axis_B * 1.57079632679f;
                      return tilt;
                    });
     }},
    {"upset-at-90", "large_angle", Stage::blend, "blends at exactly 90 deg",
     "a tilt error of exactly 90 deg", "a condition made non-strict",
     [](FaultyLaw& law) { law.attitude.is_upset = [](float c) { return c <= 0; }; },
     "at c = 0 the share c * c * yaw_w is 0, and e * 1 + e_d * 0 is e"},
};

}  // namespace

std::span<const Fault> large_angle_faults() { return large_angle_list; }

}  // namespace attest::faults
