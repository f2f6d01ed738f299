// The resources that a thread or this program has used, as counted by the operating system.
#pragma once

#include <cstdint>

#include "harness/core/time.hpp"

namespace attest {

struct Usage {
  Nanoseconds cpu{0};            // user and system
  std::int64_t allocations = 0;  // thread_allocations()
  std::int64_t page_faults = 0;
  std::int64_t yields = 0;       // context switches because it waited
  std::int64_t preemptions = 0;  // context switches because the kernel ran another thread

  friend Usage operator-(const Usage& end, const Usage& begin) {
    return {end.cpu - begin.cpu, end.allocations - begin.allocations,
            end.page_faults - begin.page_faults, end.yields - begin.yields,
            end.preemptions - begin.preemptions};
  }
};

// Of the calling thread so far.
Usage thread_usage();
Nanoseconds thread_cpu_time();  // in steps of nanoseconds; Usage::cpu has microseconds
std::int64_t thread_yields();   // Usage::yields alone

// The CPU time of this process and of those that it started and that have ended. Other programs on
// the machine change it less than the time that passes.
Nanoseconds cpu_time_of_all();

}  // namespace attest
