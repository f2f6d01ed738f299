#include "harness/core/frames.hpp"

#include <numbers>

namespace attest {
namespace {

constexpr double half_root = std::numbers::sqrt2 / 2;

// The product (0, r, r, 0) q (0, 1, 0, 0), r = sqrt(1/2): the turns of world and body. The square
// of each of these two turns is -1, so the mapping is its own inverse.
Quaternion turned(const Quaternion& q) {
  return {half_root * (-q.w - q.z), half_root * (-q.x - q.y), half_root * (q.y - q.x),
          half_root * (q.z - q.w)};
}

}  // namespace

Quaternion flu_to_enu(const Quaternion& frd_to_ned) { return turned(frd_to_ned); }
Quaternion frd_to_ned(const Quaternion& flu_to_enu) { return turned(flu_to_enu); }

}  // namespace attest
