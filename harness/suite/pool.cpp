#include "harness/suite/pool.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include <fmt/format.h>
#include <poll.h>

namespace attest {
namespace {

// In the child.
void work_through(Batch& batch, std::size_t first, const std::string& specification,
                  const SendLine& send) {
  const auto opened = batch.open();
  auto port = open_port(specification);
  if (!opened || !port) {
    send(encode(opened ? port.error() : opened.error()));
    return send(encode(BatchDone{}));
  }
  for (std::size_t i = first; i < batch.size(); ++i) {
    send(encode(TaskBegins{i}));
    auto result = batch.evaluate(i, **port);
    send(result ? encode(std::move(*result)) : encode(result.error()));
  }
  send(encode(BatchDone{}));
}

}  // namespace

Pool::Pool(const Batches& batches, const WorkerOptions& options)
    : batches_(batches), options_(options), outcomes_(batches.size()), end_(batches.size()) {}

WorkerOutcome Pool::run() {
  for (start_workers(); !workers_.empty() && !options_.stop(); start_workers()) {
    wait();
    // By index: a worker that died is replaced by one for the rest of its batch.
    for (std::size_t i = 0, count = workers_.size(); i < count; ++i) serve(workers_[i]);
    std::erase_if(workers_, [](const Worker& worker) { return worker.over; });
  }
  return collect();
}

Pool::Clock::time_point Pool::deadline() const {
  const std::chrono::duration<double> limit(options_.timeout_s);
  return Clock::now() + std::chrono::duration_cast<Clock::duration>(limit);
}

void Pool::start_workers() {
  const auto jobs = static_cast<std::size_t>(std::max(options_.jobs, 1));
  while (workers_.size() < jobs && next_ < end_) {
    start(next_++, 0);
  }
}

void Pool::start(std::size_t batch, std::size_t first_task) {
  auto child = Child::spawn([&](const SendLine& send) {
    work_through(*batches_[batch], first_task, options_.port, send);
  });
  if (!child) {
    outcomes_[batch].errors.push_back(child.error());
    return;
  }
  workers_.push_back({batch, std::move(*child), first_task, deadline()});
}

// Until a worker says something or runs out of time.
void Pool::wait() {
  std::vector<pollfd> descriptors;
  Clock::time_point earliest = Clock::time_point::max();
  for (const Worker& worker : workers_) {
    descriptors.push_back({worker.child.descriptor(), POLLIN, 0});
    earliest = std::min(earliest, worker.deadline);
  }
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(earliest - Clock::now()).count();
  ::poll(descriptors.data(), descriptors.size(), static_cast<int>(std::clamp(left, 0L, 60'000L)));
  for (std::size_t i = 0; i < workers_.size(); ++i) {
    workers_[i].readable = descriptors[i].revents != 0;
  }
}

void Pool::serve(Worker& worker) {
  if (worker.readable) {
    bool ended = false;
    for (const std::string& line : worker.child.read_lines(ended)) {
      if (const auto message = decode(line)) take(worker, *message);
    }
    // Not when the pipe ends: a process that the port started may hold it open.
    if (ended || worker.finished) return conclude(worker, false);
  }
  if (Clock::now() >= worker.deadline) conclude(worker, true);
}

void Pool::take(Worker& worker, const Message& message) {
  if (std::holds_alternative<TaskBegins>(message)) worker.deadline = deadline();
  if (const auto* result = std::get_if<CaseResult>(&message)) add(worker, *result);
  if (const auto* error = std::get_if<Error>(&message)) {
    outcomes_[worker.batch].errors.push_back(*error);
    ++worker.task;
  }
  if (std::holds_alternative<BatchDone>(message)) worker.finished = true;
}

void Pool::add(Worker& worker, const CaseResult& result) {
  outcomes_[worker.batch].results.push_back(result);
  ++worker.task;
  options_.on_result(result);
}

// The child has ended or must: the task it left gets a verdict, the rest of the batch a new child.
void Pool::conclude(Worker& worker, bool timed_out) {
  const std::size_t batch = worker.batch;
  const std::size_t size = batches_[batch]->size();
  worker.over = true;
  if (!worker.finished && worker.task < size) {
    add(worker, verdict_on_the_dead(worker, timed_out));
    // A port that hangs at one rate hangs at the others: their time would be wasted.
    while (timed_out && worker.task < size) {
      CaseResult result = batches_[batch]->identity(worker.task);
      result.verdict = Verdict::timeout;
      result.reason = "not run: the port had timed out in this case";
      add(worker, result);
    }
  }
  const std::size_t left = worker.finished ? size : worker.task;
  stop_after_failure(batch);
  if (left < size) start(batch, left);  // `worker` may have moved
}

CaseResult Pool::verdict_on_the_dead(Worker& worker, bool timed_out) {
  // Its pipe is closed or its time is up. A process that is ending keeps its own end; one that
  // closed the pipe and lives on would never be waited for to the end.
  constexpr double enough_to_end_s = 2;
  const bool ended = !timed_out && worker.child.ends_within(enough_to_end_s);
  worker.child.kill();
  const std::string end = worker.child.end();
  const std::string how = ended ? end : "closed the pipe on which it answers, and went on";
  CaseResult result = batches_[worker.batch]->identity(worker.task);
  result.verdict = timed_out ? Verdict::timeout : Verdict::crash;
  result.reason = timed_out ? fmt::format("no answer within {} s", options_.timeout_s)
                            : fmt::format("the port's process {}", how);
  const std::string words = worker.child.last_words();
  if (!words.empty()) result.reason += fmt::format("; it last printed: {}", words);
  return result;
}

void Pool::stop_after_failure(std::size_t batch) {
  if (!options_.fail_fast) return;
  const Outcome& outcome = outcomes_[batch];
  const bool failed = !outcome.errors.empty() ||
                      std::any_of(outcome.results.begin(), outcome.results.end(), options_.fails);
  if (failed) end_ = std::min(end_, batch + 1);
}

WorkerOutcome Pool::collect() {
  WorkerOutcome all;
  all.stopped_early = end_ < batches_.size();
  for (std::size_t i = 0; i < end_; ++i) {
    std::move(outcomes_[i].results.begin(), outcomes_[i].results.end(),
              std::back_inserter(all.results));
    std::move(outcomes_[i].errors.begin(), outcomes_[i].errors.end(),
              std::back_inserter(all.errors));
  }
  return all;
}

}  // namespace attest
