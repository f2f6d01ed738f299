// Worker processes: jobs run in some processes at a time, and their answers come back as text. What
// the jobs do and what their answers mean is not known here (job.hpp).
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
  // Says an answer, and of how many tasks it is.
  using Done = std::function<void(const std::string& answer, std::size_t tasks)>;
  // In a worker: does the tasks from `first` on, in their order. One that returns before the last
  // has the rest done in a fresh process.
  std::function<void(std::size_t first, const Done& done)> run;
};

struct PoolOptions {
  int processes = 1;
  std::function<bool()> stop = [] { return false; };  // true: end soon, answers do not matter
  // In the caller's process, in any order. False: begin no piece of work after this one.
  std::function<bool(std::size_t work, const std::string& answer)> on_answer;
  // The rest of that piece is not done: a process cannot be started, or one died. The latter is a
  // mistake of ours, as the code of a port is in processes of its own (host/port_process.hpp).
  std::function<bool(std::size_t work, const Error& error)> on_error;
};

// The index of the first piece of work that was not begun, or how many there are. Pieces are begun
// in their order.
std::size_t run_in_workers(const std::vector<Work>& work, const PoolOptions& options);

}  // namespace attest
