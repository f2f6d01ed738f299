// Goldens of the tests' own cases, made by the reference of this build.
#pragma once

#include <filesystem>
#include <vector>

#include "harness/casefile/case.hpp"
#include "harness/golden/golden.hpp"

namespace attest {

// The reference's outputs in each run configuration of the case. REQUIRES: open loop.
std::vector<GoldenTrace> answers_of_reference(const Case& the_case);

// Writes the golden to its place; the test fails if it cannot. REQUIRES: the golden of the case's
// first profile is in place.
void bless(const std::filesystem::path& golden_root, const Case& the_case);

}  // namespace attest
