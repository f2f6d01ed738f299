// A rate as an exact rational number of hertz, so that 333 Hz and 3 kHz have no rounding drift.
#pragma once

#include <compare>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "harness/core/result.hpp"
#include "harness/core/time.hpp"

namespace attest {

class Rate {
 public:
  // "250", "250hz", "1000/3", "62.5" [Hz]. Errors: not a positive number; more than 9 digits; above
  // 1 MHz (the timestamps are microseconds); below 1 mHz.
  static Result<Rate> parse(std::string_view text);

  // REQUIRES: numerator and denominator positive.
  static Rate hz(std::int64_t numerator, std::int64_t denominator = 1);

  // Begin of period k: floor(k * 1e9 / rate) ns. Computed from k, never accumulated.
  Nanoseconds tick(std::int64_t k) const;

  // The number of ticks in [0, duration): the smallest k >= 0 with tick(k) >= duration.
  std::int64_t ticks_in(Nanoseconds duration) const;

  double hertz() const {
    return static_cast<double>(numerator_) / static_cast<double>(denominator_);
  }
  double period_s() const {
    return static_cast<double>(denominator_) / static_cast<double>(numerator_);
  }

  // "250" or "1000/3".
  std::string to_string() const;
  // For file names: "250hz" or "1000_3hz".
  std::string label() const;

  friend bool operator==(const Rate&, const Rate&) = default;
  friend std::strong_ordering operator<=>(const Rate& a, const Rate& b) {
    return a.numerator_ * b.denominator_ <=> b.numerator_ * a.denominator_;
  }

 private:
  Rate(std::int64_t numerator, std::int64_t denominator)
      : numerator_(numerator), denominator_(denominator) {}

  std::int64_t numerator_;  // in lowest terms
  std::int64_t denominator_;
};

// How far a rate is from this one [Hz]: |ln(rate / hz)|, so half the rate is as far as twice the
// rate.
double distance_of(const Rate& rate, double hz);

// The default rates of a case, 50 Hz to 8 kHz; a case with other rates gives the reason. The
// controller of v1.5.5 limits dt to 2..20 ms (500 Hz and 50 Hz), and several rates have a smaller
// period. The period of 333 Hz is not a whole number of nanoseconds.
const std::vector<Rate>& standard_rates();

}  // namespace attest
