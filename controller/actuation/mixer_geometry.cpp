#include "controller/actuation/mixer_geometry.hpp"

#include <array>

namespace attest::actuation {
namespace {

// A rotor at an angle a, clockwise from the nose, has roll = cos(a + 90 deg) and pitch = cos(a).
// Both are rounded to six decimals, as in PX4's generated tables.
constexpr float ccw = 1.0f;
constexpr float cw = -1.0f;

constexpr std::array<Rotor, 4> quad_x{{
    {-0.707107f, 0.707107f, ccw},  //   45 deg
    {0.707107f, -0.707107f, ccw},  // -135
    {0.707107f, 0.707107f, cw},    //  -45
    {-0.707107f, -0.707107f, cw},  //  135
}};

constexpr std::array<Rotor, 4> quad_plus{{
    {-1.0f, 0.0f, ccw},  //  90 deg
    {1.0f, 0.0f, ccw},   // -90
    {0.0f, 1.0f, cw},    //   0
    {0.0f, -1.0f, cw},   // 180
}};

constexpr std::array<Rotor, 6> hex_x{{
    {-1.0f, 0.0f, cw},         //   90 deg
    {1.0f, 0.0f, ccw},         //  -90
    {0.5f, 0.866025f, cw},     //  -30
    {-0.5f, -0.866025f, ccw},  //  150
    {-0.5f, 0.866025f, ccw},   //   30
    {0.5f, -0.866025f, cw},    // -150
}};

constexpr std::array<Rotor, 8> octo_x{{
    {-0.382683f, 0.923880f, cw},    //   22.5 deg
    {0.382683f, -0.923880f, cw},    // -157.5
    {-0.923880f, 0.382683f, ccw},   //   67.5
    {-0.382683f, -0.923880f, ccw},  //  157.5
    {0.382683f, 0.923880f, ccw},    //  -22.5
    {0.923880f, -0.382683f, ccw},   // -112.5
    {0.923880f, 0.382683f, cw},     //  -67.5
    {-0.923880f, -0.382683f, cw},   //  112.5
}};

constexpr std::array<MixerGeometry, 4> all_geometries{{
    {"4x", quad_x},
    {"4+", quad_plus},
    {"6x", hex_x},
    {"8x", octo_x},
}};

}  // namespace

std::span<const MixerGeometry> mixer_geometries() { return all_geometries; }

}  // namespace attest::actuation
