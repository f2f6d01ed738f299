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
// cannot write, so it cannot extend the limits.
class AnswerMeter {
 public:
  enum class Limit { none, running, asleep, memory };

  // `port` must outlive this.
  AnswerMeter(const PortChild& port, double timeout_s, bool is_program)
      : port_(port), most_(timeout_s), is_program_(is_program) {}

  // Looks at the processes of the port at most every 100 ms.
  Limit exceeded();

 private:
  const PortChild& port_;
  std::chrono::duration<double> most_;
  bool is_program_;
  std::chrono::steady_clock::time_point looked_ = std::chrono::steady_clock::now();
  std::chrono::steady_clock::time_point began_ = looked_;
  std::optional<TreeUsage> at_begin_;
  std::uint64_t calls_ = 0;
};

// "10 s of CPU time"
std::string text_of(AnswerMeter::Limit exceeded, double timeout_s);

}  // namespace attest
