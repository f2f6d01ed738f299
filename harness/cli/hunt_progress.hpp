// Shows how far a hunt is, and how fast it was.
#pragma once

#include <chrono>

#include "harness/diagnosis/hunt.hpp"
#include "harness/report/progress.hpp"

namespace attest::cli {

// The progress on stderr, in the form that Progress has: after each round on a terminal, else every
// 30 s.
class HuntProgressLine {
 public:
  explicit HuntProgressLine(bool is_quiet);
  ~HuntProgressLine() { erase(); }

  void show(const HuntProgress& now);
  void erase() const;

 private:
  using Clock = std::chrono::steady_clock;

  Progress::Form form_;
  Clock::time_point begin_, latest_;
};

// Prints the steps of the whole hunt on stderr, and its steps a second of CPU time of all
// processes.
void print_hunt_speed(const HuntProgress& progress);

}  // namespace attest::cli
