// The claim about the suite's memory. It is not a time, so it is not a benchmark.
#pragma once

#include <string>

namespace attest::bench {

// A Markdown table of the peak, sampled while the suite runs. Sets `met` to false when a bound was
// missed.
std::string memory_table(bool& met);

}  // namespace attest::bench
