#include "harness/core/fixed_priority.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <set>

#include <fmt/format.h>

namespace attest {
namespace {

constexpr Nanoseconds never = Nanoseconds::max();

// A task while it is simulated.
struct Queue {
  const ScheduledTask* task;
  std::vector<TaskJob>* jobs;
  const std::vector<TaskJob>* releasing;  // jobs that release this task; null: its rate does
  std::int64_t released = 0;              // jobs released so far
  std::size_t finished = 0;
  Nanoseconds remaining{0};  // execution time of job `finished`; 0: it has not begun

  Nanoseconds next_release(Nanoseconds duration) const {
    const Nanoseconds time = releasing ? next_finish() : task->phase + task->rate.tick(released);
    return time < duration ? time : never;
  }
  // The time at which the releasing task's next job finished; `never` if it has not finished yet.
  Nanoseconds next_finish() const {
    const auto next = static_cast<std::size_t>(released);
    if (next >= releasing->size()) return never;
    const Nanoseconds finish = (*releasing)[next].finish;
    return finish > Nanoseconds(0) ? finish : never;
  }
  bool is_ready() const { return finished < jobs->size(); }
};

class Cpu {
 public:
  Cpu(std::vector<Queue> queues, Nanoseconds duration)
      : queues_(std::move(queues)), duration_(duration) {
    std::sort(queues_.begin(), queues_.end(),
              [](const Queue& a, const Queue& b) { return a.task->priority > b.task->priority; });
  }

  void run() {
    for (Nanoseconds now{0};;) {
      const Nanoseconds release = release_until(now);
      Queue* const running = first_ready();
      if (running == nullptr && release == never) return;
      now = running == nullptr ? release : work(*running, now, release);
    }
  }

 private:
  // Releases all jobs that are due by `now`. Returns the time of the next release, or `never`.
  Nanoseconds release_until(Nanoseconds now) {
    Nanoseconds next = never;
    for (Queue& queue : queues_) {
      Nanoseconds time = queue.next_release(duration_);
      for (; time <= now; time = queue.next_release(duration_)) {
        queue.jobs->push_back({time, {}, {}});
        ++queue.released;
      }
      next = std::min(next, time);
    }
    return next;
  }

  Queue* first_ready() {
    const auto found = std::find_if(queues_.begin(), queues_.end(),
                                    [](const Queue& queue) { return queue.is_ready(); });
    return found == queues_.end() ? nullptr : &*found;
  }

  // Runs the first unfinished job of `queue` from `now` until it finishes or until `release`, the
  // next release on this CPU. Returns the end of this run.
  static Nanoseconds work(Queue& queue, Nanoseconds now, Nanoseconds release) {
    TaskJob& job = (*queue.jobs)[queue.finished];
    if (queue.remaining == Nanoseconds(0)) {
      job.start = now;
      queue.remaining = queue.task->execution[queue.finished % queue.task->execution.size()];
    }
    const Nanoseconds until = std::min(now + queue.remaining, release);
    queue.remaining -= until - now;
    if (queue.remaining == Nanoseconds(0)) {
      job.finish = until;
      ++queue.finished;
    }
    return until;
  }

  std::vector<Queue> queues_;  // by priority, highest first
  Nanoseconds duration_;
};

std::set<int> cpus_of(const std::vector<ScheduledTask>& tasks) {
  std::set<int> cpus;
  for (const ScheduledTask& task : tasks) cpus.insert(task.cpu);
  return cpus;
}

// The CPU of a releasing task comes first, because the released task needs its finish times.
std::vector<int> cpus_in_order(const std::vector<ScheduledTask>& tasks) {
  const std::set<int> cpus = cpus_of(tasks);
  std::vector<int> order(cpus.begin(), cpus.end());
  for (const ScheduledTask& task : tasks) {
    if (!task.released_by) continue;
    const int first = tasks[*task.released_by].cpu;
    std::stable_partition(order.begin(), order.end(), [=](int cpu) { return cpu == first; });
  }
  return order;
}

Result<void> check(const std::vector<ScheduledTask>& tasks) {
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (tasks[i].cpu != tasks[j].cpu || tasks[i].priority != tasks[j].priority) continue;
      return fail(
          fmt::format("`{}` and `{}` have the same priority {} on CPU {}; give each its own",
                      tasks[j].name, tasks[i].name, tasks[i].priority, tasks[i].cpu));
    }
  }
  for (const int cpu : cpus_of(tasks)) {
    const double asked = utilisation(tasks, cpu);
    if (asked <= 1 + 1e-12) continue;
    return fail(fmt::format("the tasks of CPU {} need {:.1f}% of it; shorten or slow down tasks",
                            cpu, 100 * asked));
  }
  return {};
}

}  // namespace

Nanoseconds ScheduledTask::worst_execution() const {
  return *std::max_element(execution.begin(), execution.end());
}

double utilisation(const std::vector<ScheduledTask>& tasks, int cpu) {
  double sum = 0;
  for (const ScheduledTask& task : tasks) {
    if (task.cpu != cpu) continue;
    sum += in_seconds(task.worst_execution()) * task.rate.hertz();
  }
  return sum;
}

Result<std::vector<std::vector<TaskJob>>> simulate(const std::vector<ScheduledTask>& tasks,
                                                   Nanoseconds duration) {
  if (auto checked = check(tasks); !checked) return tl::unexpected(checked.error());
  std::vector<std::vector<TaskJob>> jobs(tasks.size());
  for (const int cpu : cpus_in_order(tasks)) {
    std::vector<Queue> queues;
    for (std::size_t i = 0; i < tasks.size(); ++i) {
      const auto& by = tasks[i].released_by;
      if (tasks[i].cpu == cpu) queues.push_back({&tasks[i], &jobs[i], by ? &jobs[*by] : nullptr});
    }
    Cpu(std::move(queues), duration).run();
  }
  return jobs;
}

}  // namespace attest
