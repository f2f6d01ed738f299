#include "harness/core/event_queue.hpp"

namespace attest {

EventQueue::EventQueue(std::vector<std::vector<Nanoseconds>> times) {
  for (auto& of_task : times) tasks_.push_back({std::move(of_task), 0});
}

std::optional<EventQueue::Event> EventQueue::next() {
  std::optional<Event> first;
  for (std::size_t i = 0; i < tasks_.size(); ++i) {
    const auto& [times, done] = tasks_[i];
    if (done == times.size() || (first && first->time <= times[done])) continue;
    first = Event{i, done, times[done]};
  }
  if (first) ++tasks_[first->task].done;
  return first;
}

}  // namespace attest
