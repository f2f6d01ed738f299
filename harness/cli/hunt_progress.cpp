#include "harness/cli/hunt_progress.hpp"

#include <algorithm>
#include <cstdio>

#include <fmt/format.h>

#include "harness/realtime/usage.hpp"

namespace attest::cli {

HuntProgressLine::HuntProgressLine(bool is_quiet)
    : form_(Progress::on_stderr(is_quiet).form), begin_(Clock::now()), latest_(begin_) {}

void HuntProgressLine::show(const HuntProgress& now) {
  const bool is_drawn = form_ == Progress::Form::drawn;
  const bool is_due =
      form_ == Progress::Form::lines && Clock::now() - latest_ >= Progress::line_interval;
  if (!is_drawn && !is_due) return;
  latest_ = Clock::now();
  const double passed_s = std::chrono::duration<double>(latest_ - begin_).count();
  fmt::print(stderr,
             "{}{} steps, {:.0f} steps/s, {} met, {} failing trials, largest deviation of others "
             "{:.3f} of the tolerance{}",
             is_drawn ? "\r\x1b[K" : "attest: ", now.steps,
             static_cast<double>(now.steps) / passed_s, now.met.count(), now.failures,
             now.deviation, is_drawn ? "" : "\n");
  std::fflush(stderr);
}

void HuntProgressLine::erase() const {
  if (form_ == Progress::Form::drawn) fmt::print(stderr, "\r\x1b[K");
}

void print_hunt_speed(const HuntProgress& progress) {
  const double cpu = in_seconds(cpu_time_of_all());
  fmt::print(stderr, "attest: {} steps in {:.1f} s of CPU time, {:.0f} steps/s\n", progress.steps,
             cpu, static_cast<double>(progress.steps) / std::max(cpu, 1e-3));
}

}  // namespace attest::cli
