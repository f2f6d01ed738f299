// atan2 as a polynomial, accurate to 2e-7: for a processor without atan2.
// Must pass at the numeric level.
#include <cmath>
#include <utility>

#include "tests/ports/law_port.hpp"

namespace {

using namespace attest::reference;
using Vector = Vector3<float>;
using Matrix = Matrix3<float>;

// The series to x^13, for |x| <= tan(pi/8): the term left out is below 1.3e-7.
float atan_small(float x) {
  const float z = x * x;
  return x *
         (1 - z * (1 / 3.0f -
                   z * (1 / 5.0f - z * (1 / 7.0f - z * (1 / 9.0f - z * (1 / 11.0f - z / 13.0f))))));
}

float atan2_of(float y, float x) {
  constexpr float pi = 3.14159265358979f;
  float big = std::abs(x), small = std::abs(y);
  if (std::isnan(big) || std::isnan(small)) return big + small;
  const bool steep = small > big;
  if (steep) std::swap(big, small);
  if (big == 0) return std::atan2(y, x);
  const float ratio = std::isinf(big) ? (std::isinf(small) ? 1.0f : 0.0f) : small / big;
  // atan r = pi/4 + atan((r - 1) / (r + 1))
  float angle =
      ratio > 0.41421356f ? pi / 4 + atan_small((ratio - 1) / (ratio + 1)) : atan_small(ratio);
  if (steep) angle = pi / 2 - angle;
  if (std::signbit(x)) angle = pi - angle;
  return std::copysign(angle, y);
}

struct Stages : AttitudeStages<float> {
  static TiltError<float> tilt_error(const Matrix& R_WB, const Matrix& R_WD) {
    TiltError<float> tilt = AttitudeStages<float>::tilt_error(R_WB, R_WD);
    if (tilt.sine > 0) tilt.rotation_B = tilt.axis_B * atan2_of(tilt.sine, tilt.cosine);
    return tilt;
  }
  static float yaw_error(const Vector& nose, const Matrix& R_WD, float weight) {
    const Vector x = R_WD.col(0), z = R_WD.col(2);
    return atan2_of(ordered::dot(ordered::cross(nose, x), z), ordered::dot(nose, x)) * weight;
  }
};

}  // namespace

ATTEST_LAW_PORT("polynomial atan2", LawWith<Stages>)
