// Decides whether the flights of a sweep meet a requirement.
#pragma once

#include "harness/sweep/summary.hpp"

namespace attest {

// `metric`: the index of the requirement's metric in PilotData::metrics. `worst`: the number of
// worst samples to name.
RequirementResult judge_requirement(const Requirement& requirement, const PilotData& flights,
                                    std::size_t metric, const SweepFile& sweep, std::size_t worst);

}  // namespace attest
