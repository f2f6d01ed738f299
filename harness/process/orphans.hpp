// The children of this process that it did not start: descendants whose parents have ended.
#pragma once

#include <mutex>
#include <set>
#include <vector>

#include <sys/types.h>

namespace attest {

// The children that this process has started. All its other children are orphans: descendants whose
// parents have ended. `mutex` is locked while a started child is not in `processes` yet.
struct Owned {
  std::mutex mutex;
  std::set<pid_t> processes;
};

Owned& owned();

// The processes, and all below them that have not ended.
std::vector<pid_t> with_descendants(std::vector<pid_t> processes);

// Kills the orphans repeatedly: when one ends, its own children become orphans. REQUIRES: this
// process is a subreaper.
void end_orphans();

}  // namespace attest
