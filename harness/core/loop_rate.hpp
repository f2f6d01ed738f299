// The rates at which the units of a flight controller run.
#pragma once

#include <compare>
#include <optional>
#include <string>
#include <string_view>

#include "harness/core/rate.hpp"
#include "harness/core/result.hpp"

namespace attest {

// As text [Hz]: "1000" for a controller of one unit; "250:1000" for the attitude unit and the rate
// unit of a cascade.
struct LoopRate {
  Rate motor_unit = Rate::hz(1);                     // of the unit that commands the motors
  std::optional<Rate> attitude_unit = std::nullopt;  // empty for a controller of one unit

  LoopRate() = default;
  LoopRate(const Rate& of_unit) : motor_unit(of_unit) {}  // NOLINT(google-explicit-constructor)
  LoopRate(const Rate& of_attitude_unit, const Rate& of_rate_unit)
      : motor_unit(of_rate_unit), attitude_unit(of_attitude_unit) {}

  // Errors: those of Rate::parse(); a rate unit slower than its attitude unit.
  static Result<LoopRate> parse(std::string_view text);

  double hertz() const { return motor_unit.hertz(); }
  double period_s() const { return motor_unit.period_s(); }

  std::string to_string() const;  // "1000" or "250:1000"
  std::string label() const;      // for file names: "1000hz" or "250-1000hz"

  // Ordered by `motor_unit`, then by `attitude_unit`.
  friend auto operator<=>(const LoopRate&, const LoopRate&) = default;
  friend bool operator==(const LoopRate&, const LoopRate&) = default;
};

}  // namespace attest
