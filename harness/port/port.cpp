#include "harness/port/port.hpp"

#include <algorithm>
#include <charconv>
#include <system_error>

#include <fmt/format.h>

#include "harness/core/printable.hpp"

namespace attest {

const Lacks& Port::lacks() const {
  static const Lacks nothing;
  return nothing;
}

std::string wrong_in_name(std::string_view name) {
  constexpr std::size_t longest = 200;
  if (name.size() > longest) return fmt::format("is longer than {} bytes", longest);
  if (printable_part(name) != name) return "has a character that cannot be printed";
  return "";
}

std::string wrong_in_declared(std::string_view name, std::string_view version_text,
                              std::span<const std::string> unsupported_groups) {
  constexpr std::size_t most_groups = 1000;
  if (auto wrong = wrong_in_name(name); !wrong.empty()) return "`name` " + wrong;
  if (auto wrong = wrong_in_name(version_text); !wrong.empty()) return "`version` " + wrong;
  if (unsupported_groups.size() > most_groups) {
    return fmt::format("`unsupported_groups` has more than {} groups", most_groups);
  }
  for (const std::string& group : unsupported_groups) {
    const std::string wrong = wrong_in_name(group);
    if (!wrong.empty()) return "`unsupported_groups` has a group that " + wrong;
  }
  return "";
}

Result<int> parse_fraction_bits(std::string_view arithmetic) {
  constexpr std::string_view prefix = "fixed:";
  constexpr int fewest = fewest_fraction_bits, most = most_fraction_bits;
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
