// The version of attest and the compiler that built it.
#pragma once

#include <string>

namespace attest {

inline constexpr const char* version = ATTEST_VERSION;

// For example "gcc 12.2.0" or "clang 14.0.6".
std::string compiler();

}  // namespace attest
