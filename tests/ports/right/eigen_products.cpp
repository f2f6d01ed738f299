// Eigen's own products, norms and rotations, in Eigen's order of additions: how a port in Eigen
// would be written. Must pass at the numeric level.
#include <cmath>

#include <Eigen/Geometry>

#include "tests/ports/law_port.hpp"

namespace {

using namespace attest::mc_att_control;
using Vector = Vector3<float>;
using Matrix = Matrix3<float>;

struct Attitude : AttitudeStages<float> {
  static TiltError<float> tilt_error(const Matrix& R_WB, const Matrix& R_WD) {
    const Vector z = R_WB.col(2), z_sp = R_WD.col(2);
    TiltError<float> tilt;
    tilt.rotation_B = R_WB.transpose() * z.cross(z_sp);
    tilt.sine = tilt.rotation_B.norm();
    tilt.cosine = z.dot(z_sp);
    if (tilt.sine > 0) {
      tilt.axis_B = tilt.rotation_B / tilt.sine;
      tilt.rotation_B = tilt.axis_B * std::atan2(tilt.sine, tilt.cosine);
    }
    return tilt;
  }
  static Vector nose_after_tilt(const Matrix& R_WB, const TiltError<float>& tilt) {
    if (!(tilt.sine > 0)) return R_WB.col(0);
    const Matrix K = cross_product_matrix(tilt.axis_B);
    const Matrix turn = Matrix::Identity() + K * tilt.sine + K * K * (1 - tilt.cosine);
    return (R_WB * turn).col(0);
  }
  static float yaw_error(const Vector& nose, const Matrix& R_WD, float weight) {
    const Vector x = R_WD.col(0), z = R_WD.col(2);
    return std::atan2(nose.cross(x).dot(z), nose.dot(x)) * weight;
  }
  static Vector direct_error(const Matrix& R_WB, const Matrix& R_WD) {
    const Eigen::Quaternionf q(Matrix(R_WB.transpose() * R_WD));
    return q.w() >= 0 ? Vector(q.vec() * 2) : Vector(-q.vec() * 2);
  }
};

struct Rate : RateStages<float> {
  static Vector derivative(const Vector& prev, const Vector& rates, float dt,
                           const RateGains<float>& gains) {
    return (gains.derivative / dt).asDiagonal() * (prev - rates);
  }
  static Vector control(const Vector& p, const Vector& d, const Vector& i, const Vector& ff) {
    return ff + i + d + p;
  }
};

using Law = LawWith<Attitude, Rate>;

}  // namespace

ATTEST_LAW_PORT("Eigen products", Law)
