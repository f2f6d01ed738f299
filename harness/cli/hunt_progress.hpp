// Shows how far a hunt is.
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

}  // namespace attest::cli
