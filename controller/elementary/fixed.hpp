// Fixed: a number in steps of 2^-192, in seven limbs of 32 bits.
//
// Addition and subtraction wrap at 2^32, so a negative number may occur in between. A product or a
// quotient is cut off, so it is less than 2^-192 too small. A product beyond 2^32 is the largest
// Fixed, so that a product rises with its factors. The limbs have 32 bits, because products of 64
// bits exist on 32-bit processors, too.
//
// Plain values; any thread.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace attest::elementary {

inline constexpr int fraction_limbs = 6;
inline constexpr int fixed_limbs = fraction_limbs + 1;

struct Fixed {
  std::array<std::uint32_t, fixed_limbs> limbs{};  // the least significant first

  constexpr Fixed() = default;
  explicit constexpr Fixed(std::uint32_t integer) { limbs[fraction_limbs] = integer; }
  explicit constexpr Fixed(const std::uint32_t (&constant)[fixed_limbs]) {
    for (std::size_t i = 0; i < fixed_limbs; ++i) limbs[i] = constant[i];
  }

  constexpr bool operator==(const Fixed&) const = default;
  constexpr bool is_zero() const { return *this == Fixed(); }
};

constexpr bool operator<(const Fixed& a, const Fixed& b) {
  for (std::size_t i = fixed_limbs; i-- > 0;) {
    if (a.limbs[i] != b.limbs[i]) return a.limbs[i] < b.limbs[i];
  }
  return false;
}

constexpr Fixed operator+(const Fixed& a, const Fixed& b) {
  Fixed sum;
  std::uint64_t carry = 0;
  for (std::size_t i = 0; i < fixed_limbs; ++i) {
    carry += std::uint64_t{a.limbs[i]} + b.limbs[i];
    sum.limbs[i] = static_cast<std::uint32_t>(carry);
    carry >>= 32;
  }
  return sum;
}

constexpr Fixed operator-(const Fixed& a) {
  Fixed inverse;
  for (std::size_t i = 0; i < fixed_limbs; ++i) inverse.limbs[i] = ~a.limbs[i];
  Fixed step;
  step.limbs[0] = 1;
  return inverse + step;
}

constexpr Fixed operator-(const Fixed& a, const Fixed& b) { return a + -b; }

constexpr Fixed operator*(const Fixed& a, const Fixed& b) {
  std::array<std::uint32_t, std::size_t{2} * fixed_limbs> product{};
  for (std::size_t i = 0; i < fixed_limbs; ++i) {
    std::uint64_t carry = 0;
    for (std::size_t j = 0; j < fixed_limbs; ++j) {
      carry += std::uint64_t{a.limbs[i]} * b.limbs[j] + product[i + j];
      product[i + j] = static_cast<std::uint32_t>(carry);
      carry >>= 32;
    }
    product[i + fixed_limbs] = static_cast<std::uint32_t>(carry);
  }
  Fixed cut;
  const bool too_large = product.back() != 0;
  for (std::size_t i = 0; i < fixed_limbs; ++i) {
    cut.limbs[i] = too_large ? ~std::uint32_t{0} : product[i + fraction_limbs];
  }
  return cut;
}

constexpr Fixed operator*(const Fixed& a, std::uint32_t factor) { return a * Fixed(factor); }

constexpr Fixed operator/(const Fixed& a, std::uint32_t divisor) {
  Fixed quotient;
  std::uint64_t rest = 0;
  for (std::size_t i = fixed_limbs; i-- > 0;) {
    rest = rest << 32 | a.limbs[i];
    quotient.limbs[i] = static_cast<std::uint32_t>(rest / divisor);
    rest %= divisor;
  }
  return quotient;
}

// The largest number whose value of the rising function `f` is at most `bound`, found bit by bit.
template <typename Function>
constexpr Fixed largest(const Function& f, const Fixed& bound) {
  Fixed found;
  for (std::size_t bit = std::size_t{32} * fixed_limbs; bit-- > 0;) {
    Fixed candidate = found;
    candidate.limbs[bit / 32] |= std::uint32_t{1} << bit % 32;
    if (!(bound < f(candidate))) found = candidate;
  }
  return found;
}

}  // namespace attest::elementary
