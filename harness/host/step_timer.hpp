// Units that measure what each step of another unit costs: its time, its stack, or what the port
// counts.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "harness/core/time.hpp"
#include "harness/port/port.hpp"
#include "harness/realtime/painted_stack.hpp"

namespace attest {

// The shortest time between two readings of the clock.
Nanoseconds time_of_clock();

// The symbol of the function that makes each step of a TimedUnit: valgrind counts its instructions.
inline constexpr const char* counted_step_symbol = "attest_counted_step";

class TimedUnit final : public ForwardingUnit {
 public:
  // Appends the time of each step, minus `clock`, to `times`. `times` outlives this.
  TimedUnit(Unit& unit, Nanoseconds clock, std::vector<Nanoseconds>& times)
      : ForwardingUnit(unit), clock_(clock), times_(times) {}

  int step_structs(const void* in, void* out) override;

 private:
  Nanoseconds clock_;
  std::vector<Nanoseconds>& times_;
};

// Collects the costs that a program counts. It also makes batches, because no clock is read.
class CountedUnit final : public ForwardingUnit {
 public:
  // Appends the cost of each step to `costs`. `costs` outlives this.
  CountedUnit(Unit& unit, std::vector<StepCost>& costs) : ForwardingUnit(unit), costs_(costs) {}

  int step_structs(const void* in, void* out) override;
  std::size_t max_batch() const override { return unit_.max_batch(); }
  Batched batch(std::span<Sample> samples,
                std::span<const std::uint64_t> timestamp_samples_us) override;

 private:
  void collect();

  std::vector<StepCost>& costs_;
};

// Steps `unit` on `stack`, which outlives this.
class UnitOnStack final : public ForwardingUnit {
 public:
  UnitOnStack(Unit& unit, PaintedStack& stack) : ForwardingUnit(unit), stack_(stack) {}

  int step_structs(const void* in, void* out) override;

 private:
  PaintedStack& stack_;
};

}  // namespace attest
