// A trace for units that do not compute anything.
#pragma once

#include "harness/trace/trace.hpp"

namespace attest {

// The timestamp of each tick is its number.
inline Trace trace_of(std::size_t ticks) {
  Trace trace;
  for (std::size_t tick = 0; tick < ticks; ++tick) {
    Sample sample{};
    sample.in.timestamp = tick;
    trace.samples.push_back(sample);
  }
  return trace;
}

}  // namespace attest
