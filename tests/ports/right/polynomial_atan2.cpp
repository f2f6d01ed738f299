// atan2 as a polynomial, accurate to 2e-7: for a processor without atan2.
// Must pass at the numeric level.
#include "tests/ports/law_port.hpp"
#include "tests/ports/right/polynomial.hpp"

namespace {

using namespace attest::mc_att_control;
using Vector = Vector3<float>;
using Matrix = Matrix3<float>;

struct Stages : AttitudeStages<float> {
  static TiltError<float> tilt_error(const Matrix& R_WB, const Matrix& R_WD) {
    TiltError<float> tilt = AttitudeStages<float>::tilt_error(R_WB, R_WD);
    if (tilt.sine > 0) tilt.rotation_B = tilt.axis_B * polynomial::atan2(tilt.sine, tilt.cosine);
    return tilt;
  }
  static float yaw_error(const Vector& nose, const Matrix& R_WD, float weight) {
    const Vector x = R_WD.col(0), z = R_WD.col(2);
    return polynomial::atan2(ordered::dot(ordered::cross(nose, x), z), ordered::dot(nose, x)) *
           weight;
  }
};

}  // namespace

ATTEST_LAW_PORT("polynomial atan2", LawWith<Stages>)
