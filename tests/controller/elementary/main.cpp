// Proves that the functions of attest_math.h are correctly rounded.
//
// "Correctly rounded" is decided by MPFR, and by wider functions of the C library where their error
// cannot matter (functions.hpp). RESULTS.md and hard_cases.txt keep what long runs gave.
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <span>
#include <string>
#include <string_view>

#include <fmt/chrono.h>
#include <fmt/format.h>

#include "tests/controller/elementary/check.hpp"
#include "tests/controller/elementary/kept.hpp"
#include "tests/controller/elementary/search.hpp"

namespace attest::elementary {
namespace {

constexpr std::string_view usage = R"(usage: attest_elementary_tests [COMMAND]
With no command: check
  check [EVERY]            a share of all arguments (default: every 1009th), the hard cases, the
                           special values, and other rounding modes. Exits 1 if one differs
  exhaustive FUNCTION [EVERY]    all 2^32 arguments of sin, cos, tan, asin, acos or exp
  pairs COUNT              pairs of atan2 at random, each with both signs of x
  search COUNT             pairs of atan2 near a midpoint of two floats, from COUNT midpoints
exhaustive and pairs print a row of RESULTS.md. They and search print lines of hard_cases.txt.
THREADS in the environment is the number of threads (default 1).
)";

unsigned threads() {
  const char* const text = std::getenv("THREADS");
  const unsigned long count = text == nullptr ? 1 : std::strtoul(text, nullptr, 10);
  return count == 0 ? 1 : static_cast<unsigned>(count);
}

// 0 if the text is not a positive number.
std::uint64_t number(const char* text) {
  char* end = nullptr;
  const unsigned long long value = std::strtoull(text, &end, 10);
  return *end == '\0' ? value : 0;
}

int report(const Function& f, const std::string& share, const Swept& swept) {
  fmt::print("{} {:.0f} s | {:%Y-%m-%d} |\n", row_of(f, share, swept), swept.seconds,
             fmt::gmtime(std::time(nullptr)));
  for (const Arguments& at : swept.hard) fmt::print("{}\n", line_of({&f, at}));
  for (const Arguments& at : swept.wrong) fmt::print("WRONG {}\n", line_of({&f, at}));
  std::fflush(stdout);
  return swept.differences == 0 ? 0 : 1;
}

int run(std::span<char* const> words) {
  const std::string_view command = words.empty() ? "check" : words[0];
  const Function& atan2 = *function_named("atan2");
  if (command == "check" && words.size() <= 2) {
    const std::uint64_t every = words.size() == 2 ? number(words[1]) : 1009;
    if (every != 0) return check(every, threads()) ? 0 : 1;
  } else if (command == "exhaustive" && (words.size() == 2 || words.size() == 3)) {
    const Function* const f = function_named(words[1]);
    const std::uint64_t every = words.size() == 3 ? number(words[2]) : 1;
    if (f != nullptr && !f->two_arguments && every != 0) {
      return report(*f, share_of(every), sweep_arguments(*f, every, threads()));
    }
  } else if (command == "pairs" && words.size() == 2 && number(words[1]) != 0) {
    return report(atan2, "at random", sweep_pairs(atan2, number(words[1]), threads()));
  } else if (command == "search" && words.size() == 2 && number(words[1]) != 0) {
    for (const Arguments& at : hard_pairs(number(words[1]))) {
      fmt::print("{}\n", line_of({&atan2, at}));
    }
    return 0;
  }
  fmt::print(stderr, "{}", usage);
  return 2;
}

}  // namespace
}  // namespace attest::elementary

int main(int argc, char** argv) {
  return attest::elementary::run(
      std::span<char* const>(argv, static_cast<std::size_t>(argc)).subspan(1));
}
