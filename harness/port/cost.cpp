#include "harness/port/cost.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "harness/trace/csv_cells.hpp"

namespace attest {
namespace {

// The index of a name is the value of its unit.
constexpr std::array<std::string_view, 3> unit_names{"cycles", "instructions", "nanoseconds"};

constexpr double fastest_clock_hz = 1e12;

}  // namespace

std::string_view name_of(CostUnit unit) { return unit_names[static_cast<std::size_t>(unit)]; }

Result<CostCounter> CostCounter::make(std::string_view unit, std::optional<double> clock_hz) {
  const auto found = std::find(unit_names.begin(), unit_names.end(), unit);
  if (found == unit_names.end()) {
    return fail(
        fmt::format("`cost` has the unit {}; it is `cycles`, `instructions` or "
                    "`nanoseconds`",
                    in_backquotes(unit)));
  }
  CostCounter counter{static_cast<CostUnit>(found - unit_names.begin())};
  const bool has_clock = counter.unit == CostUnit::cycles;
  if (!has_clock && clock_hz) {
    return fail(fmt::format("`cost` has `clock_hz`, which {} do not have", unit));
  }
  if (!has_clock) return counter;
  if (!clock_hz) return fail("`cost` lacks `clock_hz`, which cycles need");
  if (!(*clock_hz > 0 && *clock_hz <= fastest_clock_hz)) {
    return fail(fmt::format("`cost` has `clock_hz` = {:g}; it is above 0 and at most {:g}",
                            *clock_hz, fastest_clock_hz));
  }
  counter.clock_hz = *clock_hz;
  return counter;
}

std::optional<double> CostCounter::unit_ns() const {
  switch (unit) {
    case CostUnit::cycles:
      return 1e9 / clock_hz;
    case CostUnit::nanoseconds:
      return 1;
    case CostUnit::instructions:
      break;
  }
  return std::nullopt;
}

std::string CostCounter::clock_text() const {
  return unit == CostUnit::cycles ? fmt::format("{} MHz", clock_hz / 1e6) : "";
}

std::string CostCounter::to_string() const {
  const std::string clock = clock_text();
  return fmt::format("{}{}{}", name_of(unit), clock.empty() ? "" : " at ", clock);
}

std::string count_text(std::int64_t count) {
  std::string digits = fmt::to_string(count);
  for (std::size_t left = digits.size(); left > 3;) digits.insert(left -= 3, 1, ',');
  return digits;
}

}  // namespace attest
