// The values and the plots of the findings of a hunt, for its page.
#pragma once

#include "harness/diagnosis/hunt_findings.hpp"
#include "harness/report/document.hpp"

namespace attest {

// A table of the last ticks up to the first deviation, at most three: the inputs that differ from
// the baseline, the parameters that are set, and the outputs that deviate. Its `id` is the name of
// the finding. It is not in the text. Without rows if the finding has no deviation.
DocumentTable values_of(const HuntFinding& finding);

// Plots of the outputs that deviate, if the case has more ticks than the table. Without plots
// otherwise.
PlotGroup plots_of(const HuntFinding& finding);

}  // namespace attest
