// How much memory the suite takes: no time, so no benchmark, but a claim.
#pragma once

#include <string>

namespace attest::bench {

// A Markdown table of peaks, measured in processes of their own. `met` is false when a bound was
// missed.
std::string memory_table(bool& met);

}  // namespace attest::bench
