// Worker processes: pieces of work run in several processes at a time, and send their answers as
// text. The meaning of work and answers is defined elsewhere (job.hpp).
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "harness/core/result.hpp"

namespace attest {

// Some tasks in a row for one process.
struct Work {
  std::size_t tasks = 0;
  // Called before `run` in a worker whose first piece of work this is. After an error another
  // worker does the work; if there is no other worker, on_error is called.
  std::function<Result<void>()> begin_worker = [] { return Result<void>(); };
  // Sends an answer, and the number of tasks to which it applies.
  using Done = std::function<void(const std::string& answer, std::size_t tasks)>;
  // Called in a worker: does the tasks in their order. The worker does other work afterwards,
  // unless `ends_worker` returns true.
  std::function<void(const Done& done)> run;
  // Called after `run`: whether the worker must not do other work.
  std::function<bool()> ends_worker = [] { return false; };
};

struct PoolOptions {
  int processes = 1;
  std::function<bool()> stop = [] { return false; };  // true: end soon, answers are not needed
  // Called in the caller's process, in any order of the pieces. Returns false if the pieces after
  // `work` are not needed.
  std::function<bool(std::size_t work, const std::string& answer)> on_answer;
  // Called if no worker can begin the piece, or if its worker died. The rest of the piece is not
  // done. The death of a worker is a bug of attest, because the code of a port runs in processes of
  // its own (host/port_process.hpp). Returns the same as on_answer.
  std::function<bool(std::size_t work, const Error& error)> on_error;
};

// Begins the pieces of work in their order. Returns the index of the first one that was not begun
// or is not needed; work.size() if all were done.
std::size_t run_in_workers(const std::vector<Work>& work, const PoolOptions& options);

}  // namespace attest
