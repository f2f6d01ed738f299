#include "harness/port/port.hpp"

#include <fmt/format.h>

#include "harness/port/builtin.hpp"
#include "harness/port/fault_port.hpp"
#include "harness/port/shared_library.hpp"

namespace attest {

Result<std::unique_ptr<Port>> open_port(const std::string& specification) {
  constexpr std::string_view library_prefix = "lib:";
  constexpr std::string_view fault_prefix = "fault:";
  if (specification == "builtin") return open_builtin();
  if (specification.starts_with(fault_prefix)) {
    return open_fault(std::string_view(specification).substr(fault_prefix.size()));
  }
  if (specification.starts_with(library_prefix)) {
    return open_shared_library(specification.substr(library_prefix.size()));
  }
  return fail(
      fmt::format("unknown port `{}`; use `builtin`, `lib:PATH` or `fault:ID`", specification));
}

}  // namespace attest
