// One trace in, one trace out: a unit is given the inputs of a trace and its outputs are recorded.
#pragma once

#include <optional>

#include "harness/port/port.hpp"
#include "harness/run/unit_driver.hpp"
#include "harness/trace/trace.hpp"

namespace attest {

// Replaces the outputs of `trace` by those of a fresh `unit`. On a fault the samples before it are
// valid.
std::optional<PortFault> drive(Unit& unit, Trace& trace);

}  // namespace attest
