#include "harness/port/port.hpp"

#include <algorithm>
#include <charconv>
#include <system_error>

#include <fmt/format.h>

namespace attest {

Result<int> parse_fraction_bits(std::string_view arithmetic) {
  constexpr std::string_view prefix = "fixed:";
  // With fewer bits, wrong ports would pass the tolerance. With more, the tolerance is practically
  // that of floats.
  constexpr int fewest = 20, most = 32;
  int bits = 0;
  const char* const end = arithmetic.data() + arithmetic.size();
  const char* const begin = arithmetic.data() + std::min(prefix.size(), arithmetic.size());
  const auto [stop, error] = std::from_chars(begin, end, bits);
  if (!arithmetic.starts_with(prefix) || error != std::errc() || stop != end || bits < fewest ||
      bits > most) {
    return fail(
        fmt::format("its arithmetic is `{}`; it must be `fixed:BITS`, from {} to {} bits "
                    "behind the point",
                    arithmetic, fewest, most));
  }
  return bits;
}

}  // namespace attest
