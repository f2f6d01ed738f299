// Tilt and torsion from the error quaternion: no rotation matrix is turned, no axis normalised.
// Must pass at the numeric level.
#include <cmath>

#include "tests/ports/law_port.hpp"

namespace {

using namespace attest::mc_att_control;
using Vector = Vector3<float>;
using Matrix = Matrix3<float>;

struct Stages : AttitudeStages<float> {
  // The tilt is the rotation of a quaternion with the same direction in x-y and without z. The
  // tangent of its half angle is |(x, y)| / |(w, z)|.
  static TiltError<float> tilt_error(const Matrix& R_WB, const Matrix& R_WD) {
    const Matrix D = R_WB.transpose() * R_WD;
    TiltError<float> tilt{Vector::Zero(), Vector::Zero(), 0, 0};
    tilt.cosine = D(2, 2);
    // A quaternion of zeros is not a rotation; the law then returns no tilt.
    if (D.squaredNorm() == 0) return tilt;
    const Quaternion<float> q = quaternion_of(D);
    const float swing = std::hypot(q.x(), q.y()), twist = std::hypot(q.w(), q.z());
    tilt.sine = 2 * swing * twist;
    if (!(tilt.sine > 0)) {
      if (std::isnan(tilt.sine)) tilt.rotation_B.fill(tilt.sine);
      return tilt;
    }
    // (x, y) turned by half of the torsion: the axis in body axes before the turn.
    const float scale = 1 / (swing * twist);
    tilt.axis_B = {(q.w() * q.x() - q.y() * q.z()) * scale, (q.w() * q.y() + q.x() * q.z()) * scale,
                   0};
    tilt.rotation_B = tilt.axis_B * (2 * std::atan2(swing, twist));
    return tilt;
  }
};

}  // namespace

ATTEST_LAW_PORT("quaternion tilt", LawWith<Stages>)
