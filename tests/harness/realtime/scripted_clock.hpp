// A clock whose lateness the test gives.
#pragma once

#include <algorithm>
#include <functional>
#include <vector>

#include "harness/realtime/clock.hpp"

namespace attest {

// A wait ends `latency` after its deadline. Otherwise time passes only by pass().
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
