// The folder of a suite: where its cases, goldens and models are. An archive can take its place.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "harness/casefile/parse.hpp"
#include "harness/core/file.hpp"
#include "harness/core/rate.hpp"
#include "harness/core/result.hpp"

namespace attest::cli {

// "profile/group" -> the number of vectors at each rate.
using VectorsByGroup = std::map<std::string, std::map<LoopRate, std::size_t>>;

// The file in a suite's folder that names its base: another suite, whose cases the suite also has.
inline constexpr const char* base_file = "BASE";

// The archive in data_folder(), or in a folder that --suite names.
inline constexpr const char* packed_suite = "suite.zip";

// The hash of a suite, and those of the files from which it was computed.
struct SuiteHash {
  std::string sha256;
  FileHashes files;
};

struct SuiteFolder {
  std::filesystem::path root;
  // The suite whose cases this suite also has. The file BASE in `root` names it: `released` for
  // data_folder(), or else a path relative to `root`. A case in cases() replaces the one with the
  // same path in the base. The goldens are those of this suite only.
  std::optional<std::filesystem::path> base;

  std::filesystem::path cases() const { return root / "cases"; }
  CaseFolders case_folders() const;  // those of the base, then cases() if it exists
  // Without a folder `models` of its own, a suite uses that of its base.
  std::filesystem::path models() const;
  std::filesystem::path golden() const { return root / "golden"; }
  // The recordings of the firmware. Without a folder of its own, a suite uses that of its base.
  std::filesystem::path recorded() const;

  // The first word of the file VERSION in `folder`, which is cases() or golden(); else
  // "unversioned".
  std::string version_of(const std::filesystem::path& folder) const;

  // The groups of all profiles, sorted: "px4-v1.5.5/tpa". Reads the case files. Empty when one of
  // them is malformed, which select_cases() reports.
  std::vector<std::string> groups() const;

  // Reads the case files. Empty when one of them is malformed.
  VectorsByGroup vectors_by_group() const;

  // SHA-256 of the lines that `sha256sum` prints for the case files (with those of the base) and
  // the provenance files of the goldens, in the order of their paths:
  //
  //     <hash>  cases/px4-v1.5.5/tpa/each_axis.toml
  //
  // The hash covers all content that verdicts depend on: a case file has all inputs, a provenance
  // file has the hashes of its traces and vehicles, and a run checks the traces and the vehicles
  // against these hashes. `ci/suite-hash` prints the same hash. Errors: a file that cannot be read.
  Result<SuiteHash> hash() const;
};

// The data of this attest: share/attest of the installation that this program is in; else the
// nearest folder above the program that has cases/ and golden/. That is the source tree, if the
// build folder is inside it. Empty: neither exists.
std::optional<std::filesystem::path> data_folder();

// The suite in the folder `data`: the archive suite.zip of an installation, or the folder itself.
std::filesystem::path suite_in(const std::filesystem::path& data);

// Errors: `suite` is in an archive, which attest does not change.
Result<void> check_can_change(const std::filesystem::path& suite);

// Whether `data`, a data_folder(), is that of an installation instead of the source tree.
bool is_installation(const std::filesystem::path& data);

// `given` if it is not empty; else $ATTEST_SUITE; else data_folder(). Errors: there is no such
// suite; its file BASE names no suite, or a suite that has a base itself; an archive is damaged.
Result<SuiteFolder> find_suite(const std::string& given);

}  // namespace attest::cli
