#include "harness/host/answer_meter.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "harness/host/port_process.hpp"

namespace attest {

AnswerMeter::AnswerMeter(const PortChild& port, double timeout_s, bool is_program,
                         Nanoseconds flight)
    : port_(port), most_(timeout_s) {
  constexpr auto to_make_units = std::chrono::seconds(10);
  if (flight > Nanoseconds(0)) calls_count_until_ = Clock::now() + to_make_units + flight;
  if (is_program) calls_count_until_ = Clock::time_point::max();
}

AnswerMeter::Limit AnswerMeter::exceeded() {
  const auto now = Clock::now();
  if (now - looked_ < std::chrono::milliseconds(100)) return Limit::none;
  looked_ = now;
  const TreeUsage usage = port_.child.usage();
  if (memory_is_limited() && usage.resident_bytes >> 30 >= max_memory_gib) return Limit::memory;
  const std::uint64_t calls = port_.calls->count();
  const bool is_new_call = std::exchange(calls_, calls) != calls && now < calls_count_until_;
  if (!at_begin_ || is_new_call) {
    at_begin_ = usage;
    began_ = now;
  }
  using Duration = std::chrono::nanoseconds;
  const auto running = std::max(usage.running - at_begin_->running, Duration{0});
  const auto waiting = std::max(usage.waiting - at_begin_->waiting, Duration{0});
  if (running > most_) return Limit::running;
  return now - began_ - running - waiting > most_ * longer_asleep ? Limit::asleep : Limit::none;
}

std::string text_of(AnswerMeter::Limit exceeded, double timeout_s) {
  return exceeded == AnswerMeter::Limit::asleep
             ? fmt::format("{:g} s of sleep", timeout_s * longer_asleep)
             : fmt::format("{:g} s of CPU time", timeout_s);
}

}  // namespace attest
