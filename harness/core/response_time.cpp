#include "harness/core/response_time.hpp"

#include <algorithm>

namespace attest {
namespace {

// J of response_time.hpp; empty when the releasing task has no bound.
std::optional<Nanoseconds> release_jitter(const std::vector<ScheduledTask>& tasks,
                                          const ScheduledTask& task) {
  if (!task.released_by) return Nanoseconds(0);
  const auto latest = response_time(tasks, *task.released_by);
  if (!latest) return std::nullopt;
  const auto& execution = tasks[*task.released_by].execution;
  return *latest - *std::min_element(execution.begin(), execution.end());
}

}  // namespace

std::optional<Nanoseconds> response_time(const std::vector<ScheduledTask>& tasks,
                                         std::size_t task) {
  const ScheduledTask& own = tasks[task];
  const auto own_jitter = release_jitter(tasks, own);
  if (!own_jitter) return std::nullopt;
  Nanoseconds response = own.worst_execution();
  while (true) {
    Nanoseconds next = own.worst_execution();
    for (const ScheduledTask& other : tasks) {
      if (other.cpu != own.cpu || other.priority <= own.priority) continue;
      if (other.released_by == task) {
        next += other.worst_execution();
        continue;
      }
      const auto jitter = release_jitter(tasks, other);
      if (!jitter) return std::nullopt;
      // ticks_in(): the releases in [0, R + J) of a task with releases at 0, T, 2T, ...
      next += other.rate.ticks_in(response + *jitter) * other.worst_execution();
    }
    if (next + *own_jitter > own.rate.tick(1)) return std::nullopt;
    if (next == response) return response;
    response = next;
  }
}

}  // namespace attest
