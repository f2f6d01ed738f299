// Runs when attest is built: prints the hash of the suite in the given folder, then a line for each
// group and rate with its number of vectors, as the source of a string for released_suite.cpp.
#include <cstdlib>

#include <fmt/format.h>

#include "harness/cli/suite_folder.hpp"

int main(int count, char** arguments) {
  if (count != 2) return EXIT_FAILURE;
  const attest::cli::SuiteFolder suite{arguments[1], {}};
  const auto hash = suite.hash();
  if (!hash) {
    fmt::print(stderr, "{}\n", hash.error().to_string());
    return EXIT_FAILURE;
  }
  const auto groups = suite.vectors_by_group();
  fmt::print("extern const char* const released_suite_vectors;\n");
  // If a case is malformed, there are no groups. With "none" instead of the hash, each run counts
  // the vectors itself, and reports the malformed case.
  fmt::print("const char* const released_suite_vectors =\n\"{}\\n\"\n",
             groups.empty() ? "none" : hash->sha256);
  for (const auto& [group, rates] : groups) {
    for (const auto& [rate, vectors] : rates) {
      fmt::print("\"{} {} {}\\n\"\n", group, rate.to_string(), vectors);
    }
  }
  fmt::print(";\n");
  return EXIT_SUCCESS;
}
