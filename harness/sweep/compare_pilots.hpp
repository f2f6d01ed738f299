// Decides whether a port flies like the reference, by paired differences on the same samples.
#pragma once

#include <cstddef>
#include <cstdint>

#include "harness/sweep/sample_table.hpp"
#include "harness/sweep/summary.hpp"

namespace attest {

// The smallest number of pairs of flights that is significant if all pairs differ in the same
// direction. With fewer pairs, no sign test can find a difference. `metrics`: the number
// of metrics.
std::uint64_t pairs_to_compare(const SweepFile& sweep, std::size_t metrics);

PortDifference compare_pilots(const SweepFile& sweep, const SampleColumns& columns,
                              const PilotData& reference, const PilotData& port);

}  // namespace attest
