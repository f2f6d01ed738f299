// A schedule for people: each task's responses, and what the loop feels of them.
#pragma once

#include <string>

#include "harness/casefile/task_set.hpp"
#include "harness/schedule/loop_timing.hpp"
#include "harness/verify/verdict.hpp"

namespace attest {

// One row a task: analysed and simulated longest response. A response longer than the period is
// marked.
std::string render_tasks(const TaskSet& set, const std::vector<std::vector<TaskJob>>& jobs);

// How late ticks begin and commands come, and how old the samples are that they rest on.
std::string render_delays(const std::vector<TaskJob>& unit, const LoopTiming& timing);

// The metrics of a flight with that timing beside the same flight with every tick in time.
std::string render_flights(const CaseResult& in_time, const CaseResult& scheduled);

}  // namespace attest
