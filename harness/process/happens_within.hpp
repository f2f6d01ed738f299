// Waiting for what no file descriptor shows, such as the end of a process.
#pragma once

#include <algorithm>
#include <chrono>
#include <thread>

namespace attest {

// Polls `happened`, at first with short pauses, because most processes end within a millisecond.
template <typename Happened>
bool happens_within(double seconds, Happened&& happened) {
  using std::chrono::steady_clock;
  const auto deadline = steady_clock::now() + std::chrono::duration<double>(seconds);
  for (steady_clock::duration pause = std::chrono::microseconds(50); !happened();
       pause = std::min<steady_clock::duration>(2 * pause, std::chrono::milliseconds(5))) {
    if (steady_clock::now() >= deadline) return false;
    std::this_thread::sleep_for(pause);
  }
  return true;
}

}  // namespace attest
