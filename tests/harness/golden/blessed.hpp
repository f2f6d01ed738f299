// Goldens of the tests' own cases, made by the reference of this build.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "harness/casefile/case.hpp"
#include "harness/golden/new_goldens.hpp"

namespace attest {

// The reference's outputs in each run configuration of the case. REQUIRES: open loop.
std::vector<Trace> answers_of_reference(const Case& the_case);

// What bless would write. REQUIRES: open loop.
MadeGolden made_by_reference(const Case& the_case);

// Writes the golden to its place; the test fails if it cannot.
void bless(const std::filesystem::path& golden_root, const Case& the_case, const MadeGolden& made);
void bless(const std::filesystem::path& golden_root, const Case& the_case);

}  // namespace attest
