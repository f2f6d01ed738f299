// The cost of a step as a program counts it, for example in cycles of the microcontroller on which
// the step ran (PROTOCOL.md).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "harness/core/result.hpp"

namespace attest {

enum class CostUnit { cycles, instructions, nanoseconds };
std::string_view name_of(CostUnit unit);  // "cycles"

// How a program counts.
struct CostCounter {
  CostUnit unit = CostUnit::nanoseconds;
  double clock_hz = 0;  // of cycles; 0 for the other units

  // Errors: no such unit; cycles without a clock, or with one that is not in (0, 1e12]; a clock for
  // another unit.
  static Result<CostCounter> make(std::string_view unit, std::optional<double> clock_hz);

  // The duration of one unit. Empty for instructions, which have no duration.
  std::optional<double> unit_ns() const;
  std::string clock_text() const;  // "25 MHz"; empty without a clock
  std::string to_string() const;   // "cycles at 25 MHz"

  friend bool operator==(const CostCounter&, const CostCounter&) = default;
};

std::string count_text(std::int64_t count);  // for people: "2,190"

// Of one step. In binary frames as in memory.
struct StepCost {
  std::uint32_t cost = 0;         // in CostCounter::unit
  std::uint32_t stack_bytes = 0;  // high-water mark of the stack up to now; 0: not measured

  friend bool operator==(const StepCost&, const StepCost&) = default;
};
static_assert(sizeof(StepCost) == 8);

}  // namespace attest
