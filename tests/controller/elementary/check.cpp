#include "tests/controller/elementary/check.hpp"

#include <algorithm>
#include <bit>
#include <cfenv>
#include <cmath>
#include <limits>
#include <string_view>
#include <vector>

#ifdef __SSE2__
#include <emmintrin.h>
#endif
#include <fmt/format.h>

#include "tests/controller/elementary/kept.hpp"

namespace attest::elementary {
namespace {

// Counts what was compared under one heading, and prints the first differences.
class Tally {
 public:
  Tally(std::string_view name, std::string_view what) : name_(name), what_(what) {}

  void compare(Arguments at, float got, float want) {
    ++compared_;
    if (agree(got, want) || ++differences_ > 3) return;
    fmt::print("{}({:a}, {:a}): got {:a}, want {:a}\n", name_, at.y, at.x, got, want);
  }

  void fail() { ++differences_; }

  bool done() const {
    fmt::print("{:<6} {:<32} {:>9} compared, {} differences\n", name_, what_, compared_,
               differences_);
    return differences_ == 0;
  }

 private:
  std::string_view name_, what_;
  std::uint64_t compared_ = 0, differences_ = 0;
};

// Another state of the processor.
struct Mode {
  const char* name;
  int rounding;
  bool flushes;  // subnormal numbers to zero
};
constexpr Mode modes[] = {{"rounding up", FE_UPWARD, false},
                          {"rounding down", FE_DOWNWARD, false},
                          {"rounding toward zero", FE_TOWARDZERO, false},
                          {"flushing subnormal numbers", FE_TONEAREST, true}};

void flush_subnormals([[maybe_unused]] bool flushes) {
#ifdef __SSE2__
  constexpr unsigned flush_to_zero_and_zero_for_subnormal = 0x8040;
  const unsigned others = _mm_getcsr() & ~flush_to_zero_and_zero_for_subnormal;
  _mm_setcsr(others | (flushes ? flush_to_zero_and_zero_for_subnormal : 0));
#endif
}

float in_mode(const Mode& mode, const Function& f, Arguments at) {
  std::fesetround(mode.rounding);
  flush_subnormals(mode.flushes);
  const float result = f.fast(at.y, at.x);
  flush_subnormals(false);
  std::fesetround(FE_TONEAREST);
  return result;
}

// Every `every`-th argument, or as many pairs at random.
std::vector<Arguments> sample(const Function& f, std::uint64_t every) {
  std::vector<Arguments> found;
  const std::uint64_t all = std::uint64_t{1} << 32;
  for (std::uint64_t i = 0; i * every < all; ++i) {
    const auto y = std::bit_cast<float>(static_cast<std::uint32_t>(i * every));
    found.push_back(f.two_arguments ? random_pair(i) : Arguments{y, 0});
  }
  return found;
}

// 0, infinity, NaN, and the ends of ranges, with both signs.
std::vector<float> special_values() {
  using Limits = std::numeric_limits<float>;
  std::vector<float> sizes = {0,
                              Limits::denorm_min(),
                              3 * Limits::denorm_min(),
                              Limits::min(),
                              Limits::max(),
                              Limits::infinity(),
                              Limits::quiet_NaN()};
  for (const float x :
       {0x1p-126f,   0x1p-75f,    0x1p-40f,   0x1p-25f,   0x1p-24f, 0x1p-12f, 0.5f,
        0.70710677f, 0.78539819f, 1.0f,       1.5707964f, 2.0f,     3.0f,     3.1415927f,
        88.722839f,  103.27893f,  103.97208f, 0x1p24f,    0x1p75f,  0x1p126f}) {
    for (const float near : {std::nextafter(x, 0.0f), x, std::nextafter(x, Limits::max())}) {
      sizes.push_back(near);
    }
  }
  std::vector<float> values;
  for (const float size : sizes) values.insert(values.end(), {size, -size});
  return values;
}

bool specials_agree(const Function& f) {
  Tally tally(f.name, "special values");
  const std::vector<float> values = special_values();
  const std::vector<float> no_second = {0};
  for (const float y : values) {
    for (const float x : f.two_arguments ? values : no_second) {
      const float want = by_mpfr(f, y, x);
      tally.compare({y, x}, f.fast(y, x), want);
      for (const Mode& mode : modes) tally.compare({y, x}, in_mode(mode, f, {y, x}), want);
    }
  }
  return tally.done();
}

bool share_agrees(const Function& f, std::uint64_t every, unsigned threads) {
  Tally tally(f.name, "a share, and its kept hash");
  const std::uint64_t pairs = (std::uint64_t{1} << 31) / every;
  const Swept swept =
      f.two_arguments ? sweep_pairs(f, pairs, threads) : sweep_arguments(f, every, threads);
  const std::string row = row_of(f, f.two_arguments ? "at random" : share_of(every), swept);
  fmt::print("{}\n", row);
  for (const Arguments& at : swept.wrong) {
    tally.compare(at, f.fast(at.y, at.x), truth(f, at.y, at.x).value);
  }
  if (!is_kept(row)) {
    fmt::print("RESULTS.md does not have this row\n");
    tally.fail();
  }
  return tally.done();
}

bool modes_agree(const Function& f, std::uint64_t every) {
  bool good = true;
  for (const Mode& mode : modes) {
    Tally tally(f.name, mode.name);
    for (const Arguments at : sample(f, every * 100)) {
      tally.compare(at, in_mode(mode, f, at), truth(f, at.y, at.x).value);
    }
    good &= tally.done();
  }
  return good;
}

// Where the fast path decides, the exact path gives the same.
bool exact_path_agrees(const Function& f, std::uint64_t every) {
  Tally tally(f.name, "exact path");
  for (const Arguments at : sample(f, every * 1000)) {
    const float want = truth(f, at.y, at.x).value;
    if (std::isfinite(want) && want != 0) tally.compare(at, f.exact(at.y, at.x), want);
  }
  return tally.done();
}

bool library_is_accurate(const Function& f, std::uint64_t every) {
  Errors largest{0, 0};
  for (const Arguments at : sample(f, every * 1000)) {
    const Errors found = errors(f, at.y, at.x);
    largest.of_double = std::max(largest.of_double, found.of_double);
    largest.of_long_double = std::max(largest.of_long_double, found.of_long_double);
  }
  fmt::print("{:<6} error of the C library: double 2^{:.1f}, long double 2^{:.1f}\n", f.name,
             std::log2(largest.of_double), std::log2(largest.of_long_double));
  return largest.of_double < 0x1p-50 && largest.of_long_double < 0x1p-58;
}

bool hard_cases_agree() {
  Tally fast("all", "hard cases"), exactly("all", "hard cases, exact path");
  for (const HardCase& hard : hard_cases()) {
    const Arguments at = hard.at;
    const float want = by_mpfr(*hard.f, at.y, at.x);
    fast.compare(at, hard.f->fast(at.y, at.x), want);
    for (const Mode& mode : modes) fast.compare(at, in_mode(mode, *hard.f, at), want);
    exactly.compare(at, hard.f->exact(at.y, at.x), want);
  }
  const bool good = fast.done();
  return exactly.done() && good;
}

// The hash with which `attest doctor` compares is that of MPFR's results.
bool fixed_hash_agrees(const FixedFunction& fixed) {
  Tally tally(fixed.name, "fixed arguments, and their hash");
  const Function& f = *function_named(fixed.name);
  const std::uint64_t hash = hash_of(fixed, [&](float y, float x) {
    const float want = by_mpfr(f, y, x);
    tally.compare({y, x}, fixed.result(y, x), want);
    return std::isnan(want) ? std::bit_cast<float>(0x7fc00000) : want;
  });
  if (hash != fixed.hash || !is_correct(fixed)) {
    fmt::print("{}: fixed_arguments.hpp must have the hash {:#x}\n", fixed.name, hash);
    tally.fail();
  }
  return tally.done();
}

}  // namespace

bool check(std::uint64_t every, unsigned threads) {
  bool good = hard_cases_agree();
  for (const FixedFunction& fixed : fixed_functions) good &= fixed_hash_agrees(fixed);
  for (const Function& f : functions()) {
    good &= specials_agree(f);
    good &= share_agrees(f, every, threads);
    good &= modes_agree(f, every);
    good &= exact_path_agrees(f, every);
    good &= library_is_accurate(f, every);
  }
  fmt::print("{}\n", good ? "all agree" : "FAILED");
  return good;
}

}  // namespace attest::elementary
