#include "harness/process/pool.hpp"

#include <algorithm>
#include <optional>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <poll.h>

#include "harness/core/own_arena.hpp"
#include "harness/process/child.hpp"

namespace attest {
namespace {

class Pool {
 public:
  Pool(const std::vector<Work>& work, const PoolOptions& options)
      : work_(work),
        options_(options),
        most_(static_cast<std::size_t>(std::max(options.processes, 1))),
        end_(work.size()) {}

  std::size_t run() {
    for (start_workers(); !workers_.empty() && !options_.stop(); start_workers()) {
      for (const std::size_t i : readable()) serve(workers_[i]);
      std::erase_if(workers_, [](const Worker& worker) { return worker.over; });
    }
    return std::min(next_, end_);
  }

 private:
  struct Worker {
    Child child;
    std::size_t work;
    std::size_t open_tasks;  // of `work`, without an answer yet
    bool over = false;
  };

  void start_workers() {
    while (workers_.size() < most_ && next_work() && !options_.stop()) {
      auto child = Child::spawn(Child::Runs::our_code, [this](MessageSocket& parent) {
        in_own_arena([&] { do_work(parent); });
      });
      if (child) {
        workers_.push_back({*std::move(child), 0, 0});
        give_work(workers_.back());
      } else {
        cannot_begin(take_work(), child.error(), workers_.size());
      }
    }
  }

  // Work that a worker has given back, or else the next work with tasks. Empty: no needed work is
  // left to give.
  std::optional<std::size_t> next_work() {
    if (!given_back_.empty() && *given_back_.begin() < end_) return *given_back_.begin();
    while (next_ < end_ && work_[next_].tasks == 0) ++next_;
    return next_ < end_ ? std::optional(next_) : std::nullopt;
  }

  // REQUIRES: next_work().
  std::size_t take_work() {
    const std::size_t work = *next_work();
    if (given_back_.erase(work) == 0) ++next_;
    return work;
  }

  // A worker, or a process that it needs, cannot be started, perhaps because there are too many
  // processes. `others` is the number of other workers: if there are any, they do the work.
  void cannot_begin(std::size_t work, const Error& error, std::size_t others) {
    most_ = std::max<std::size_t>(others, 1);
    if (others > 0) {
      given_back_.insert(work);
    } else {
      fail(work, error);
    }
  }

  // Runs in a worker: does the work that the parent asks for.
  void do_work(MessageSocket& parent) {
    // An interrupt may come just before the fork. The work must not begin then: it would report the
    // interrupt as a port that does not answer.
    if (options_.stop()) return;
    bool has_begun = false;
    std::size_t index = 0;
    while (parent.receive().kind == Received::Kind::message &&
           parent.receive_blob(&index, sizeof index) == Received::Kind::message) {
      const Work& work = work_[index];
      const Work::Done send = [&](const std::string& answer, std::size_t tasks) {
        parent.send(answer, {{&tasks, sizeof tasks}});
      };
      if (!std::exchange(has_begun, true)) {
        const auto begun = work.begin_worker();
        if (!begun) return send(begun.error().to_string(), 0);
      }
      work.run(send);
      if (work.ends_worker()) return;
    }
  }

  // REQUIRES: next_work(). A failure of send() is ignored, because serve() notices that the worker
  // has died.
  void give_work(Worker& worker) {
    worker.work = take_work();
    worker.open_tasks = work_[worker.work].tasks;
    worker.child.socket().send("", {{&worker.work, sizeof worker.work}});
  }

  void fail(std::size_t work, const Error& error) {
    if (!options_.on_error(work, error)) end_ = std::min(end_, work + 1);
  }

  std::vector<std::size_t> readable() {
    std::vector<pollfd> descriptors;
    for (Worker& worker : workers_) {
      descriptors.push_back({worker.child.socket().descriptor(), POLLIN, 0});
    }
    constexpr int look_every_ms = 100;  // period of the checks of `stop` and for stopped guards
    ::poll(descriptors.data(), descriptors.size(), look_every_ms);
    for (Worker& worker : workers_) worker.child.wake();
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < descriptors.size(); ++i) {
      if (descriptors[i].revents != 0) found.push_back(i);
    }
    return found;
  }

  void serve(Worker& worker) {
    Patience patience;
    patience.given_up = options_.stop;
    const Received received = worker.child.receive(patience);
    if (received.kind == Received::Kind::given_up) return;
    if (received.kind != Received::Kind::message) return conclude(worker);
    std::size_t tasks = 0;
    if (worker.child.receive_blob(&tasks, sizeof tasks, patience) != Received::Kind::message) {
      return options_.stop() ? void() : conclude(worker);
    }
    if (tasks == 0) {
      worker.over = true;
      return cannot_begin(worker.work, {received.head}, workers_.size() - 1);
    }
    if (!options_.on_answer(worker.work, received.head)) end_ = std::min(end_, worker.work + 1);
    worker.open_tasks -= std::min(tasks, worker.open_tasks);
    if (worker.open_tasks > 0) return;
    if (next_work()) {
      give_work(worker);
    } else {
      worker.over = true;
    }
  }

  void conclude(Worker& worker) {
    worker.over = true;
    const std::string how = worker.child.end(), words = worker.child.last_words();
    // A worker that ended after its previous work (Work::ends_worker) did not receive this work.
    const bool is_untouched = worker.open_tasks == work_[worker.work].tasks;
    if (worker.child.has_exited_well() && is_untouched && retried_.insert(worker.work).second) {
      given_back_.insert(worker.work);
      return;
    }
    fail(worker.work, {fmt::format("a worker process of attest {}{}{}; please report this", how,
                                   words.empty() ? "" : ": ", words)});
  }

  const std::vector<Work>& work_;
  const PoolOptions& options_;
  std::vector<Worker> workers_;
  std::size_t most_;      // workers at a time
  std::size_t next_ = 0;  // the next work for a worker
  std::size_t end_;       // of the needed work
  std::set<std::size_t> given_back_, retried_;
};

}  // namespace

std::size_t run_in_workers(const std::vector<Work>& work, const PoolOptions& options) {
  make_heap_cheap_to_fork();
  return Pool(work, options).run();
}

}  // namespace attest
