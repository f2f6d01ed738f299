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

class TimedUnit final : public Unit {
 public:
  // Appends the time of each step, minus `clock`, to `times`. `unit` and `times` outlive this.
  TimedUnit(Unit& unit, Nanoseconds clock, std::vector<Nanoseconds>& times)
      : unit_(unit), clock_(clock), times_(times) {}

  int set_parameter(const std::string& name, float value) override {
    return unit_.set_parameter(name, value);
  }
  int set_timestamp_sample(std::uint64_t timestamp_sample_us) override {
    return unit_.set_timestamp_sample(timestamp_sample_us);
  }
  int step_structs(const void* in, void* out) override;

 private:
  Unit& unit_;
  Nanoseconds clock_;
  std::vector<Nanoseconds>& times_;
};

// Collects the costs that a program counts. It also makes batches, because no clock is read.
class CountedUnit final : public Unit {
 public:
  // Appends the cost of each step to `costs`. `unit` and `costs` outlive this.
  CountedUnit(Unit& unit, std::vector<StepCost>& costs) : unit_(unit), costs_(costs) {}

  int set_parameter(const std::string& name, float value) override {
    return unit_.set_parameter(name, value);
  }
  int set_timestamp_sample(std::uint64_t timestamp_sample_us) override {
    return unit_.set_timestamp_sample(timestamp_sample_us);
  }
  int step_structs(const void* in, void* out) override;
  std::size_t max_batch() const override { return unit_.max_batch(); }
  Batched batch(std::span<Sample> samples,
                std::span<const std::uint64_t> timestamp_samples_us) override;

 private:
  void collect();

  Unit& unit_;
  std::vector<StepCost>& costs_;
};

// Steps `unit` on `stack`. Both outlive this.
class UnitOnStack final : public Unit {
 public:
  UnitOnStack(Unit& unit, PaintedStack& stack) : unit_(unit), stack_(stack) {}

  int set_parameter(const std::string& name, float value) override {
    return unit_.set_parameter(name, value);
  }
  int set_timestamp_sample(std::uint64_t timestamp_sample_us) override {
    return unit_.set_timestamp_sample(timestamp_sample_us);
  }
  int step_structs(const void* in, void* out) override;

 private:
  Unit& unit_;
  PaintedStack& stack_;
};

}  // namespace attest
