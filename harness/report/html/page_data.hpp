// The values that fill in page.mustache.
#pragma once

#include <string>

#include "harness/report/report.hpp"

namespace attest {

// The page of the report, without plots: the element `plots` is empty.
std::string filled_page(const Report& report);

}  // namespace attest
