#include "harness/measure/clock_check.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "harness/core/sanitizers.hpp"

namespace attest {
namespace {

constexpr int sanitizer_factor = built_with_sanitizers ? 20 : 1;
constexpr Nanoseconds of_a_step = sanitizer_factor * std::chrono::microseconds(20);
constexpr Nanoseconds of_a_request =
    sanitizer_factor * std::chrono::milliseconds(10);  // may paint a stack of 8 MB
constexpr Nanoseconds of_a_process =
    sanitizer_factor * std::chrono::milliseconds(50);  // measures the clock

std::string shown_ms(Nanoseconds time) { return fmt::format("{:.3g} ms", 1000 * in_seconds(time)); }

}  // namespace

std::string clock_contradiction(const ClockTotals& totals) {
  if (totals.reported > totals.wall) {
    return fmt::format("its clock is wrong: its {} steps took {}, but its answers took only {}",
                       totals.steps, shown_ms(totals.reported), shown_ms(totals.wall));
  }
  const auto own = of_a_process + of_a_request * static_cast<std::int64_t>(totals.requests) +
                   of_a_step * static_cast<std::int64_t>(totals.steps);
  // Twice, because the kernel may count the time of a process in larger units.
  if (totals.used <= 2 * (totals.reported + totals.repeated) + own) return "";
  return fmt::format(
      "its clock is wrong: by it, its {} steps took {}, but its process used {} of CPU time",
      totals.steps, shown_ms(totals.reported), shown_ms(totals.used));
}

TimedRequest::TimedRequest(const PortHost& host)
    : host_(host), cpu_before_(host.cpu_time()), begin_(std::chrono::steady_clock::now()) {}

void TimedRequest::end(const StepTimes& reported, bool twice, ClockTotals& totals) const {
  const auto cpu = host_.cpu_time();
  if (!cpu || !cpu_before_) return;
  const Nanoseconds wall = std::chrono::steady_clock::now() - begin_;
  ++totals.requests;
  totals.steps += reported.steps.size();
  totals.wall += wall;
  totals.used += std::min(wall, *cpu - *cpu_before_);
  Nanoseconds all{0};
  for (const Nanoseconds step : reported.steps) {
    // No step is longer than the request. The limit also keeps the sum from an overflow.
    const bool is_possible = step >= Nanoseconds(0) && step <= wall;
    all += is_possible ? step : totals.wall + std::chrono::seconds(1);
  }
  totals.reported += all;
  if (twice) totals.repeated += all;
}

}  // namespace attest
