#include "harness/host/step_timer.hpp"

#include <algorithm>

#include "harness/realtime/pacer.hpp"

// Must be neither inlined nor renamed: counted_step_symbol is its name.
extern "C" [[gnu::noinline]] int attest_counted_step(attest::Unit& unit, const void* in,
                                                     void* out) {
  return unit.step_structs(in, out);
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

int TimedUnit::step_structs(const void* in, void* out) {
  const Nanoseconds before = Pacer::now_monotonic();
  const int code = attest_counted_step(unit_, in, out);
  const Nanoseconds after = Pacer::now_monotonic();
  times_.push_back(std::max(after - before - clock_, Nanoseconds(0)));
  return code;
}

int CountedUnit::step_structs(const void* in, void* out) {
  const int code = unit_.step_structs(in, out);
  collect();
  return code;
}

Batched CountedUnit::batch(std::span<Sample> samples,
                           std::span<const std::uint64_t> timestamp_samples_us) {
  const Batched batched = unit_.batch(samples, timestamp_samples_us);
  collect();
  return batched;
}

void CountedUnit::collect() {
  const std::span<const StepCost> costs = unit_.costs();
  costs_.insert(costs_.end(), costs.begin(), costs.end());
}

int UnitOnStack::step_structs(const void* in, void* out) {
  int code = ATTEST_FAILED;
  stack_.run([&] { code = unit_.step_structs(in, out); });
  return code;
}

}  // namespace attest
