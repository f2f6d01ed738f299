// What a process and its descendants have used so far.
#pragma once

#include <chrono>
#include <cstddef>

#include <sys/types.h>

namespace attest {

// Without processes and threads that have ended: so the values can also fall.
struct TreeUsage {
  std::chrono::nanoseconds running{0};  // CPU time
  std::chrono::nanoseconds waiting{0};  // time in which a thread could run but had no CPU
  std::size_t resident_bytes = 0;       // memory, also shared memory
};

TreeUsage usage_of_tree(pid_t root);

}  // namespace attest
