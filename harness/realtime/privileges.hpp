// The privileges of a real-time thread. Each is requested separately, and is granted or refused. A
// run continues without those that were refused, and reports them.
#pragma once

#include <string>
#include <vector>

namespace attest {

struct RealtimePrivilege {
  std::string name;  // "SCHED_FIFO 80"
  bool got = false;
  std::string why;  // reason of a refusal: "Operation not permitted"
};

// The privileges of the process, while this object exists: its memory stays in RAM, and CPUs do not
// sleep deeply (/dev/cpu_dma_latency at 0 us).
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

// Claims for the calling thread: its CPU, its scheduler, and a timer slack of 1 ns.
std::vector<RealtimePrivilege> claim(const ThreadWish& wish);

// The CPUs that this process may use, ascending; at least one.
std::vector<int> usable_cpus();

}  // namespace attest
