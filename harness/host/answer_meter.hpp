// The limits of one answer of a port.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include "harness/host/port_launcher.hpp"
#include "harness/process/tree_usage.hpp"

namespace attest {

// Measures an answer of the port. A machine under load must not make a right port late, so the
// limit is one of CPU time. Sleep has a limit of its own, and the time in which the port waits for
// a CPU does not count. The limits of a library are for a whole trace. A program may take longer
// for a trace, so its limits are for each call. The calls are counted in memory that the program
// cannot write, so it cannot extend the limits. A live flight takes its own time, so its limits are
// for each call, too. A library could write to that memory, so for it this holds only until the
// flight should have ended.
class AnswerMeter {
 public:
  enum class Limit { none, running, asleep, memory };

  using Clock = std::chrono::steady_clock;

  // `flight`: the duration of a live flight; 0: the answer is another. `port` must outlive this.
  AnswerMeter(const PortChild& port, double timeout_s, bool is_program, Nanoseconds flight);

  // Looks at the processes of the port at most every 100 ms.
  Limit exceeded();

 private:
  const PortChild& port_;
  std::chrono::duration<double> most_;
  Clock::time_point calls_count_until_ = Clock::time_point::min();  // the limits are for each call
  Clock::time_point looked_ = Clock::now();
  Clock::time_point began_ = looked_;
  std::optional<TreeUsage> at_begin_;
  std::uint64_t calls_ = 0;
};

// "10 s of CPU time"
std::string text_of(AnswerMeter::Limit exceeded, double timeout_s);

}  // namespace attest
