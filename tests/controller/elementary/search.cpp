#include "tests/controller/elementary/search.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace attest::elementary {
namespace {

// The last convergent p/q of x with p and q below 2^24. REQUIRES: 1/2 <= x <= 2.
struct Ratio {
  std::int64_t p, q;
};

Ratio convergent(long double x) {
  constexpr std::int64_t bound = 1 << 24;
  Ratio previous{0, 1}, last{1, 0};
  for (;;) {
    const long double whole = std::floor(x);
    if (whole >= bound) return last;
    const auto a = static_cast<std::int64_t>(whole);
    const Ratio next{a * last.p + previous.p, a * last.q + previous.q};
    if (next.p >= bound || next.q >= bound) return last;
    previous = last;
    last = next;
    if (x == whole) return last;
    x = 1 / (x - whole);
  }
}

// A pair for the i-th midpoint. Its tangent in long double is right to about 2^-63.
std::optional<Arguments> pair_near_midpoint(std::uint64_t i) {
  const std::uint64_t bits = random_bits(i);
  const auto significand = static_cast<long double>(bits % (1 << 23) * 2 + 1 + (1 << 24));
  const int exponent = -static_cast<int>(bits >> 40 & 31);
  const long double midpoint = std::ldexp(significand, exponent - 24);
  if (midpoint > 1.57L) return std::nullopt;
  const long double tangent = std::tan(midpoint);
  const int scale = std::ilogb(tangent);
  const Ratio ratio = convergent(std::ldexp(tangent, -scale));
  const Arguments at{std::ldexp(static_cast<float>(ratio.p), scale), static_cast<float>(ratio.q)};
  const long double angle = std::atan2(static_cast<long double>(at.y), at.x);
  if (std::abs(angle - midpoint) > midpoint * 0x1p-61L) return std::nullopt;
  return at;
}

}  // namespace

std::vector<Arguments> hard_pairs(std::uint64_t count) {
  const Function& atan2 = *function_named("atan2");
  std::vector<std::pair<double, Arguments>> found;
  for (std::uint64_t i = 0; i < count; ++i) {
    if (const auto at = pair_near_midpoint(i)) {
      found.emplace_back(distance_from_midpoint(atan2, at->y, at->x), *at);
    }
  }
  std::sort(found.begin(), found.end(),
            [](const auto& a, const auto& b) { return a.first < b.first; });
  found.resize(std::min<std::size_t>(found.size(), 64));
  std::vector<Arguments> hardest;
  for (const auto& [distance, at] : found) hardest.push_back(at);
  return hardest;
}

}  // namespace attest::elementary
