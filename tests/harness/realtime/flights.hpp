// The case and the vehicle of the real-time tests.
#pragma once

#include "harness/casefile/case.hpp"
#include "harness/plant/vehicle.hpp"

namespace attest::test {

// Armed and level, without anything else; not read from a file.
Case hover_case(double duration_s);

// A flight of the cascade: level, without anything else.
Case cascade_case(double duration_s);

// A quad that hovers at half of its rotors' speed.
Vehicle quad_vehicle();

}  // namespace attest::test
