#include "harness/core/frames.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace attest {
namespace {

Vector3 rotated(const Quaternion& q, const Vector3& v) {
  const double tx = 2 * (q.y * v[2] - q.z * v[1]);
  const double ty = 2 * (q.z * v[0] - q.x * v[2]);
  const double tz = 2 * (q.x * v[1] - q.y * v[0]);
  return {v[0] + q.w * tx + q.y * tz - q.z * ty, v[1] + q.w * ty + q.z * tx - q.x * tz,
          v[2] + q.w * tz + q.x * ty - q.y * tx};
}

TEST(Frames, AVectorOfTheBodyIsTheSameVectorOfTheWorldEitherWay) {
  const Quaternion q{0.5, -0.1, 0.7, std::sqrt(1 - 0.25 - 0.01 - 0.49)};
  const Vector3 body{1, 2, 3};  // FRD
  const Vector3 world = rotated(q, body);
  const Vector3 other_way = ned_from_enu(rotated(flu_to_enu(q), flu_from_frd(body)));
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(other_way[i], world[i], 1e-14);
}

TEST(Frames, ThereAndBackIsTheSame) {
  const Quaternion q{0.5, -0.1, 0.7, 0.5};
  const Quaternion back = frd_to_ned(flu_to_enu(q));
  EXPECT_NEAR(back.w, q.w, 1e-15);
  EXPECT_NEAR(back.x, q.x, 1e-15);
  EXPECT_NEAR(back.y, q.y, 1e-15);
  EXPECT_NEAR(back.z, q.z, 1e-15);
  EXPECT_EQ(frd_from_flu(flu_from_frd({1, 2, 3})), (Vector3{1, 2, 3}));
  EXPECT_EQ(ned_from_enu(enu_from_ned({1, 2, 3})), (Vector3{1, 2, 3}));
}

}  // namespace
}  // namespace attest
