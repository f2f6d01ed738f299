#include "harness/sweep/sequential.hpp"

#include <algorithm>
#include <cmath>

namespace attest {
namespace {

// The end of the interval that lies between `inside`, which the interval contains, and `outside`.
double end_between(double inside, double outside, std::uint64_t held, std::uint64_t count,
                   double confidence) {
  constexpr int halvings = 60;  // to the precision of a double
  for (int i = 0; i < halvings; ++i) {
    const double middle = (inside + outside) / 2;
    (excludes(held, count, middle, confidence) ? outside : inside) = middle;
  }
  return inside;
}

}  // namespace

double log_mixture_ratio(std::uint64_t held, std::uint64_t count, double probability) {
  const auto k = static_cast<double>(held), n = static_cast<double>(count);
  return std::lgamma(k + 1) + std::lgamma(n - k + 1) - std::lgamma(n + 2) -
         k * std::log(probability) - (n - k) * std::log1p(-probability);
}

bool excludes(std::uint64_t held, std::uint64_t count, double probability, double confidence) {
  return log_mixture_ratio(held, count, probability) >= -std::log1p(-confidence);
}

Interval sequential_interval(std::uint64_t held, std::uint64_t count, double confidence) {
  if (count == 0) return {};
  // At the share held / count the ratio is below 1 and smallest. It grows to both sides.
  const double share =
      std::clamp(static_cast<double>(held) / static_cast<double>(count), 1e-15, 1 - 1e-15);
  return {held == 0 ? 0 : end_between(share, 0, held, count, confidence),
          held == count ? 1 : end_between(share, 1, held, count, confidence)};
}

double sequential_sign_test(std::uint64_t positive, std::uint64_t negative) {
  return std::min(1.0, std::exp(-log_mixture_ratio(positive, positive + negative, 0.5)));
}

}  // namespace attest
