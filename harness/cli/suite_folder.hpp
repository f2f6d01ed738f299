// Where the cases and goldens are.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "harness/core/result.hpp"

namespace attest::cli {

struct SuiteFolder {
  std::filesystem::path root;

  std::filesystem::path cases() const { return root / "cases"; }
  std::filesystem::path models() const { return root / "models"; }
  std::filesystem::path golden() const { return root / "golden"; }
  std::filesystem::path recorded() const { return golden() / "recorded"; }

  // Of cases() or golden(): what the file VERSION there says, or "unversioned".
  std::string version_of(const std::filesystem::path& folder) const;

  // The groups that there are, profile by profile: "px4-v1.5.5/tpa", sorted. Reads the case files;
  // none when one of them is malformed, which select_cases() reports.
  std::vector<std::string> groups() const;
};

// `given` if it is not empty; else $ATTEST_SUITE; else share/attest of the installation this
// program is in; else the nearest folder above the program that has cases/ and golden/, which is
// the source tree of a build in it.
Result<SuiteFolder> find_suite(const std::string& given);

}  // namespace attest::cli
