// A folder for the goldens that a test makes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "harness/golden/golden.hpp"
#include "tests/harness/casefile/case_files.hpp"
#include "tests/harness/golden/blessed.hpp"

namespace attest {

inline RunConfiguration at(std::int64_t hertz) { return {Rate::hz(hertz), std::nullopt}; }

inline constexpr const char* two_rates = "rates_hz = [100, 333]\nrates_why = \"two\"\n";
inline constexpr const char* of_the_case = "px4-v1.5.5/tests/the_case.csv";
inline constexpr const char* of_the_profile = "px4-v1.5.5/provenance.toml";

class GoldenTest : public testing::Test {
 protected:
  std::filesystem::path root() const { return directory_.path() / "golden"; }
  std::filesystem::path file() const { return root() / of_the_case; }
  std::filesystem::path origins() const { return root() / of_the_profile; }
  Case a_case(const std::string& body = "") const { return case_of(two_rates + body); }
  Case other_case() const {
    Case other = a_case("level = \"exact\"\n");
    other.name = "other_case";
    return other;
  }

  Result<Golden> open(const Case& the_case) const { return Goldens(root()).open(the_case); }
  std::string error_of_open(const Case& the_case) const {
    const auto golden = open(the_case);
    EXPECT_FALSE(golden);
    return golden ? "" : golden.error().to_string();
  }

  // Every file below the root, relative to it.
  std::set<std::string> files() const {
    std::set<std::string> found;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root())) {
      if (!entry.is_directory()) found.insert(entry.path().lexically_relative(root()).string());
    }
    return found;
  }

 private:
  TemporaryDirectory directory_;
};

}  // namespace attest
