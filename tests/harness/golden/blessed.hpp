// Goldens of the tests' own cases, made by the reference of this build.
#pragma once

#include <filesystem>
#include <vector>

#include "harness/casefile/case.hpp"
#include "harness/golden/golden.hpp"

namespace attest {

// What the reference answers in each of the case's configurations. REQUIRES: open loop.
std::vector<GoldenTrace> answers_of_reference(const Case& the_case);

// Puts the golden in its place. Fails the test if it cannot. REQUIRES: that of the case's first
// profile is in place.
void bless(const std::filesystem::path& golden_root, const Case& the_case);

}  // namespace attest
