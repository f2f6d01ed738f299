// The CPU time of a benchmark that starts processes. Other programs on the machine change it less
// than the time that passes.
#pragma once

#include <sys/resource.h>

namespace attest::bench {

// CPU time of this process and of all processes that it started and that have ended [s].
inline double cpu_seconds() {
  double sum = 0;
  for (const int who : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
    rusage usage{};
    ::getrusage(who, &usage);
    for (const timeval& time : {usage.ru_utime, usage.ru_stime}) {
      sum += static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
    }
  }
  return sum;
}

}  // namespace attest::bench
