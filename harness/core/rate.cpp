#include "harness/core/rate.hpp"

#include <charconv>
#include <cmath>
#include <numeric>
#include <optional>

#include <fmt/format.h>

namespace attest {
namespace {

__extension__ using Int128 = __int128;

constexpr std::int64_t ns_per_s = 1'000'000'000;
// Timestamps are in microseconds: two ticks of a faster loop could have the same timestamp.
constexpr std::int64_t max_hz = 1'000'000;
constexpr std::int64_t min_millihertz = 1;
// Of numerator and denominator, so that the product of two such numbers fits into 64 bits.
constexpr std::size_t max_digits = 9;

std::optional<std::int64_t> parse_digits(std::string_view digits) {
  if (digits.empty() || digits.size() > max_digits) return std::nullopt;
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc{} || end != digits.data() + digits.size() || value < 0)
    return std::nullopt;
  return value;
}

struct Fraction {
  std::int64_t numerator;
  std::int64_t denominator;
};

std::optional<Fraction> parse_fraction(std::string_view text) {
  if (const auto slash = text.find('/'); slash != text.npos) {
    const auto numerator = parse_digits(text.substr(0, slash));
    const auto denominator = parse_digits(text.substr(slash + 1));
    if (!numerator || !denominator) return std::nullopt;
    return Fraction{*numerator, *denominator};
  }
  const auto point = text.find('.');
  if (point == text.npos) {
    const auto whole = parse_digits(text);
    return whole ? std::optional(Fraction{*whole, 1}) : std::nullopt;
  }
  const std::string_view decimals = text.substr(point + 1);
  const auto digits = parse_digits(std::string(text.substr(0, point)).append(decimals));
  if (!digits || decimals.empty()) return std::nullopt;
  std::int64_t denominator = 1;
  for (std::size_t i = 0; i < decimals.size(); ++i) denominator *= 10;
  return Fraction{*digits, denominator};
}

}  // namespace

Result<Rate> Rate::parse(std::string_view text) {
  std::string_view number = text;
  for (const std::string_view unit : {"hz", "Hz", "HZ"}) {
    if (number.size() > unit.size() && number.ends_with(unit)) number.remove_suffix(unit.size());
  }
  const auto fraction = parse_fraction(number);
  if (!fraction || fraction->numerator == 0 || fraction->denominator == 0) {
    return fail(
        fmt::format("`{}` is not a rate; write a positive number of hertz such as 250, "
                    "62.5 or 1000/3, with at most 9 digits",
                    text));
  }
  const Rate rate = hz(fraction->numerator, fraction->denominator);
  if (rate.numerator_ > max_hz * rate.denominator_) {
    return fail(fmt::format("{} Hz is too fast; timestamps are microseconds, so at most {} Hz",
                            text, max_hz));
  }
  if (rate.numerator_ * 1000 < min_millihertz * rate.denominator_) {
    return fail(fmt::format("{} Hz is too slow; at least 0.001 Hz", text));
  }
  return rate;
}

Rate Rate::hz(std::int64_t numerator, std::int64_t denominator) {
  const std::int64_t divisor = std::gcd(numerator, denominator);
  return {numerator / divisor, denominator / divisor};
}

Nanoseconds Rate::tick(std::int64_t k) const {
  const Int128 scaled = Int128{k} * ns_per_s * denominator_;
  Int128 quotient = scaled / numerator_;
  if (quotient * numerator_ > scaled) --quotient;  // floor, also for negative k
  return Nanoseconds(static_cast<std::int64_t>(quotient));
}

std::int64_t Rate::ticks_in(Nanoseconds duration) const {
  if (duration <= Nanoseconds(0)) return 0;
  const Int128 product = Int128{duration.count()} * numerator_;
  const Int128 divisor = Int128{ns_per_s} * denominator_;
  // Tick k is at floor(x), x = k / rate in ns. `duration` is an integer, so floor(x) >= duration if
  // and only if x >= duration.
  return static_cast<std::int64_t>((product + divisor - 1) / divisor);
}

std::string Rate::to_string() const {
  return denominator_ == 1 ? fmt::format("{}", numerator_)
                           : fmt::format("{}/{}", numerator_, denominator_);
}

std::string Rate::label() const {
  return denominator_ == 1 ? fmt::format("{}hz", numerator_)
                           : fmt::format("{}_{}hz", numerator_, denominator_);
}

double distance_of(const Rate& rate, double hz) { return std::abs(std::log(rate.hertz() / hz)); }

const std::vector<Rate>& standard_rates() {
  static const std::vector<Rate> rates = [] {
    std::vector<Rate> list;
    for (const int hertz : {50, 100, 250, 333, 400, 500, 800, 1000, 2000, 4000, 8000}) {
      list.push_back(Rate::hz(hertz));
    }
    return list;
  }();
  return rates;
}

}  // namespace attest
