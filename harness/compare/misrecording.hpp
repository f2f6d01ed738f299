// Mistakes of a recording that look like wrong outputs.
#pragma once

#include <string>

#include "harness/trace/trace.hpp"

namespace attest {

// What was probably done wrong when `got` was recorded: a topic in another unit (a factor of 57.3,
// 1000 or 100), with another sign or with its axes exchanged; all outputs a tick late or early; the
// rows reversed. Empty if none of these explains the wrong values to within a thousandth. A verdict
// does not depend on it. REQUIRES: both have the same number of ticks.
std::string misrecording(const Trace& got, const Trace& want);

}  // namespace attest
