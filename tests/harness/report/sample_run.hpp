// Runs made by hand that show every kind of result.
#pragma once

#include <string>

#include "harness/loop/flight.hpp"
#include "harness/verify/run_result.hpp"

namespace attest {

// Numeric level. Every verdict, three groups and four rates, a NaN and a flag that deviate, text
// that XML, HTML, shells and terminals could misread, a long name, errors.
RunResult sample_run();

// Exact level: 3 cases at 2 rates, all passed.
RunResult passing_run();

// A plain pass.
VectorResult passed(const std::string& group, const std::string& name, LoopRate rate);

// A flight of a level vehicle: two ticks, 4 ms apart.
Flown two_level_ticks();

// The first value of `channel` that differs. The ulp are those of float32 where both are finite.
Deviation deviation(const char* channel, std::size_t tick, float got, float want, double tolerance);

}  // namespace attest
