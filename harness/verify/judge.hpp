// From what a port did to a verdict: shared by open loop and flight.
#pragma once

#include <optional>

#include "harness/casefile/case.hpp"
#include "harness/compare/compare.hpp"
#include "harness/host/port_says.hpp"
#include "harness/loop/unit_driver.hpp"
#include "harness/verify/verdict.hpp"

namespace attest {

// The case's own tolerances where it has some; of a port in fixed point at least its LSBs, of a run
// of so many ticks.
Tolerances tolerances_of(const Case& the_case, Level level, std::optional<int> fraction_bits,
                         std::size_t ticks);

// The port declares that it does not do the result's group: the verdict is unsupported.
bool declines(const PortSays& port, CaseResult& result);
bool declines(const PortSays& port, const std::string& group);

void judge(const PortFault& fault, CaseResult& result);

// What was answered before the port said that it does not do this is judged all the same: wrong
// outputs are not excused by a later ATTEST_UNSUPPORTED.
bool leaves_ticks_to_judge(const PortFault& fault);

// From `tick` on `answered` gets the outputs of `want`, so that only the ticks before decide.
void leave_out_from(std::size_t tick, const Trace& want, Trace& answered);

// After the ticks before the fault have been judged: a failure stays one, and the reason says both.
void judge_after(const PortFault& fault, CaseResult& result);

void judge(const Comparison& comparison, CaseResult& result);

}  // namespace attest
