// How alike a port and the wrong controllers of the catalogue are on one vector: what a diagnosis
// is made of.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "controller/faults/fault.hpp"
#include "harness/run/open_loop.hpp"
#include "harness/trace/trace.hpp"

namespace attest {

// One fault beside the port.
struct Likeness {
  std::size_t matched = 0;  // ticks at which fault and port answer the same
  std::size_t both = 0;     // values at which both deviate from the law
  std::size_t either = 0;   // values at which one of them does
};

struct VectorLikeness {
  std::size_t ticks = 0;
  bool deviates = false;             // the port, from the law
  std::vector<Likeness> likenesses;  // of each fault of the catalogue, in its order
};

// Of whichever part; zero of the others.
struct Answer {
  attest_outputs out;
  attest_mixer_outputs mixer_out;
  attest_battery_outputs battery_out;
};
using Outputs = std::vector<Answer>;  // one a tick

Outputs outputs_of(const Trace& trace);

// What the faults answer to the inputs of `given`, in the order of the catalogue, each alone or
// together with `partner`; empty where one does not do the profile.
std::vector<Outputs> answers_of_faults(const Trace& given, const Subject& subject,
                                       const faults::Fault* partner = nullptr);

// Values are the same when the numeric level would pass them.
VectorLikeness likeness(const Outputs& port, const Outputs& law, std::span<const Outputs> faults);

}  // namespace attest
