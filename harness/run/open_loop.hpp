// One trace in, one trace out: a unit is given the inputs of a trace and its outputs are recorded.
//
// Per tick, in this order:
//
//     parameters that change at this tick -> set_parameter
//     inputs of the sample                -> step
//     outputs                             -> the sample; kept as the next step's starting point
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "harness/port/port.hpp"
#include "harness/trace/trace.hpp"

namespace attest {

// The port itself went wrong, or said that it cannot do this. Its other faults (a wrong value) show
// in the comparison.
struct PortFault {
  enum class Kind {
    unsupported,  // ATTEST_UNSUPPORTED
    failed,       // ATTEST_FAILED, ATTEST_INVALID
    protocol,     // broke the rules of the ABI
  };
  Kind kind = Kind::failed;
  std::size_t tick = 0;
  std::string what;  // one line
};

// Replaces the outputs of `trace` by those of a fresh `unit`. On a fault the samples before it are
// valid.
std::optional<PortFault> drive(Unit& unit, Trace& trace);

}  // namespace attest
