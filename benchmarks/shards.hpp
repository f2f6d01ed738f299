// The claims about a sweep that many machines fly. Each is of one run of the program, so it is not
// a benchmark.
#pragma once

#include <string>

namespace attest::bench {

// A Markdown table of the time and the peak memory with which `attest` plans a million samples in a
// thousand shards, and merges them. Sets `met` to false when a bound was missed.
std::string shards_table(bool& met);

}  // namespace attest::bench
