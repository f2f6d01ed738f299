// A clock that is late as a test says.
#pragma once

#include <algorithm>
#include <functional>
#include <vector>

#include "harness/schedule/clock.hpp"

namespace attest {

// Wakes up late by `latency` of its next release; time passes nowhere else by itself.
class ScriptedClock final : public Clock {
 public:
  Nanoseconds now() override { return now_; }
  Nanoseconds wait_until(Nanoseconds deadline) override {
    deadlines.push_back(deadline);
    before_waiting(deadline);
    now_ = std::max(now_, deadline + latency(deadline));
    return now_;
  }
  void pass(Nanoseconds time) { now_ += time; }

  std::function<Nanoseconds(Nanoseconds)> latency = [](Nanoseconds) { return Nanoseconds(0); };
  std::function<void(Nanoseconds deadline)> before_waiting = [](Nanoseconds) {};
  std::vector<Nanoseconds> deadlines;

 private:
  Nanoseconds now_{0};
};

}  // namespace attest
