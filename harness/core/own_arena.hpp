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

// Replaces the pages of the heap by a private mapping of a sealed file with the same bytes. A fork
// then does not copy the page table of the heap, which for all cases of the suite takes several
// times as long as the rest of the fork. No process can change the file. Free memory at the end of
// the heap is returned to the system first. Without /proc or memory for the file, the heap stays as
// it is. REQUIRES: no other thread runs.
void make_heap_cheap_to_fork();

}  // namespace attest
