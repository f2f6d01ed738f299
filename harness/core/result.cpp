#include "harness/core/result.hpp"

#include <utility>

#include <fmt/format.h>

namespace attest {

std::string Error::to_string() const {
  std::string place = file;
  if (line > 0) place += fmt::format(":{}", line);
  if (line > 0 && column > 0) place += fmt::format(":{}", column);
  return place.empty() ? message : fmt::format("{}: {}", place, message);
}

tl::unexpected<Error> fail(std::string message) { return fail_at("", std::move(message)); }

tl::unexpected<Error> fail_at(std::string file, std::string message, int line, int column) {
  return tl::unexpected<Error>(Error{std::move(message), std::move(file), line, column});
}

}  // namespace attest
