#include "controller/actuation/mixer_geometry.hpp"

#include <array>

namespace attest::actuation {
namespace {

// A rotor at an angle a, clockwise from the nose, has roll = cos(a + 90 deg) and pitch = cos(a),
// rounded to six decimals as in PX4's generated tables.
constexpr float kCcw = 1.0f;
constexpr float kCw = -1.0f;

constexpr std::array<Rotor, 4> kQuadX{{
    {-0.707107f, 0.707107f, kCcw},  //   45 deg
    {0.707107f, -0.707107f, kCcw},  // -135
    {0.707107f, 0.707107f, kCw},    //  -45
    {-0.707107f, -0.707107f, kCw},  //  135
}};

constexpr std::array<Rotor, 4> kQuadPlus{{
    {-1.0f, 0.0f, kCcw},  //  90 deg
    {1.0f, 0.0f, kCcw},   // -90
    {0.0f, 1.0f, kCw},    //   0
    {0.0f, -1.0f, kCw},   // 180
}};

constexpr std::array<Rotor, 6> kHexX{{
    {-1.0f, 0.0f, kCw},         //   90 deg
    {1.0f, 0.0f, kCcw},         //  -90
    {0.5f, 0.866025f, kCw},     //  -30
    {-0.5f, -0.866025f, kCcw},  //  150
    {-0.5f, 0.866025f, kCcw},   //   30
    {0.5f, -0.866025f, kCw},    // -150
}};

constexpr std::array<Rotor, 8> kOctoX{{
    {-0.382683f, 0.923880f, kCw},    //   22.5 deg
    {0.382683f, -0.923880f, kCw},    // -157.5
    {-0.923880f, 0.382683f, kCcw},   //   67.5
    {-0.382683f, -0.923880f, kCcw},  //  157.5
    {0.382683f, 0.923880f, kCcw},    //  -22.5
    {0.923880f, -0.382683f, kCcw},   // -112.5
    {0.923880f, 0.382683f, kCw},     //  -67.5
    {-0.923880f, -0.382683f, kCw},   //  112.5
}};

constexpr std::array<MixerGeometry, 4> kGeometries{{
    {"4x", kQuadX},
    {"4+", kQuadPlus},
    {"6x", kHexX},
    {"8x", kOctoX},
}};

}  // namespace

std::span<const MixerGeometry> mixer_geometries() { return kGeometries; }

}  // namespace attest::actuation
