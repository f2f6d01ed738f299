// The parent's side of the worker processes: starts them, listens, and gives a verdict on those
// that die or fall silent.
#pragma once

#include <chrono>
#include <cstddef>
#include <string>
#include <vector>

#include "harness/process/child.hpp"
#include "harness/suite/message.hpp"
#include "harness/suite/worker.hpp"

namespace attest {

class Pool {
 public:
  Pool(const Batches& batches, const WorkerOptions& options);

  WorkerOutcome run();

 private:
  using Clock = std::chrono::steady_clock;

  // A batch on its way.
  struct Worker {
    std::size_t batch;
    Child child;
    std::size_t task;  // that runs, or will
    Clock::time_point deadline;
    std::size_t begins = 0;        // of this task: its own and those of its parts
    std::size_t first_result = 0;  // of this worker, in the outcome of its batch
    bool is_loaded = false;        // the port: a task has begun
    bool readable = false;
    bool has_no_tasks = false;  // an error of the whole batch was its answer
    bool finished = false;      // said so
    bool forged = false;        // something else than the worker wrote on its pipe
    bool over = false;
  };
  struct Outcome {
    std::vector<CaseResult> results;
    std::vector<Error> errors;
  };

  void start_workers();
  void start(std::size_t batch, std::size_t first_task);
  void wait();
  void serve(Worker& worker);
  bool is_in_turn(const Worker& worker, const Message& message) const;
  void take(Worker& worker, const Message& message);
  void add(std::size_t batch, const CaseResult& result);
  void distrust(const Worker& worker);
  void give_up(std::size_t batch, std::size_t first_task, const std::string& reason);
  void conclude(Worker& worker, bool timed_out);
  CaseResult verdict_on_the_dead(Worker& worker, bool timed_out);
  void stop_after_failure(std::size_t batch);
  Clock::time_point deadline() const;
  WorkerOutcome collect();

  const Batches& batches_;
  const WorkerOptions& options_;
  std::vector<Outcome> outcomes_;
  std::vector<Worker> workers_;
  std::size_t next_ = 0;            // batch to start
  std::size_t end_;                 // of the batches that are wanted
  bool hangs_when_loaded_ = false;  // in each process: the other batches are not tried
};

}  // namespace attest
