// A schedule as text: each task's response times, and the delays of the loop.
#pragma once

#include <string>

#include "harness/casefile/task_set.hpp"
#include "harness/schedule/loop_timing.hpp"
#include "harness/verify/verdict.hpp"

namespace attest {

// One row per task: analysed and simulated longest response. A response longer than the period is
// marked.
std::string render_tasks(const TaskSet& set, const std::vector<std::vector<TaskJob>>& jobs);

// The delays of starts and commands after the release, and the sample ages at the commands.
std::string render_delays(const std::vector<TaskJob>& unit, const LoopTiming& timing);

// The metrics of a flight with that timing, compared with the same flight with every tick in time.
std::string render_flights(const CaseResult& in_time, const CaseResult& scheduled);

}  // namespace attest
