// The report of a run as one HTML page. The page needs no other file and no network, and its tables
// can be read without scripts.
#pragma once

#include <cstddef>
#include <string>

#include "harness/report/report.hpp"

namespace attest {

// The plots get the bytes that the rest of the page leaves free.
inline constexpr std::size_t most_page_bytes = 4'900'000;

// Text of the port (name, reasons) is escaped. A content security policy admits only the scripts of
// the page. Deterministic, as the JSON report.
std::string html_report(const Report& report);

}  // namespace attest
