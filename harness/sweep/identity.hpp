// To which sweep the results in a folder belong.
#pragma once

#include <filesystem>
#include <string>

#include "harness/core/result.hpp"

namespace attest {

struct SweepIdentity {
  std::string attest_version;
  std::string sweep_sha256;  // FlightSampler::sha256()
  std::string port;          // empty: the reference only
  std::string port_sha256;
  std::string shard = "1/1";

  friend bool operator==(const SweepIdentity&, const SweepIdentity&) = default;
};

inline constexpr const char* identity_file = "identity.json";

std::string identity_text(const SweepIdentity& identity);  // the content of the file

// Errors: no such file, or another kind of file.
Result<SweepIdentity> read_identity(const std::filesystem::path& folder);

// Makes the folder and the file, or checks that the folder is of this sweep. Errors: a folder with
// other files; the results of another sweep, with the first difference.
Result<void> claim_folder(const std::filesystem::path& folder, const SweepIdentity& identity);

// The first difference, as text: "the port is lib:a.so, not lib:b.so". The shard is not compared.
// Empty: both are of the same sweep.
std::string difference(const SweepIdentity& found, const SweepIdentity& expected);

}  // namespace attest
