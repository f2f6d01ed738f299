// From a case and a loop rate to everything the unit is given, tick by tick.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "harness/casefile/case.hpp"
#include "harness/trace/trace.hpp"

namespace attest {

Timeline timeline_of(const Case& the_case, const Rate& rate);

// When the unit's ticks begin, jittered and dropped as the case says, since the begin of the case;
// of Case::unit.on_estimate, when their samples are taken. On a clock that is `faster` by this part
// each is at floor(t / (1 + faster)) ns, up to the end of the case.
std::vector<Nanoseconds> unit_ticks(const Case& the_case, const Rate& rate, double faster = 0);

// Everything a case scripts, tick by tick. Every sample shows the last published values of each
// topic, as the ABI promises, and has the updated bits of those published since the tick before.
// The same case and rate give the same bits, for gcc and clang. The case must outlive it. No
// allocation in a tick but for parameters that change.
class Stimulus {
 public:
  Stimulus(const Case& the_case, const Rate& rate);
  Stimulus(Stimulus&&) noexcept;
  ~Stimulus();

  // Fills the inputs of `sample`, which is the one of the tick before, for the tick at `now`, and
  // appends the parameters that change at it. REQUIRES: times increase; `tick` counts from 0.
  void tick(std::size_t tick, Nanoseconds now, Sample& sample,
            std::vector<ParameterChange>& changes);

  // A time of the case on the clock of attest_inputs::timestamp.
  std::uint64_t timestamp_us(Nanoseconds time) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// The inputs and parameters of every tick; the outputs are zero, to be filled by a unit
// (run/open_loop.hpp).
Trace stimulate(const Case& the_case, const Rate& rate);

}  // namespace attest
