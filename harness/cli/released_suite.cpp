#include "harness/cli/released_suite.hpp"

#include <sstream>

// Defined in the source that count_suite.cpp prints for the suite of the source tree. The first
// word is the hash of that suite.
extern const char* const released_suite_vectors;

namespace attest::cli {

std::string released_suite_sha256() { return ATTEST_SUITE_SHA256; }

VectorsByGroup vectors_by_group(const SuiteFolder& suite, const std::string& sha256) {
  std::istringstream text(released_suite_vectors);
  std::string counted_sha256;
  text >> counted_sha256;
  if (counted_sha256 != sha256) return suite.vectors_by_group();
  VectorsByGroup groups;
  std::string group, rate;
  for (std::size_t vectors = 0; text >> group >> rate >> vectors;) {
    if (const auto parsed = LoopRate::parse(rate)) groups[group][*parsed] = vectors;
  }
  return groups;
}

}  // namespace attest::cli
