// Runs the steps of two instances at the same time, on two threads. Data that both share then has a
// wrong value in the judged instance.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>

#include "harness/loop/unit_driver.hpp"
#include "harness/trace/trace.hpp"

namespace attest {

// Calls `judged` on a new thread and `other` on this one, again and again, until `judged` returns
// false. `other` is not called again after it has returned false, and is called at most some times
// more often than `judged`. A timer pauses the thread of `judged`, wherever it is, until `other`
// has run twice, and does that some hundred times. So both overlap also on one CPU, and on a busy
// machine. A pause ends early if `other` seems to wait for a lock that `judged` holds. `steps`:
// about how often `judged` is called. Adds the pauses that came while `judged` ran to `overlaps`.
// False: there is no second thread, and nothing was called. REQUIRES: at most one call at a time in
// a process.
bool run_on_two_threads(const std::function<bool()>& judged, const std::function<bool()>& other,
                        std::size_t steps, std::size_t& overlaps);

// So many overlaps miss data that both instances share during a tenth of a step with a probability
// of 3e-5.
inline constexpr std::size_t enough_overlaps = 100;

// Calls `run` for `trace`, and then for copies of its inputs, until there are enough overlaps: on a
// busy virtual machine, timers are milliseconds late, and one run has only a few. `run` makes fresh
// instances, and adds its overlaps. Ends after some seconds, because a port that blocks the other
// thread has none. Kind::failed: the outputs of two runs differ.
std::optional<PortFault> run_until_overlapped(
    Trace& trace,
    const std::function<std::optional<PortFault>(Trace& trace, std::size_t& overlaps)>& run);

}  // namespace attest
