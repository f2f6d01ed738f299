// A TOML document as a template: the same text with some of its numbers replaced.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "harness/core/result.hpp"

namespace attest {

// Immutable; copies share the document.
class TomlDocument {
 public:
  // Pairs of a path and the new value. A path is keys with points between them, and an index at its
  // end for an element of an array: "battery.cells", "inertia_kg_m2[0]", "rotors.r0.position_m[2]".
  using Replacements = std::vector<std::pair<std::string, double>>;

  // `name` stands for the file in messages. Errors: not valid TOML, or nested too deeply.
  static Result<TomlDocument> parse(std::string_view text, const std::string& name);

  // The number at a path; empty if there is no such table or key. Errors: the value is not a
  // number; a path with an index leads to no array, or the array has no such element; the path
  // leads through a value that is not a table.
  Result<std::optional<double>> number(const std::string& path) const;

  // The text with these numbers. Adds keys and tables that do not exist. A whole number below 2^53
  // is written as an integer. Comments are left out. In each table the keys with values come first,
  // then its tables; both keep their order, and new ones come last. Errors: those of number().
  Result<std::string> with(const Replacements& replacements) const;

 private:
  struct Impl;
  explicit TomlDocument(std::shared_ptr<const Impl> impl) : impl_(std::move(impl)) {}
  std::shared_ptr<const Impl> impl_;
};

}  // namespace attest
