// The progress of a run on stderr: one line that is drawn again on a terminal, else a line now and
// then, so that the log of a long run shows that it goes on.
#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <cstdio>
#include <optional>
#include <string>

#include "harness/verify/verdict.hpp"

namespace attest {

// Used from one thread. finish() and the destructor erase the line, so that the next output starts
// on a clean line.
class Progress {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::milliseconds redraw_interval{50};
  static constexpr std::chrono::seconds line_interval{10};

  enum class Form { none, drawn, lines };
  struct Options {
    std::FILE* stream = stderr;
    Form form = Form::none;
    int width = 80;  // columns of the terminal
  };

  // Drawn if stderr is a terminal that can move its cursor, else lines; none if `quiet`.
  static Options on_stderr(bool quiet);

  // `done`: how many of `total` were done before. `flights`: how many of `total` are flights, which
  // take longer than other vectors.
  Progress(std::size_t total, Options options, std::size_t done = 0, std::size_t flights = 0)
      : options_(options), total_(total), done_(done), done_before_(done) {
    kinds_[flight].left = flights;
    kinds_[other].left = total - std::min(total, done + flights);
  }
  ~Progress() { finish(); }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  // Counts one more result. Draws at most once per redraw_interval; writes a line at most once per
  // line_interval, the first one after that time. From the second drawing on, the line has the
  // results per second. It has the remaining time as soon as a result of each kind that is left is
  // known; the last results may take longer than the mean, so the end is never announced as 0 s.
  void add(const VectorResult& result, Clock::time_point now = Clock::now());
  void add(bool failed, const std::string& latest, Clock::time_point now = Clock::now());
  void finish();

 private:
  enum KindOfResult { other, flight };
  struct Kind {
    std::size_t left = 0;
    std::size_t done = 0;  // after the first add(), as `cost`
    double cost = 0;       // of those that are done, in a unit that all kinds share
  };

  void add(KindOfResult kind, double cost, bool failed, const std::string& latest,
           Clock::time_point now);
  void draw(const std::string& latest, Clock::time_point now) const;
  void write_line(Clock::time_point now) const;
  std::string speed(Clock::time_point now) const;
  std::optional<double> seconds_left(double seconds) const;

  Options options_;
  std::size_t total_;
  std::size_t done_;
  std::array<Kind, 2> kinds_;
  std::size_t done_before_;  // after the first add(), when the time count begins
  std::size_t failed_ = 0;
  bool drawn_ = false;
  Clock::time_point latest_{}, begin_{};  // of what was drawn or written
};

}  // namespace attest
