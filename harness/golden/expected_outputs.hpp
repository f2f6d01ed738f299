// What is right for a vector of the suite: the reference's outputs, with which the golden must
// agree.
#pragma once

#include "harness/casefile/case.hpp"
#include "harness/core/result.hpp"
#include "harness/golden/golden.hpp"
#include "harness/golden/reference_flight.hpp"
#include "harness/trace/trace.hpp"

namespace attest {

struct ExpectedOutputs {
  Trace trace;  // the inputs of the vector, with the outputs that are right for them
  // False: the reference of this build has other bits than the golden, within the tolerances, so a
  // port can be judged by tolerances only. expected_outputs() then takes the golden's values at all
  // ticks that the golden has.
  bool is_exact = true;
};

// The outputs of an open-loop vector: those of the reference, which must agree with the golden. If
// a port made the golden, they are the golden's. Errors: the golden has no such vector, lacks a
// tick or an output, or was made for other inputs; the reference differs from it by more than the
// tolerances of the case.
Result<ExpectedOutputs> expected_outputs(const Case& the_case, const Rate& rate,
                                         const Golden& golden);

// The flight of the golden, which was one of the reference. Whether the reference still flies like
// this costs a flight, so a judge asks only when a port fails by the golden alone. Errors: the
// golden has no such flight, or was flown with another model of the vehicle; its trace lacks what a
// comparison needs.
Result<ReferenceFlight> expected_flight(const Case& the_case, const RunConfiguration& configuration,
                                        const Vehicle& vehicle, const Golden& golden);

}  // namespace attest
