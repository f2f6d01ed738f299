// Memory for processes that are about to be forked.
#pragma once

#include <functional>

namespace attest {

// Calls `work` in a new thread, and returns when `work` has ended. The thread, and the processes
// that it forks, allocate memory in an arena of their own (of malloc), which is nearly empty. In
// the main arena they would fill gaps between older objects. In each process nearly each allocation
// would then cost the copy of a page. The thread's stack has 8 MiB. If no thread can be made,
// `work` is called in the caller's thread. `work` must not throw.
void in_own_arena(const std::function<void()>& work);

}  // namespace attest
