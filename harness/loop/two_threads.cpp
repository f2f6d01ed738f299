#include "harness/loop/two_threads.hpp"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <ctime>
#include <optional>
#include <system_error>
#include <thread>

#include <unistd.h>

namespace attest {
namespace {

using SteadyClock = std::chrono::steady_clock;

// About every second pause catches `judged` in a step. So 100 pauses miss data that both share
// during a whole step with a probability of 2^-100, and during a tenth of a step of 1%.
constexpr std::size_t pauses = 300;
// On a busy machine `other` waits for a CPU in most pauses, and too few pauses miss what is shared:
// so a pause may be long, and only a port that blocks the other thread in each step uses up the
// whole time.
constexpr SteadyClock::duration longest_pause = std::chrono::milliseconds(100);
constexpr SteadyClock::duration longest_in_all = std::chrono::seconds(5);
// The paused thread sleeps: if it took turns with `other`, both would wait for a CPU.
constexpr timespec nap{0, 20'000};
// Ignored by a process that does not handle it, so a late one does no harm.
constexpr int pausing_signal = SIGWINCH;

// What the handler of the signal uses.
struct Pause {
  std::atomic<std::size_t> others_steps{0};
  std::atomic<std::size_t> lasts_until{0};  // the other has made so many steps
  std::atomic<bool> others_end{false};
  std::atomic<bool> is_due{false};  // the timer runs
  std::atomic<SteadyClock::duration> in_all{};
  std::atomic<bool> is_in_step{false};  // the paused thread
  std::atomic<std::size_t> overlaps{0};
};
Pause the_pause;
static_assert(std::atomic<SteadyClock::duration>::is_always_lock_free);

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
  if (the_pause.is_in_step && the_pause.others_steps >= end) ++the_pause.overlaps;
  the_pause.in_all = the_pause.in_all.load() + (SteadyClock::now() - begin);
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
  void pause_soon() {
    if (!timer_ || the_pause.is_due || the_pause.in_all.load() > longest_in_all) return;
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

bool run_on_two_threads(const std::function<bool()>& judged, const std::function<bool()>& other,
                        std::size_t steps, std::size_t& overlaps) {
  constexpr std::size_t most_ahead = 16;
  const std::size_t between_pauses = std::max<std::size_t>(steps / pauses, 1);
  std::atomic<std::size_t> judged_steps = 0;
  std::atomic<bool> judged_end = false;
  the_pause.others_steps = the_pause.lasts_until = 0;
  the_pause.others_end = the_pause.is_due = false;
  the_pause.in_all = SteadyClock::duration(0);
  the_pause.overlaps = 0;
  std::optional<std::thread> thread;
  try {
    thread.emplace([&] {
      PauseTimer timer;
      const auto step = [&] {
        the_pause.is_in_step = true;
        const bool goes_on = judged();
        the_pause.is_in_step = false;
        return goes_on;
      };
      while (step()) {
        if (++judged_steps % between_pauses == 0) timer.pause_soon();
      }
      judged_end = true;
    });
  } catch (const std::system_error&) {
    return false;
  }
  while (!judged_end) {
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
  overlaps += the_pause.overlaps;
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
    const std::function<std::optional<PortFault>(Trace& trace, std::size_t& overlaps)>& run) {
  constexpr SteadyClock::duration longest = std::chrono::seconds(3);
  const Trace inputs = trace;
  const auto begin = SteadyClock::now();
  std::size_t overlaps = 0;
  if (auto fault = run(trace, overlaps)) return fault;
  while (overlaps < enough_overlaps && SteadyClock::now() < begin + longest) {
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
