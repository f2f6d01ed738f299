// A diagnosis as text.
#pragma once

#include <string>

#include "harness/diagnosis/diagnose.hpp"

namespace attest {

// "it looks like:\n  `quat-order-xyzw`: ...", with a newline at its end.
std::string diagnosis_text(const Diagnosis& diagnosis);

}  // namespace attest
