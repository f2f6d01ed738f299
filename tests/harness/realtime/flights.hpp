// What the tests of real time fly.
#pragma once

#include "harness/casefile/case.hpp"
#include "harness/plant/vehicle.hpp"

namespace attest::test {

// Armed and level, without anything else; read from no file.
Case hover_case(double duration_s);

// A quad that hovers at half of its rotors' speed.
Vehicle quad_vehicle();

}  // namespace attest::test
