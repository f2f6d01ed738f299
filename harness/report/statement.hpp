// What a run says of conformance, in one line, and as a picture.
#pragma once

#include <string>

#include "harness/suite/verdict.hpp"

namespace attest {

// "px4-v1.5.5, numeric, 11 rates, all groups but tailsitter; cases 1.0, golden 1.0", or why there
// is none: "none: 3 groups fail (attitude, modes, tpa)".
std::string conformance_statement(const RunResult& run);

// A badge as an SVG file.
std::string badge(const RunResult& run);

}  // namespace attest
