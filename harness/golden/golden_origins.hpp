// golden/<profile>/provenance.toml: the origin of each golden of a profile, and the hashes of all
// that it depends on. Its last line is a seal, by which an edit is noticed.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>

#include "harness/core/result.hpp"

namespace attest {

struct GoldenOrigin {
  std::string sha256;       // of the golden's text
  std::string case_sha256;  // Case::sha256
  std::string reference;    // whose outputs it has: "attest 0.1.0"
  std::string compiler;     // "gcc 12.2.0"
  std::string reason;       // why it was blessed
  // Of a flight: name of a vehicle's file -> SHA-256.
  std::map<std::string, std::string> models = {};
  // Of a golden of a port, whose outputs attest cannot compute: rate -> SHA-256 of the inputs.
  std::map<std::string, std::string> inputs = {};

  bool operator==(const GoldenOrigin&) const = default;
};

using GoldenOrigins = std::map<std::string, GoldenOrigin>;  // by key_of() of the case

std::filesystem::path origins_file(const std::filesystem::path& golden_root,
                                   const std::string& profile);

// `text` is that of the file. Errors: it was changed after it was sealed, or has no seal; not TOML;
// a missing or unknown key.
Result<GoldenOrigins> parse_origins(std::string_view text, const std::filesystem::path& file);

// The text of the file, with its seal.
std::string to_text(const GoldenOrigins& origins);

}  // namespace attest
