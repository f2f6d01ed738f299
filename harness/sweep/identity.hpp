// The identity of the sweep whose results are in a folder.
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

// Makes the folder and the identity file. If the folder has that file, checks that it is of this
// sweep and shard. Errors: the folder has other files and no identity file; it is of another sweep
// or shard, with the first difference.
Result<void> claim_folder(const std::filesystem::path& folder, const SweepIdentity& identity);

// The first difference, as text: "the port is lib:a.so, not lib:b.so". Empty if both are of the
// same sweep. The shards are not compared.
std::string difference(const SweepIdentity& found, const SweepIdentity& expected);

}  // namespace attest
