#include "harness/schedule/response_time.hpp"

namespace attest {

std::optional<Nanoseconds> response_time(const std::vector<ScheduledTask>& tasks,
                                         std::size_t task) {
  const ScheduledTask& own = tasks[task];
  Nanoseconds response = own.worst_execution();
  while (true) {
    Nanoseconds next = own.worst_execution();
    for (const ScheduledTask& other : tasks) {
      if (other.cpu != own.cpu || other.priority <= own.priority) continue;
      // Of a task with releases at 0, T, 2T, ..: those in [0, R).
      next += other.rate.ticks_in(response) * other.worst_execution();
    }
    if (next > own.rate.tick(1)) return std::nullopt;
    if (next == response) return response;
    response = next;
  }
}

}  // namespace attest
