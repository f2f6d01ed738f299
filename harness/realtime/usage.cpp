#include "harness/realtime/usage.hpp"

#include <ctime>

#include <sys/resource.h>

#include "harness/realtime/allocations.hpp"

namespace attest {
namespace {

Nanoseconds time_of(const timeval& time) {
  return std::chrono::seconds(time.tv_sec) + std::chrono::microseconds(time.tv_usec);
}

rusage usage_of(int who) {
  rusage usage{};
  ::getrusage(who, &usage);
  return usage;
}

Nanoseconds cpu_of(const rusage& usage) {
  return time_of(usage.ru_utime) + time_of(usage.ru_stime);
}

}  // namespace

Nanoseconds thread_cpu_time() {
  timespec time{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return std::chrono::seconds(time.tv_sec) + Nanoseconds(time.tv_nsec);
}

std::int64_t thread_yields() { return usage_of(RUSAGE_THREAD).ru_nvcsw; }

Nanoseconds cpu_time_of_all() {
  return cpu_of(usage_of(RUSAGE_SELF)) + cpu_of(usage_of(RUSAGE_CHILDREN));
}

Usage thread_usage() {
  const rusage usage = usage_of(RUSAGE_THREAD);
  return {cpu_of(usage), static_cast<std::int64_t>(thread_allocations()),
          usage.ru_minflt + usage.ru_majflt, usage.ru_nvcsw, usage.ru_nivcsw};
}

}  // namespace attest
