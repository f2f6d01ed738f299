// Runs the steps of two instances at the same time, on two threads. Data that both share then has a
// wrong value in the judged instance.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>

#include "harness/loop/unit_driver.hpp"
#include "harness/trace/trace.hpp"

namespace attest {

// The unit whose steps shall overlap with those of the other instance.
class OverlappedUnit final : public ForwardingUnit {
 public:
  using ForwardingUnit::ForwardingUnit;
  int step_structs(const void* in, void* out) override;
};

// The pauses of the judged thread that came in a step of the OverlappedUnit.
struct Overlaps {
  std::size_t whole = 0;    // the other thread made a whole step
  std::size_t blocked = 0;  // it made none in time: it waits for a lock that the step holds

  bool are_enough() const;
};

// Calls `judged` on a new thread and `other` on this one, again and again, until `judged` returns
// false. `other` is not called again after it has returned false, and is called at most some times
// more often than `judged`. A timer pauses the thread of `judged`, wherever it is, until `other`
// has run twice, and does that some hundred times. So both overlap also on one CPU, and on a busy
// machine. `steps`: about how often `judged` is called. Counts in `overlaps`. False: there is no
// second thread, and nothing was called. REQUIRES: at most one call at a time in a process.
bool run_on_two_threads(const std::function<bool()>& judged, const std::function<bool()>& other,
                        std::size_t steps, Overlaps& overlaps);

// Calls `run` for `trace`, and then for copies of its inputs, until there are enough overlaps: most
// pauses are not in a step. Ends after some seconds, because late timers give few. `run`
// makes fresh instances, and counts in `overlaps`. Kind::failed: the outputs of two runs differ.
std::optional<PortFault> run_until_overlapped(
    Trace& trace,
    const std::function<std::optional<PortFault>(Trace& trace, Overlaps& overlaps)>& run);

}  // namespace attest
