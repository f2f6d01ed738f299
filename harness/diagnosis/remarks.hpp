// Mistakes that the verdicts of a run show, without the port's values.
#pragma once

#include <string>
#include <vector>

#include "harness/verify/verdict.hpp"

namespace attest {

// Whether a failing vector passes alone. A timeout after others is not repeated, so that is not
// known.
bool passes_alone(const VectorResult& failed);

// Sentences about the port, for people: its instances share state; it has the step of one rate; its
// compiler may have removed the checks of NaN; only its flights fail, or were judged.
std::vector<std::string> remarks_on(const std::vector<VectorResult>& results);

}  // namespace attest
