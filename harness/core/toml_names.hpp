// How error messages about TOML files name the kinds of values.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "harness/core/toml.hpp"

namespace attest {

// The kind of a value that was found: "an integer".
constexpr std::string_view name_of(TomlKind kind) {
  constexpr std::array<std::string_view, 7> names = {
      "nothing", "a boolean", "an integer", "a floating point number",
      "text",    "an array",  "a table"};  // in the order of TomlKind
  return names.at(static_cast<std::size_t>(kind));
}

// The kind of value that a key must have: "an array of numbers".
template <typename T>
constexpr std::string_view needed() {
  if constexpr (std::is_same_v<T, std::string>) return "text";
  if constexpr (std::is_same_v<T, double>) return "a number";
  if constexpr (std::is_same_v<T, std::int64_t>) return "an integer";
  if constexpr (std::is_same_v<T, bool>) return "true or false";
  if constexpr (std::is_same_v<T, std::vector<std::string>>) return "an array of text";
  if constexpr (std::is_same_v<T, std::vector<double>>) return "an array of numbers";
  if constexpr (std::is_same_v<T, std::vector<std::int64_t>>) return "an array of integers";
  if constexpr (std::is_same_v<T, TomlTable>) return "a table";
}

}  // namespace attest
