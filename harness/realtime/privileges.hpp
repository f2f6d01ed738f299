// What an operating system may give a real-time thread, asked for piece by piece: each is got or
// refused, and a run goes on without what it was refused and says so.
#pragma once

#include <string>
#include <vector>

namespace attest {

struct RealtimePrivilege {
  std::string name;  // "SCHED_FIFO 80"
  bool got = false;
  std::string why;  // it was refused: "Operation not permitted"
};

// For the process while this lives: memory that stays in RAM, and CPUs that do not sleep deeply
// (/dev/cpu_dma_latency at 0 us).
class ProcessPrivileges {
 public:
  ProcessPrivileges();
  ~ProcessPrivileges();
  ProcessPrivileges(const ProcessPrivileges&) = delete;
  ProcessPrivileges& operator=(const ProcessPrivileges&) = delete;

  const std::vector<RealtimePrivilege>& privileges() const { return privileges_; }

 private:
  std::vector<RealtimePrivilege> privileges_;
  int latency_ = -1;
};

struct ThreadWish {
  int cpu = 0;
  int fifo_priority = 0;  // 0: the ordinary scheduler
};

// For the calling thread: CPU, scheduler, and timers that fire when they are asked to.
std::vector<RealtimePrivilege> claim(const ThreadWish& wish);

// The CPUs that this process may use, ascending; at least one.
std::vector<int> usable_cpus();

}  // namespace attest
