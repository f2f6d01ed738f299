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
  std::atomic<bool> is_due{false};   // the timer runs
  std::atomic<bool> is_sent{false};  // the other has sent the signal
  std::atomic<SteadyClock::duration> in_all{};
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
  the_pause.in_all = the_pause.in_all.load() + (SteadyClock::now() - begin);
  the_pause.is_due = the_pause.is_sent = false;
  errno = saved;
}

// Pauses the thread that makes this object, after a time on its own CPU. The other thread also
// sends the signal: timers of a virtual machine can be milliseconds late, and then there are too
// few pauses. The other thread may rarely have a CPU, and then there are only those of the timer.
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
                        std::size_t steps) {
  constexpr std::size_t most_ahead = 16;
  const std::size_t between_pauses = std::max<std::size_t>(steps / pauses, 1);
  std::atomic<std::size_t> judged_steps = 0;
  std::atomic<bool> judged_end = false;
  std::atomic<pid_t> judged_thread = 0;
  the_pause.others_steps = the_pause.lasts_until = 0;
  the_pause.others_end = the_pause.is_due = the_pause.is_sent = false;
  the_pause.in_all = SteadyClock::duration(0);
  std::optional<std::thread> thread;
  try {
    thread.emplace([&] {
      PauseTimer timer;
      judged_thread = ::gettid();
      while (judged()) {
        if (++judged_steps % between_pauses == 0) timer.pause_soon();
      }
      judged_end = true;
    });
  } catch (const std::system_error&) {
    return false;
  }
  std::size_t next_pause = between_pauses;
  while (!judged_end) {
    const bool may_pause = judged_thread != 0 && the_pause.in_all.load() <= longest_in_all;
    if (may_pause && judged_steps >= next_pause && !the_pause.is_sent.exchange(true)) {
      next_pause = judged_steps + between_pauses;
      ::tgkill(::getpid(), judged_thread, pausing_signal);
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
  return true;
}

}  // namespace attest
