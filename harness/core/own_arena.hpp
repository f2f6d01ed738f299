// Memory for processes that are about to be forked.
#pragma once

#include <functional>

namespace attest {

// Calls `work` in a thread, and returns when it has ended. The thread, and the processes that it
// forks, allocate memory in an arena of their own, which is nearly empty. In the main arena they
// would allocate in the fragments that the suite's files left behind: a copy of a page for nearly
// each allocation, in each process. The stack has 8 MiB. If there can be no thread, `work` is
// called in this one. `work` must not throw.
void in_own_arena(const std::function<void()>& work);

}  // namespace attest
