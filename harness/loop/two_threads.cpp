#include "harness/loop/two_threads.hpp"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <ctime>
#include <limits>
#include <optional>
#include <system_error>
#include <thread>

#include <unistd.h>

namespace attest {
namespace {

using SteadyClock = std::chrono::steady_clock;

constexpr std::size_t pauses = 300;
// On a busy machine `other` waits for a CPU in most pauses, and too few pauses miss what is shared:
// so a pause may be long, and only a port that blocks the other thread in each step uses up the
// whole time.
constexpr SteadyClock::duration longest_pause = std::chrono::milliseconds(100);
// A wrong port whose steps read the only copy of their inputs gave a wrong output in 7% of its
// overlaps, because the copy matters in part of a step only. So 300 overlaps miss it with a
// probability of 1e-9.
constexpr std::size_t enough_overlaps = 300;
// A port that holds a lock during its whole step has no other overlaps.
constexpr std::size_t most_blocked = 30;
// A run has 20 to 130 overlaps and takes 30 ms. Where timers are late it has few. Both threads then
// use less than the port's limit of CPU time.
constexpr SteadyClock::duration longest_in_all = std::chrono::seconds(4);
// The paused thread sleeps: if it took turns with `other`, both would wait for a CPU.
constexpr timespec nap{0, 20'000};
// Ignored by a process that does not handle it, so a late one does no harm.
constexpr int pausing_signal = SIGWINCH;
// Longer than the timer takes. If it is later, as on a busy virtual machine, the other thread sends
// the signal.
constexpr std::size_t most_steps_to_pause = 64;

// What the handler of the signal uses.
struct Pause {
  std::atomic<std::size_t> others_steps{0};
  std::atomic<std::size_t> lasts_until{0};  // the other has made so many steps
  std::atomic<bool> others_end{false};
  std::atomic<bool> is_due{false};        // the timer runs
  std::atomic<std::size_t> late_from{0};  // then the step of `judged` from which on it is late
  std::atomic<bool> is_in_step{false};    // the paused thread
  std::atomic<std::size_t> whole{0}, blocked{0};
};
Pause the_pause;

extern "C" void pause_until_the_other_has_stepped(int) {
  const int saved = errno;
  constexpr std::size_t whole_step = 2;  // the first may have begun before the pause
  const std::size_t end = the_pause.others_steps + whole_step;
  const auto begin = SteadyClock::now();
  the_pause.lasts_until = end;
  while (the_pause.others_steps < end && !the_pause.others_end &&
         SteadyClock::now() < begin + longest_pause) {
    ::nanosleep(&nap, nullptr);
  }
  const bool is_whole = the_pause.others_steps >= end;
  if (the_pause.is_in_step && (is_whole || !the_pause.others_end)) {
    ++(is_whole ? the_pause.whole : the_pause.blocked);
  }
  the_pause.is_due = false;
  errno = saved;
}

// Pauses the thread that makes this object.
class PauseTimer {
 public:
  PauseTimer() {
    struct sigaction action {};
    action.sa_handler = pause_until_the_other_has_stepped;
    action.sa_flags = SA_RESTART | SA_ONSTACK;  // ONSTACK: the threads of some languages need it
    ::sigaction(pausing_signal, &action, &before_);
    sigevent event{};
    event.sigev_notify = SIGEV_THREAD_ID;
    event.sigev_signo = pausing_signal;
    event._sigev_un._tid = ::gettid();
    if (timer_t timer{}; ::timer_create(CLOCK_MONOTONIC, &event, &timer) == 0) timer_ = timer;
  }
  ~PauseTimer() {
    if (timer_) ::timer_delete(*timer_);
    ::sigaction(pausing_signal, &before_, nullptr);
  }
  PauseTimer(const PauseTimer&) = delete;
  PauseTimer& operator=(const PauseTimer&) = delete;

  // Pauses the thread in 20 to 40 us, which differ so that all parts of a step are hit. A shorter
  // time may be over before this function returns, and the pause would never be in a step.
  void pause_soon(std::size_t step) {
    if (!timer_ || the_pause.is_due || the_pause.blocked >= most_blocked) return;
    the_pause.late_from = step + most_steps_to_pause;
    the_pause.is_due = true;
    delay_ns_ = 20'000 + (delay_ns_ + 7919) % 20'000;
    const itimerspec once{{0, 0}, {0, delay_ns_}};
    ::timer_settime(*timer_, 0, &once, nullptr);
  }

 private:
  struct sigaction before_ {};
  std::optional<timer_t> timer_;
  std::int64_t delay_ns_ = 0;
};

}  // namespace

bool Overlaps::are_enough() const { return whole >= enough_overlaps || blocked >= most_blocked; }

int OverlappedUnit::step_structs(const void* in, void* out) {
  the_pause.is_in_step = true;
  const int code = unit_.step_structs(in, out);
  the_pause.is_in_step = false;
  return code;
}

bool run_on_two_threads(const std::function<bool()>& judged, const std::function<bool()>& other,
                        std::size_t steps, Overlaps& overlaps) {
  constexpr std::size_t most_ahead = 16;
  const std::size_t between_pauses = std::max<std::size_t>(steps / pauses, 1);
  std::atomic<std::size_t> judged_steps = 0;
  std::atomic<bool> judged_end = false;
  the_pause.others_steps = the_pause.lasts_until = 0;
  the_pause.others_end = the_pause.is_due = false;
  the_pause.whole = overlaps.whole;
  the_pause.blocked = overlaps.blocked;
  std::optional<std::thread> thread;
  try {
    thread.emplace([&] {
      PauseTimer timer;
      while (judged()) {
        if (++judged_steps % between_pauses == 0) timer.pause_soon(judged_steps);
      }
      judged_end = true;
    });
  } catch (const std::system_error&) {
    return false;
  }
  while (!judged_end) {
    if (the_pause.is_due && judged_steps >= the_pause.late_from) {
      the_pause.late_from = std::numeric_limits<std::size_t>::max();
      ::pthread_kill(thread->native_handle(), pausing_signal);
    }
    if (the_pause.others_steps >= judged_steps + most_ahead &&
        the_pause.others_steps >= the_pause.lasts_until) {
      std::this_thread::yield();
      continue;
    }
    if (!other()) break;
    ++the_pause.others_steps;
  }
  the_pause.others_end = true;
  thread->join();
  overlaps = {the_pause.whole, the_pause.blocked};
  return true;
}

namespace {

std::optional<std::size_t> first_other_output(const Trace& a, const Trace& b) {
  for (std::size_t tick = 0; tick < a.samples.size(); ++tick) {
    if (!std::ranges::equal(a.samples[tick].outputs(), b.samples[tick].outputs())) return tick;
  }
  return std::nullopt;
}

}  // namespace

std::optional<PortFault> run_until_overlapped(
    Trace& trace,
    const std::function<std::optional<PortFault>(Trace& trace, Overlaps& overlaps)>& run) {
  const Trace inputs = trace;
  const auto end = SteadyClock::now() + longest_in_all;
  Overlaps overlaps;
  if (auto fault = run(trace, overlaps)) return fault;
  while (!overlaps.are_enough() && SteadyClock::now() < end) {
    Trace again = inputs;
    if (auto fault = run(again, overlaps)) return fault;
    const auto tick = first_other_output(trace, again);
    if (!tick) continue;
    return PortFault{
        PortFault::Kind::failed, *tick,
        "its outputs for the same inputs depend on the steps of an instance on another "
        "thread: the two share data"};
  }
  return std::nullopt;
}

}  // namespace attest
