// The values of the inputs that a case leaves out: a vehicle that hovers level and armed.
#pragma once

#include "harness/trace/channels.hpp"

namespace attest {

// REQUIRES: an input.
double baseline(const Channel& channel);

}  // namespace attest
