// The verdict on a live flight: outputs, the flight itself, timing. Each is judged whatever the
// others are. A failure is the verdict before what could not be judged, and that before a pass.
#pragma once

#include <optional>

#include "harness/casefile/case.hpp"
#include "harness/measure/stress.hpp"
#include "harness/plant/plant.hpp"
#include "harness/realtime/live_flight.hpp"

namespace attest {

// The outputs against those of the reference for the same inputs at the same times: late and
// missing ticks do not excuse another output. A skip where they cannot be judged: no tick, ticks
// beyond those that were kept, a decision of the law at its threshold before or at the first
// deviation. REQUIRES: a port without a fixed step. Takes the samples of `unit`.
void judge_outputs(const Case& the_case, LiveUnitRecord& unit, std::optional<int> fraction_bits,
                   CaseResult& result);

// A flight that the plant ended. It fails unless the outputs agree with the reference's to the end,
// or the reference loses the flight too, flown in simulation at the same times; then it is a skip.
// REQUIRES: the outputs were judged before, if they can be.
void judge_flight_end(const StressTask& task, const LiveFlight& flight, CaseResult& result);

// The figures of `stress` against the budget. A port fails for overruns, and for misses and late
// starts of its own (deadline_misses.hpp). What the machine adds to that is a skip.
void judge_timing(const RealtimeBudget& budget, StressResult& stress);

// What cannot be judged, with the reason.
void add_skip(CaseResult& result, const std::string& reason);

}  // namespace attest
