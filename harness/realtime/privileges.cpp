#include "harness/realtime/privileges.hpp"

#include <cerrno>
#include <cstdint>
#include <cstring>

#include <fcntl.h>
#include <fmt/format.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

namespace attest {
namespace {

RealtimePrivilege right(std::string name, bool got) {
  return {std::move(name), got, got ? "" : std::strerror(errno)};
}

}  // namespace

ProcessPrivileges::ProcessPrivileges() {
  // If locked memory is limited, MCL_FUTURE would make allocations beyond the limit fail.
  rlimit limit{};
  ::getrlimit(RLIMIT_MEMLOCK, &limit);
  const bool unlimited = limit.rlim_cur == RLIM_INFINITY || ::geteuid() == 0;
  const int pages = unlimited ? MCL_CURRENT | MCL_FUTURE : MCL_CURRENT;
  privileges_.push_back(right("mlockall", ::mlockall(pages) == 0));
  // The kernel limits the latency of CPUs to the number in this file as long as the file is open
  // (Documentation/power/pm_qos_interface).
  const std::int32_t no_latency_us = 0;
  latency_ = ::open("/dev/cpu_dma_latency", O_WRONLY | O_CLOEXEC);
  const bool kept = latency_ >= 0 && ::write(latency_, &no_latency_us, sizeof no_latency_us) ==
                                         static_cast<ssize_t>(sizeof no_latency_us);
  privileges_.push_back(right("cpu_dma_latency 0", kept));
}

ProcessPrivileges::~ProcessPrivileges() {
  if (latency_ >= 0) ::close(latency_);
  ::munlockall();
}

std::vector<RealtimePrivilege> claim(const ThreadWish& wish) {
  std::vector<RealtimePrivilege> privileges;
  cpu_set_t cpus;
  CPU_ZERO(&cpus);
  CPU_SET(static_cast<std::size_t>(wish.cpu), &cpus);
  privileges.push_back(
      right(fmt::format("CPU {}", wish.cpu), ::sched_setaffinity(0, sizeof cpus, &cpus) == 0));
  if (wish.fifo_priority > 0) {
    sched_param parameters{};
    parameters.sched_priority = wish.fifo_priority;
    privileges.push_back(right(fmt::format("SCHED_FIFO {}", wish.fifo_priority),
                               ::sched_setscheduler(0, SCHED_FIFO, &parameters) == 0));
  }
  // By default, the timers of an ordinary thread may be 50 us late, to save power.
  privileges.push_back(right("timer slack 1 ns", ::prctl(PR_SET_TIMERSLACK, 1ul) == 0));
  return privileges;
}

std::vector<int> usable_cpus() {
  cpu_set_t cpus;
  CPU_ZERO(&cpus);
  std::vector<int> usable;
  if (::sched_getaffinity(0, sizeof cpus, &cpus) == 0) {
    for (int cpu = 0; cpu < CPU_SETSIZE; ++cpu) {
      if (CPU_ISSET(static_cast<std::size_t>(cpu), &cpus)) usable.push_back(cpu);
    }
  }
  if (usable.empty()) usable.push_back(0);
  return usable;
}

}  // namespace attest
