// How much memory the suite takes: no time, so no benchmark, but a claim.
#pragma once

#include <string>

namespace attest::bench {

// A Markdown table of the peak, sampled while the suite runs. `met` is false when a bound was
// missed.
std::string memory_table(bool& met);

}  // namespace attest::bench
