// Reading the profiles of a case file: a list, or a range of successive profiles.
#pragma once

#include <string>
#include <vector>

#include "harness/core/toml.hpp"

namespace attest {

// Reads `profiles`, or `since` and `until`. Returns `folder`, the profile of the file's folder,
// then the other profiles, newest first. A range grows when attest gets a newer profile of the law.
// Errors: the folder's profile is not among them; a profile is unknown or of another law. The
// folder's profile may be unknown to attest if it is in `profiles`: a suite may define a profile
// that only ports know.
std::vector<std::string> parse_profiles(const TomlTable& root, const std::string& folder);

}  // namespace attest
