// From a case and a loop rate to everything the unit is given, tick by tick.
#pragma once

#include "harness/casefile/case.hpp"
#include "harness/trace/trace.hpp"

namespace attest {

// The inputs and parameters of every tick; the outputs are zero, to be filled by a unit
// (run/open_loop.hpp). Every sample shows the last published values of each topic, as the ABI
// promises, and has the updated bits of those published since the tick before.
// The same case and rate give the same bits, for gcc and clang.
Trace stimulate(const Case& the_case, const Rate& rate);

}  // namespace attest
