// Conversions between the frames of attest and MuJoCo. The harness uses FRD (body: forward, right,
// down) and NED (world: north, east, down). Only the MuJoCo plant uses FLU (forward, left, up) and
// ENU (east, north, up). Double precision; no allocation.
#pragma once

#include <array>

namespace attest {

using Vector3 = std::array<double, 3>;

// Hamilton, scalar first; as an attitude it rotates body into world: v_NED = R(q) v_FRD.
struct Quaternion {
  double w = 1, x = 0, y = 0, z = 0;

  friend bool operator==(const Quaternion&, const Quaternion&) = default;
};

// Each of these mappings is its own inverse.
constexpr Vector3 frd_from_flu(const Vector3& v) { return {v[0], -v[1], -v[2]}; }
constexpr Vector3 flu_from_frd(const Vector3& v) { return {v[0], -v[1], -v[2]}; }
constexpr Vector3 ned_from_enu(const Vector3& v) { return {v[1], v[0], -v[2]}; }
constexpr Vector3 enu_from_ned(const Vector3& v) { return {v[1], v[0], -v[2]}; }

// Converts an attitude from body FRD, world NED to body FLU, world ENU, and back. Both frames turn
// by 180 deg: the body about x, the world about the line between north and east.
Quaternion flu_to_enu(const Quaternion& frd_to_ned);
Quaternion frd_to_ned(const Quaternion& flu_to_enu);

}  // namespace attest
