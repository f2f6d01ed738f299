#include "harness/host/step_timer.hpp"

#include <algorithm>

#include "harness/realtime/pacer.hpp"

// Must be neither inlined nor renamed: counted_step_symbol is its name.
extern "C" [[gnu::noinline]] int attest_counted_step(attest::Unit& unit, const attest_inputs& in,
                                                     attest_outputs& out) {
  return unit.step(in, out);
}

namespace attest {

Nanoseconds time_of_clock() {
  Nanoseconds least = Nanoseconds::max();
  for (int i = 0; i < 10'000; ++i) {
    const Nanoseconds before = Pacer::now_monotonic();
    least = std::min(least, Pacer::now_monotonic() - before);
  }
  return least;
}

int TimedUnit::step(const attest_inputs& in, attest_outputs& out) {
  const Nanoseconds before = Pacer::now_monotonic();
  const int code = attest_counted_step(unit_, in, out);
  const Nanoseconds after = Pacer::now_monotonic();
  times_.push_back(std::max(after - before - clock_, Nanoseconds(0)));
  return code;
}

int UnitOnStack::step(const attest_inputs& in, attest_outputs& out) {
  int code = ATTEST_FAILED;
  stack_.run([&] { code = unit_.step(in, out); });
  return code;
}

}  // namespace attest
