// A diagnosis as text.
#pragma once

#include <string>

#include "harness/diagnosis/diagnose.hpp"

namespace attest {

// "7 of 9 failing vectors deviate first in the rate law"
std::string first_stages(const Diagnosis& diagnosis);

// "it looks like:\n  `quat-order-xyzw`: ...", then the most specific failing case; with a newline
// at its end.
std::string diagnosis_text(const Diagnosis& diagnosis);

}  // namespace attest
