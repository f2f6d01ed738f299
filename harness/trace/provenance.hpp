// provenance.toml: the origin of the traces of a folder.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "harness/core/result.hpp"

namespace attest {

struct Provenance {
  std::string profile;              // "px4-v1.5.5"
  std::string reference;            // "PX4 v1.5.5 mc_att_control"
  std::string compiler;             // "gcc 12.2.0"
  std::string reason;               // why and how the traces were recorded
  std::vector<std::string> covers;  // for recordings: the groups whose behaviour they show
  // Stem of a mixer trace -> "R: 4x 8000 9000 5000 1500".
  std::map<std::string, std::string> mixers;
  std::map<std::string, std::string> sha256;  // file name -> hash
};

inline constexpr const char* provenance_name = "provenance.toml";

// The keys are the members' names; all are optional. Errors: unreadable file, not TOML, an unknown
// key.
Result<Provenance> read_provenance(const std::filesystem::path& file);

// The provenance of a folder; an empty one if the folder has no such file. Errors: those of
// read_provenance().
Result<Provenance> provenance_in(const std::filesystem::path& folder);

std::string to_toml(const Provenance& provenance);

// Sets the profile in the folder's provenance, and adds `mixers` to it (as Provenance::mixers).
// Errors: those of read_provenance(); the file cannot be written.
Result<void> add_origin(const std::filesystem::path& folder, const std::string& profile,
                        const std::map<std::string, std::string>& mixers);

}  // namespace attest
