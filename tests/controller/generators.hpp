// Random inputs for the property tests of the controller.
//
// Quaternions are scalar first and rotate body FRD into world NED; angles in rad.
#pragma once

#include <cstdint>

#include <rapidcheck.h>

#include "controller/attest_unit.h"
#include "controller/mc_att_control/rotation.hpp"

namespace attest::test {

using Quaterniond = mc_att_control::Quaternion<double>;

// Evenly spread over [low, high], for every size that rapidcheck asks for.
rc::Gen<double> uniform(double low, double high);

// A rotation by `angle` about the unit axis of that direction in the x-y plane.
Quaterniond tilt_quaternion(double direction, double angle);

// A rotation by `angle` about z.
Quaterniond yaw_quaternion(double angle);

// Any orientation, of norm 1 to double precision.
rc::Gen<Quaterniond> any_attitude();

// Any bit pattern of a float: every NaN, infinity and denormal.
rc::Gen<float> any_float();

// A number of ordinary size, or now and then any_float().
rc::Gen<float> mostly_ordinary_float();

// A step whose every field is mostly_ordinary_float() or a random flag, 1 us to 30 ms after
// `previous_us`.
rc::Gen<attest_inputs> any_step(std::uint64_t previous_us);

}  // namespace attest::test
