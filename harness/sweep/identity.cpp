#include "harness/sweep/identity.hpp"

#include <array>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "harness/core/file.hpp"
#include "harness/core/json_text.hpp"

namespace attest {
namespace {

namespace fs = std::filesystem;

using Member = std::string SweepIdentity::*;

struct Named {
  const char* key;
  const char* what;
  Member member;
};
constexpr std::array<Named, 5> identity_members = {{
    {"attest", "the version of attest", &SweepIdentity::attest_version},
    {"sweep_sha256", "the hash of sweep file, case, vehicle and samples",
     &SweepIdentity::sweep_sha256},
    {"port", "the port", &SweepIdentity::port},
    {"port_sha256", "the hash of the port", &SweepIdentity::port_sha256},
    {"shard", "the shard", &SweepIdentity::shard},
}};

std::string first_difference(const SweepIdentity& found, const SweepIdentity& expected,
                             bool with_shard) {
  for (const Named& named : identity_members) {
    if (!with_shard && named.member == &SweepIdentity::shard) continue;
    const std::string& has = found.*named.member;
    const std::string& wants = expected.*named.member;
    if (has == wants) continue;
    return fmt::format("{} is {:.20}, not {:.20}", named.what, has.empty() ? "none" : has,
                       wants.empty() ? "none" : wants);
  }
  return "";
}

// Ignores the identity file, and temporary files of it that a killed process has left.
bool has_other_files(const fs::path& folder) {
  std::error_code failed;
  for (fs::directory_iterator it(folder, failed), end; it != end && !failed; it.increment(failed)) {
    if (it->path().filename().string().find(identity_file) == std::string::npos) return true;
  }
  return false;
}

}  // namespace

std::string difference(const SweepIdentity& found, const SweepIdentity& expected) {
  return first_difference(found, expected, false);
}

std::string identity_text(const SweepIdentity& identity) {
  nlohmann::ordered_json json;
  for (const Named& named : identity_members) json[named.key] = identity.*named.member;
  return document_of(json);
}

Result<SweepIdentity> read_identity(const fs::path& folder) {
  const fs::path file = folder / identity_file;
  const auto text = read_file(file);
  if (!text) return tl::unexpected(text.error());
  const auto parsed = parse_json(*text, file.string());
  if (!parsed) return tl::unexpected(parsed.error());
  const nlohmann::json& json = *parsed;
  SweepIdentity identity;
  for (const Named& named : identity_members) {
    if (!json.is_object() || !json.contains(named.key) || !json[named.key].is_string()) {
      return fail_at(file.string(),
                     fmt::format("is not of `attest sweep`: it has no `{}`", named.key));
    }
    identity.*named.member = json[named.key].get<std::string>();
  }
  return identity;
}

Result<void> claim_folder(const fs::path& folder, const SweepIdentity& identity) {
  std::error_code failed;
  fs::create_directories(folder, failed);
  if (failed) return fail_at(folder.string(), "cannot be made: " + failed.message());
  // Checked before the identity file, because another attempt at the same shard may write that file
  // and then others between the two checks.
  const bool has_others = has_other_files(folder);
  if (fs::exists(folder / identity_file, failed)) {
    const auto found = read_identity(folder);
    if (!found) return tl::unexpected(found.error());
    const std::string other = first_difference(*found, identity, true);
    if (other.empty()) return {};
    return fail_at(folder.string(),
                   fmt::format("has the results of another sweep: {}; name another folder with "
                               "--out, or remove this one",
                               other));
  }
  if (has_others) {
    return fail_at(folder.string(),
                   "has other files, and no results of a sweep; name an empty or new folder with "
                   "--out");
  }
  return write_file(folder / identity_file, identity_text(identity));
}

}  // namespace attest
