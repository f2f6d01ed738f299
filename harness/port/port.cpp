#include "harness/port/port.hpp"

#include <algorithm>
#include <charconv>

#include <fmt/format.h>

#include "harness/port/builtin.hpp"
#include "harness/port/fault_port.hpp"
#include "harness/port/shared_library.hpp"

namespace attest {

Result<int> parse_fraction_bits(std::string_view arithmetic) {
  constexpr std::string_view prefix = "fixed:";
  // With fewer bits, wrong ports would pass the tolerance. With more, it is the tolerance of
  // floats.
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

std::optional<std::string> library_of(const std::string& specification) {
  constexpr std::string_view prefix = "lib:";
  if (!specification.starts_with(prefix)) return std::nullopt;
  return specification.substr(prefix.size());
}

Result<std::unique_ptr<Port>> open_port(const std::string& specification) {
  constexpr std::string_view fault_prefix = "fault:";
  if (specification == "builtin") return open_builtin();
  if (specification.starts_with(fault_prefix)) {
    return open_fault(std::string_view(specification).substr(fault_prefix.size()));
  }
  if (const auto library = library_of(specification)) return open_shared_library(*library);
  return fail(fmt::format("unknown port `{}`; use {}", specification, port_kinds));
}

}  // namespace attest
