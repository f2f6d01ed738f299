// A schedule as text: each task's response times, and the delays of each unit.
#pragma once

#include <string>

#include "harness/casefile/task_set.hpp"
#include "harness/schedule/loop_timing.hpp"
#include "harness/verify/verdict.hpp"

namespace attest {

// One row per task: analysed and simulated longest response. A response longer than the period is
// marked.
std::string render_tasks(const TaskSet& set, const std::vector<std::vector<TaskJob>>& jobs);

// Of each unit: the delays after the release, until its start and until its command (its setpoint,
// of the attitude unit), and the age of the sample at that time.
std::string render_delays(const TaskSet& set, const std::vector<std::vector<TaskJob>>& jobs,
                          const FlightTiming& timing);

// The metrics of a flight with that timing, compared with the same flight with every tick in time.
std::string render_flights(const CaseResult& in_time, const CaseResult& scheduled);

}  // namespace attest
