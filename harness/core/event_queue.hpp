// Merges the events of several tasks into one sequence.
//
// Events are ordered by time; at one instant, by the number of their task. This rule alone orders
// simultaneous events of a simulated flight.
#pragma once

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "harness/core/time.hpp"

namespace attest {

class EventQueue {
 public:
  struct Event {
    std::size_t task;
    std::size_t index;  // of `time` among the task's times, from 0
    Nanoseconds time;
  };

  // `times[i]`: the times at which task i runs. REQUIRES: no task's times decrease.
  explicit EventQueue(std::vector<std::vector<Nanoseconds>> times);

  // The number of times that a task runs.
  std::size_t size(std::size_t task) const { return tasks_[task].times.size(); }

  // The next event; empty after the last one. No allocation.
  std::optional<Event> next();

 private:
  struct Task {
    std::vector<Nanoseconds> times;
    std::size_t done = 0;
  };
  std::vector<Task> tasks_;
};

}  // namespace attest
