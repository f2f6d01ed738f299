// One line with the progress of a run, on a terminal only.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdio>
#include <string>

#include "harness/verify/verdict.hpp"

namespace attest {

// Used from one thread. finish() and the destructor erase the line, so that the next output starts
// on a clean line.
class Progress {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::milliseconds redraw_interval{50};

  struct Options {
    std::FILE* stream = stderr;
    bool visible = false;
    int width = 80;  // columns of the terminal
  };

  // Visible when stderr is a terminal that can move its cursor and `quiet` is false.
  static Options on_stderr(bool quiet);

  // `done`: how many of `total` were done before.
  Progress(std::size_t total, Options options, std::size_t done = 0)
      : options_(options), total_(total), done_(done), done_before_(done) {}
  ~Progress() { finish(); }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  // Counts one more result. Draws at most once per redraw_interval. From the second drawing on, the
  // line has the results per second and the remaining time.
  void add(const VectorResult& result, Clock::time_point now = Clock::now());
  void add(bool failed, const std::string& latest, Clock::time_point now = Clock::now());
  void finish();

 private:
  void draw(const std::string& latest, Clock::time_point now) const;
  std::string speed(Clock::time_point now) const;

  Options options_;
  std::size_t total_;
  std::size_t done_;
  std::size_t done_before_;  // after the first add(), when the time count begins
  std::size_t failed_ = 0;
  bool drawn_ = false;
  Clock::time_point last_drawn_{}, begin_{};
};

}  // namespace attest
