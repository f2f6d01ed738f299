// Whether a port flies like the reference: paired differences on the same samples.
#pragma once

#include <cstddef>
#include <cstdint>

#include "harness/sweep/sample_table.hpp"
#include "harness/sweep/summary.hpp"

namespace attest {

// The smallest number of pairs of flights that is significant if all differ in the same direction.
// With fewer pairs, no test can find a difference.
std::uint64_t pairs_to_compare(const SweepFile& sweep, std::size_t metrics);

PortDifference compare_pilots(const SweepFile& sweep, const SampleColumns& columns,
                              const PilotData& reference, const PilotData& port);

}  // namespace attest
