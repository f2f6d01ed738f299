// Where the cases and goldens are.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "harness/core/result.hpp"
#include "harness/schedule/rate.hpp"

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

  // "profile/group" -> how many cases there are at each rate. Reads the case files, as groups().
  std::map<std::string, std::map<Rate, std::size_t>> cases_by_group() const;

  // SHA-256 of the lines that `sha256sum` prints for the case files and the provenance files of the
  // goldens, in the order of their paths: "<hash>  cases/px4-v1.5.5/tpa/each_axis.toml". A case
  // file says all inputs, a provenance file has the hashes of its traces and vehicles, and both are
  // checked when a case is run: the content that verdicts depend on is in this one number.
  // `ci/suite-hash` prints the same. Errors: a file that cannot be read.
  Result<std::string> sha256() const;
};

// The same of the suite that this attest was released with (golden/SUITE.sha256 when it was built):
// a suite cannot say of itself that it is that one.
std::string released_suite_sha256();

// `given` if it is not empty; else $ATTEST_SUITE; else share/attest of the installation this
// program is in; else the nearest folder above the program that has cases/ and golden/, which is
// the source tree of a build in it.
Result<SuiteFolder> find_suite(const std::string& given);

}  // namespace attest::cli
