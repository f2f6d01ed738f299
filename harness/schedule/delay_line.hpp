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
  // `messages` is the number that can be on the way at once. No allocation after this.
  DelayLine(Nanoseconds delay, std::size_t messages) : delay_(delay), ring_(messages + 1) {}

  // REQUIRES: times do not decrease.
  void send(Nanoseconds now, const T& message) { send_for(now + delay_, message); }

  // The same, for a message whose time of arrival is known. REQUIRES: these do not decrease.
  void send_for(Nanoseconds arrival, const T& message) {
    ring_[end_ % ring_.size()] = {arrival, message};
    ++end_;
    if (end_ - begin_ > ring_.size()) begin_ = end_ - ring_.size();
  }

  // The latest message that has arrived by `now`, if a message arrived since the last call. Earlier
  // ones are lost, as for a reader of a topic.
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
  std::size_t begin_ = 0;  // of the messages on the way
  std::size_t end_ = 0;
};

}  // namespace attest
