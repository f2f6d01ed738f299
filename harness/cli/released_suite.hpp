// The suite that this attest was released with.
#pragma once

#include <string>

#include "harness/cli/suite_folder.hpp"

namespace attest::cli {

// Its hash (SuiteFolder::hash). It is compiled in from golden/SUITE.sha256, because a suite
// cannot prove itself that it is the released one.
std::string released_suite_sha256();

// SuiteFolder::vectors_by_group() of `suite`, whose hash is `sha256`. The suite of the source tree
// was counted when attest was built, so that a run of one case need not read all cases.
VectorsByGroup vectors_by_group(const SuiteFolder& suite, const std::string& sha256);

}  // namespace attest::cli
