// Computes all inputs of the unit, tick by tick, from a case and a loop rate.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "harness/casefile/case.hpp"
#include "harness/trace/trace.hpp"

namespace attest {

Timeline timeline_of(const Case& the_case, const Rate& rate);

// The times at which the unit's ticks begin, since the start of the case, with the case's jitter,
// stalls and dropped ticks. If the estimator triggers the unit (Case::unit.on_estimate), they are
// the times at which the estimator takes its samples. `faster` is the fraction by which the clock
// of these ticks is faster: a tick that would begin at t begins at floor(t / (1 + faster)) ns, and
// there is no tick at or after the end of the case. With `faster` 0, a stall or jitter with a heavy
// tail may delay ticks beyond the end.
std::vector<Nanoseconds> unit_ticks(const Case& the_case, const Rate& rate, double faster = 0);

// The scripted inputs of a case, tick by tick. A sample holds the last published values of each
// topic, as the ABI promises, and the updated bits of the topics that were published since the last
// tick. The same case and rate give the same bits, with gcc and clang. The case must outlive this.
// A tick allocates memory only when a parameter changes.
class Stimulus {
 public:
  Stimulus(const Case& the_case, const Rate& rate);
  Stimulus(Stimulus&&) noexcept;
  ~Stimulus();

  // Updates the inputs of `sample` for the tick at `now`, and appends the parameters that change at
  // it to `changes`. REQUIRES: `sample` is that of the last tick, at tick 0 all zero; `now`
  // increases; `tick` counts from 0.
  void tick(std::size_t tick, Nanoseconds now, Sample& sample,
            std::vector<ParameterChange>& changes);

  // Converts a time of the case to the clock of attest_inputs::timestamp.
  std::uint64_t timestamp_us(Nanoseconds time) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// The inputs and parameters of every tick. The outputs are zero; loop/open_loop.hpp fills them.
Trace stimulate(const Case& the_case, const Rate& rate);

}  // namespace attest
