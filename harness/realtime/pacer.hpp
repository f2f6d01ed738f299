// The clock of a real-time loop. It sleeps until absolute times, so that latencies do not add up.
#pragma once

#include "harness/realtime/clock.hpp"

namespace attest {

struct Wait {
  // The sleep ends this long before the release. Then the thread spins until the release, which
  // takes more CPU time and makes the latency smaller.
  Nanoseconds spin{0};
};

// Uses CLOCK_MONOTONIC. One per thread; no allocation, no lock.
class Pacer final : public Clock {
 public:
  // `origin` is now_monotonic() at time 0.
  Pacer(Nanoseconds origin, Wait wait) : origin_(origin), wait_(wait) {}

  static Nanoseconds now_monotonic();

  Nanoseconds now() override { return now_monotonic() - origin_; }
  Nanoseconds wait_until(Nanoseconds deadline) override;

 private:
  Nanoseconds origin_;
  Wait wait_;
};

}  // namespace attest
