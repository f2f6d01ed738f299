// Messages that arrive some time after they were sent: the results of a task with a delay.
#pragma once

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "harness/core/time.hpp"

namespace attest {

template <typename T>
class DelayLine {
 public:
  // `messages`: how many can be on the way at once; if there are more, the oldest are lost. No
  // allocation after this.
  DelayLine(Nanoseconds delay, std::size_t messages) : delay_(delay), ring_(messages + 1) {}

  // The message arrives at `now` + delay. REQUIRES: `now` does not decrease from call to call.
  void send(Nanoseconds now, const T& message) { send_for(now + delay_, message); }

  // The message arrives at `arrival`. REQUIRES: times of arrival do not decrease.
  void send_for(Nanoseconds arrival, const T& message) {
    ring_[end_ % ring_.size()] = {arrival, message};
    ++end_;
    if (end_ - begin_ > ring_.size()) begin_ = end_ - ring_.size();
  }

  // The latest message that arrived by `now` and after the last call; empty if there is none.
  // Earlier messages are lost, as for a reader of a uORB topic.
  std::optional<T> receive(Nanoseconds now) {
    std::optional<T> latest;
    for (; begin_ != end_ && ring_[begin_ % ring_.size()].first <= now; ++begin_) {
      latest = ring_[begin_ % ring_.size()].second;
    }
    return latest;
  }

 private:
  Nanoseconds delay_;
  std::vector<std::pair<Nanoseconds, T>> ring_;
  // Messages begin_ to end_ - 1 are on the way, counted from the first one sent.
  std::size_t begin_ = 0;
  std::size_t end_ = 0;
};

}  // namespace attest
