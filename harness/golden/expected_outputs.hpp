// The outputs that are right for given inputs. They come from attest's reference. Where there is a
// golden, the reference must agree with it.
#pragma once

#include "harness/casefile/case.hpp"
#include "harness/core/result.hpp"
#include "harness/golden/golden.hpp"
#include "harness/loop/open_loop.hpp"
#include "harness/trace/trace.hpp"

namespace attest {

// `inputs` with the outputs of the reference, as one instance of the subject's module. Errors: the
// reference fails.
Result<Trace> reference_outputs(const ModuleUnderTest& subject, Trace inputs);

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

}  // namespace attest
