// Judges a live flight: its outputs, its end, its timing. A failure of one of them has priority
// over a skip, and a skip over a pass.
#pragma once

#include <optional>
#include <vector>

#include "harness/casefile/case.hpp"
#include "harness/measure/stress.hpp"
#include "harness/plant/plant.hpp"
#include "harness/realtime/live_flight.hpp"

namespace attest {

// Compares the outputs with those of the reference for the same inputs at the same times. So late
// and missing ticks do not excuse wrong outputs. Adds a skip if outputs cannot be judged: there is
// no tick, there are more ticks than checked_ticks, or ReferenceComparison::undecided is set. Moves
// samples and parameter changes out of `unit`. REQUIRES: a port without a fixed step.
void judge_outputs(const Case& the_case, Module module, LiveUnitRecord& unit,
                   std::optional<int> fraction_bits, VectorResult& result);

// Judges a flight that ended because the vehicle was lost, unless the result has failed already. If
// the result is a pass, all outputs agree with the reference's, and it becomes a skip. If it is a
// skip, the reference flies in simulation at the same times; if the reference does not lose the
// vehicle, the result becomes a failure. REQUIRES: judge_outputs() was called before, unless the
// port has a fixed step.
void judge_flight_end(const StressTask& task, const LiveFlight& flight, VectorResult& result);

// Compares the figures of `stress` with the budget. A port fails for too many overruns, or for too
// many misses or late starts that are the port's (deadline_misses.hpp). If the port does not fail
// for these, too many misses or late starts of any cause, or late steps of the plant, give a skip.
void judge_timing(const RealtimeBudget& budget, StressResult& stress);

// Verdict `protocol` if the unit's thread used more CPU time than its steps explain: the port
// shares the process that measures, and may have changed the clock. The kernel counts the CPU time.
void judge_clock(const Wait& wait, const std::vector<LiveTick>& ticks, StressResult& stress);

// Does all of this for one unit of the flight, or judges only its fault if it has one. `of_end`:
// judge the end of the flight, which the caller does for one unit only. A flight that a fault of
// the other unit ended is a skip. Moves the unit's samples out of `flight`. REQUIRES: `stress` has
// the measurements, and the identity of its result.
void judge_unit(const StressTask& task, Module module, LiveFlight& flight, bool of_end,
                StressResult& stress);

// Adds a verdict of skip with this reason. A failure stays a failure.
void add_skip(VectorResult& result, const std::string& reason);

}  // namespace attest
