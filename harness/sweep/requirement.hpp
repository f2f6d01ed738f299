// Whether the flights of a sweep meet its requirements.
#pragma once

#include "harness/sweep/summary.hpp"

namespace attest {

// `metric`: the place of the requirement's metric in the data.
RequirementResult judge_requirement(const Requirement& requirement, const PilotData& flights,
                                    std::size_t metric, const SweepFile& sweep, std::size_t worst);

}  // namespace attest
