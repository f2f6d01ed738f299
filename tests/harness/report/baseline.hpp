// Reports are compared byte by byte with files that a person has read and accepted.
#pragma once

#include <filesystem>
#include <string>

#include <gtest/gtest.h>

namespace attest {

// Empty if `text` is the content of `folder`/`name`; otherwise the difference, and what to do. A
// baseline is never overwritten: with `accept` the text is written next to it as `name`.new, to be
// read and renamed by hand.
std::string baseline_complaint(const std::filesystem::path& folder, const std::string& name,
                               const std::string& text, bool accept);

// For EXPECT_TRUE, with tests/baselines/; accepts when ATTEST_ACCEPT_BASELINES is 1.
testing::AssertionResult is_baseline(const std::string& name, const std::string& text);

}  // namespace attest
