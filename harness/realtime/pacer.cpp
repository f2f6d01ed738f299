#include "harness/realtime/pacer.hpp"

#include <cerrno>
#include <ctime>

namespace attest {
namespace {

constexpr std::int64_t ns_per_s = 1'000'000'000;

}  // namespace

Nanoseconds Pacer::now_monotonic() {
  timespec time{};
  ::clock_gettime(CLOCK_MONOTONIC, &time);
  return Nanoseconds(std::int64_t{time.tv_sec} * ns_per_s + time.tv_nsec);
}

Nanoseconds Pacer::wait_until(Nanoseconds deadline) {
  const std::int64_t wakes = (origin_ + deadline - wait_.spin).count();
  const timespec until{static_cast<time_t>(wakes / ns_per_s), static_cast<long>(wakes % ns_per_s)};
  while (::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
  }
  Nanoseconds time = now();
  while (time < deadline) time = now();
  return time;
}

}  // namespace attest
