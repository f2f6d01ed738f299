// Runs the steps of two instances at the same time, on two threads. Data that both share then has a
// wrong value in the judged instance.
#pragma once

#include <cstddef>
#include <functional>

namespace attest {

// Calls `judged` on a new thread and `other` on this one, again and again, until `judged` returns
// false. `other` is not called again after it has returned false, and is called at most some times
// more often than `judged`. A timer pauses the thread of `judged`, wherever it is, until `other`
// has run twice, and does that some hundred times. So both overlap also on one CPU, and on a busy
// machine. A pause ends early if `other` seems to wait for a lock that `judged` holds. `steps`:
// about how often `judged` is called. False: there is no second thread, and nothing was called.
// REQUIRES: at most one call at a time in a process.
bool run_on_two_threads(const std::function<bool()>& judged, const std::function<bool()>& other,
                        std::size_t steps);

}  // namespace attest
