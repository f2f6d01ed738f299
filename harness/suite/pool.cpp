#include "harness/suite/pool.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include <fmt/format.h>
#include <poll.h>

namespace attest {
namespace {

constexpr const char* forgery = "the port wrote on the pipe on which attest's worker answers";

// In the child.
void work_through(Batch& batch, std::size_t first, const WorkerOptions& options,
                  const SendLine& send) {
  const auto opened = batch.open();
  auto port = open_port(options.port);
  if (!opened || !port) {
    send(encode(opened ? port.error() : opened.error()));
    return send(encode(BatchDone{}));
  }
  HeldPort held(std::move(*port), options.said);
  for (std::size_t i = first; i < batch.size(); ++i) {
    batch.when_part_begins([&send, i] { send(encode(TaskBegins{i})); });
    send(encode(TaskBegins{i}));
    auto result = batch.evaluate(i, held);
    if (result) held.hold(*result);
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
    const std::size_t batch = next_++;
    if (!hangs_when_loaded_) {
      start(batch, 0);
    } else {
      give_up(batch, 0, "not run: the port had timed out when it was loaded");
      stop_after_failure(batch);
    }
  }
}

void Pool::start(std::size_t batch, std::size_t first_task) {
  auto child = Child::spawn(
      [&](const SendLine& send) { work_through(*batches_[batch], first_task, options_, send); });
  if (!child) {
    outcomes_[batch].errors.push_back(child.error());
    return;
  }
  Worker worker{batch, std::move(*child), first_task, deadline()};
  worker.first_result = outcomes_[batch].results.size();
  workers_.push_back(std::move(worker));
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
      const auto message = decode(line);
      worker.forged = !message || !is_in_turn(worker, *message);
      if (worker.forged) return conclude(worker, false);
      take(worker, *message);
    }
    // Not when the pipe ends: a process that the port started may hold it open.
    if (ended || worker.finished) return conclude(worker, false);
  }
  if (Clock::now() >= worker.deadline) conclude(worker, true);
}

// What the port could have written is a message like those of the worker. One is accepted only of
// the task that runs, once, and after it began.
bool Pool::is_in_turn(const Worker& worker, const Message& message) const {
  const Batch& batch = *batches_[worker.batch];
  if (std::holds_alternative<BatchDone>(message)) {
    return worker.task == batch.size() || worker.has_no_tasks;
  }
  if (worker.task == batch.size() || worker.has_no_tasks) return false;
  if (const auto* begins = std::get_if<TaskBegins>(&message)) {
    return begins->task == worker.task && worker.begins <= batch.most_parts();
  }
  if (const auto* result = std::get_if<CaseResult>(&message)) {
    const CaseResult task = batch.identity(worker.task);
    // A fault is judged by cases of any rate.
    const bool has_rate = batch.most_parts() == 0;
    return worker.begins > 0 && result->case_id() == task.case_id() &&
           (!has_rate || result->id() == task.id());
  }
  return true;
}

void Pool::take(Worker& worker, const Message& message) {
  if (std::holds_alternative<TaskBegins>(message)) {
    worker.deadline = deadline();
    worker.is_loaded = true;
    ++worker.begins;
  }
  if (const auto* result = std::get_if<CaseResult>(&message)) {
    add(worker.batch, *result);
    ++worker.task;
    worker.begins = 0;
  }
  if (const auto* error = std::get_if<Error>(&message)) {
    outcomes_[worker.batch].errors.push_back(*error);
    worker.has_no_tasks = worker.begins == 0;
    ++worker.task;
    worker.begins = 0;
  }
  if (std::holds_alternative<BatchDone>(message)) worker.finished = true;
}

void Pool::add(std::size_t batch, const CaseResult& result) {
  outcomes_[batch].results.push_back(result);
  options_.on_result(result);
}

// Which of its answers were the port's is not known.
void Pool::distrust(const Worker& worker) {
  std::vector<CaseResult>& results = outcomes_[worker.batch].results;
  for (std::size_t i = worker.first_result; i < results.size(); ++i) {
    CaseResult doubtful;
    doubtful.profile = results[i].profile;
    doubtful.group = results[i].group;
    doubtful.name = results[i].name;
    doubtful.rate = results[i].rate;
    doubtful.flyer = results[i].flyer;
    doubtful.verdict = Verdict::protocol;
    doubtful.reason = forgery;
    results[i] = std::move(doubtful);
  }
}

// The tasks of a batch from this one on are not run.
void Pool::give_up(std::size_t batch, std::size_t first_task, const std::string& reason) {
  for (std::size_t task = first_task; task < batches_[batch]->size(); ++task) {
    CaseResult result = batches_[batch]->identity(task);
    result.verdict = Verdict::timeout;
    result.reason = reason;
    add(batch, result);
  }
}

// The child has ended or must: the task it left gets a verdict, the rest of the batch a new child.
void Pool::conclude(Worker& worker, bool timed_out) {
  const std::size_t batch = worker.batch;
  const std::size_t size = batches_[batch]->size();
  worker.over = true;
  // A worker that has answered all its tasks says that it is done.
  worker.forged = worker.forged || (!worker.finished && worker.task == size);
  if (worker.forged) distrust(worker);
  if (!worker.finished && worker.task < size) {
    add(batch, verdict_on_the_dead(worker, timed_out));
    ++worker.task;
    if (timed_out) {
      hangs_when_loaded_ = hangs_when_loaded_ || !worker.is_loaded;
      // A port that hangs at one rate hangs at the others: their time would be wasted.
      give_up(batch, worker.task, "not run: the port had timed out in this case");
      worker.task = size;
    }
  }
  const std::size_t left = worker.finished ? size : worker.task;
  stop_after_failure(batch);
  if (left < size) start(batch, left);  // `worker` may have moved
}

CaseResult Pool::verdict_on_the_dead(Worker& worker, bool timed_out) {
  if (timed_out || worker.forged) worker.child.kill();
  const std::string how = worker.child.end();
  CaseResult result = batches_[worker.batch]->identity(worker.task);
  result.verdict = timed_out ? Verdict::timeout : Verdict::crash;
  result.reason = timed_out ? fmt::format("no answer within {} s{}", options_.timeout_s,
                                          worker.is_loaded ? "" : ", when it was loaded")
                            : fmt::format("the port's process {}", how);
  if (worker.forged) {
    result.verdict = Verdict::protocol;
    result.reason = forgery;
    return result;
  }
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
