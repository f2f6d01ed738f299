// `lib:PATH`: a shared library that exports attest_unit_v1().
#pragma once

#include <memory>
#include <string>

#include "harness/core/result.hpp"
#include "harness/port/port.hpp"

namespace attest {

Result<std::unique_ptr<Port>> open_shared_library(const std::string& path);

}  // namespace attest
