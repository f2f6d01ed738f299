#include "harness/core/result.hpp"

#include <utility>

#include <fmt/format.h>

#include "harness/core/printable.hpp"

namespace attest {

std::string Error::to_string() const {
  std::string place = file;
  if (line > 0) place += fmt::format(":{}", line);
  if (line > 0 && column > 0) place += fmt::format(":{}", column);
  return place.empty() ? message : fmt::format("{}: {}", place, message);
}

tl::unexpected<Error> fail(const std::string& message) { return fail_at("", message); }

tl::unexpected<Error> fail_at(std::string file, const std::string& message, int line, int column) {
  return tl::unexpected<Error>(Error{printable(message), std::move(file), line, column});
}

}  // namespace attest
