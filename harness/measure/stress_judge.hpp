// The verdict on a live flight: outputs, the end of the flight, timing. Each is judged
// independently of the others. A failure has priority over a skip, and a skip over a pass.
#pragma once

#include <optional>

#include "harness/casefile/case.hpp"
#include "harness/measure/stress.hpp"
#include "harness/plant/plant.hpp"
#include "harness/realtime/live_flight.hpp"

namespace attest {

// Compares the outputs with those of the reference for the same inputs at the same times: late and
// missing ticks do not excuse wrong outputs. Adds a skip where the outputs cannot be judged: no
// tick, ticks beyond those that were kept, a decision of the law at its threshold before or at the
// first deviation. REQUIRES: a port without a fixed step. Moves the samples out of `unit`.
void judge_outputs(const Case& the_case, Module module, LiveUnitRecord& unit,
                   std::optional<int> fraction_bits, CaseResult& result);

// Judges a flight that the plant ended. It is a skip if the outputs agree with the reference's to
// the end, or if the reference loses the vehicle too, flown in simulation at the same times.
// Otherwise it fails. REQUIRES: the outputs were judged before, if they can be.
void judge_flight_end(const StressTask& task, const LiveFlight& flight, CaseResult& result);

// Compares the figures of `stress` with the budget. A port fails for overruns, and for misses and
// late starts that are attributed to it (deadline_misses.hpp). Those of the machine give a skip.
void judge_timing(const RealtimeBudget& budget, StressResult& stress);

// All three, for one unit of the flight. `of_end`: whether the end of the flight counts for this
// unit; it counts once. A flight that a fault of the other unit ended is a skip. REQUIRES: `stress`
// has the measurements, and the identity of its result. Moves the unit's samples out of `flight`.
void judge_unit(const StressTask& task, Module module, LiveFlight& flight, bool of_end,
                StressResult& stress);

// Adds the reason why a part cannot be judged.
void add_skip(CaseResult& result, const std::string& reason);

}  // namespace attest
