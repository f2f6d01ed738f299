#include "harness/realtime/usage.hpp"

#include <ctime>

#include <sys/resource.h>

#include "harness/realtime/allocations.hpp"

namespace attest {
namespace {

Nanoseconds time_of(const timeval& time) {
  return std::chrono::seconds(time.tv_sec) + std::chrono::microseconds(time.tv_usec);
}

}  // namespace

Nanoseconds thread_cpu_time() {
  timespec time{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return std::chrono::seconds(time.tv_sec) + Nanoseconds(time.tv_nsec);
}

std::int64_t thread_yields() {
  rusage usage{};
  ::getrusage(RUSAGE_THREAD, &usage);
  return usage.ru_nvcsw;
}

Usage thread_usage() {
  rusage usage{};
  ::getrusage(RUSAGE_THREAD, &usage);
  return {time_of(usage.ru_utime) + time_of(usage.ru_stime),
          static_cast<std::int64_t>(thread_allocations()), usage.ru_minflt + usage.ru_majflt,
          usage.ru_nvcsw, usage.ru_nivcsw};
}

}  // namespace attest
