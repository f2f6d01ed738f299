// Runs the reference, attest's own implementation of the law (port/builtin.hpp). No other code of
// the harness does, except units_for() for the unit that a port does not have.
#pragma once

#include <functional>
#include <memory>
#include <span>

#include "harness/core/result.hpp"
#include "harness/host/port_host.hpp"
#include "harness/trace/trace.hpp"

namespace attest {

enum class Precision { binary32, binary64 };

// The reference in this process. `course`: what it flies; empty if it does not fly. In binary64 it
// serves to measure the horizon of a flight (docs/flights.md).
std::unique_ptr<PortHost> open_reference(const Course& course = {},
                                         Precision precision = Precision::binary32);

// `inputs` with the outputs of the reference, as one instance of the subject's module. Errors: the
// reference fails.
Result<Trace> reference_outputs(const ModuleUnderTest& subject, Trace inputs);

// Gives the inputs of `trace` to the reference in its power-on state, and calls on_tick for each
// tick: the parameters that change, the sample, and the sample with the reference's outputs.
// Errors: the reference does not have the profile, or fails.
using OnTick = std::function<void(std::size_t tick, std::span<const ParameterChange> changes,
                                  const Sample& given, const Sample& right)>;
Result<void> for_each_reference_output(const ModuleUnderTest& subject, const Trace& trace,
                                       const OnTick& on_tick);

}  // namespace attest
