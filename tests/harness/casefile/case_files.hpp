// Case files made by tests, in a folder of their own.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "harness/casefile/parse.hpp"
#include "harness/trace/module.hpp"
#include "tests/harness/core/temporary_directory.hpp"

namespace attest {

class CaseFiles {
 public:
  std::filesystem::path folder() const { return directory_.path() / "cases"; }

  // Writes cases/<profile>/<group>/<name>.toml: `text` as it is.
  std::filesystem::path write(std::string_view group, std::string_view name, std::string_view text,
                              std::string_view profile = "px4-v1.5.5") const;

  // Makes models/<name>.toml, so that cases find a vehicle of this name; it cannot be loaded.
  void name_vehicle(std::string_view name) const;

  // A case of the group `tests`, 10 ticks long: five lines, so `body` begins in line 6.
  static std::string with(std::string_view body);

  // Parses `text` as a case of the group `tests`.
  Result<Case> parse(std::string_view text) const;

 private:
  TemporaryDirectory directory_;
};

// REQUIRES: with(body) is a valid case.
Case case_of(std::string_view body);
// The same for a unit of a profile.
Case unit_case_of(Module module, std::string_view profile, std::string_view body);

// The errors that with(body) gives, without the file's name: "6:1: unknown key ...", one a line;
// empty when it is valid.
std::string errors_of(std::string_view body);
std::string errors_of_text(std::string_view text);

}  // namespace attest
