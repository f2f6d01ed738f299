// A schedule as text: each task's response times, and the delays of each unit.
#pragma once

#include <string>

#include "harness/casefile/task_set.hpp"
#include "harness/core/loop_timing.hpp"
#include "harness/verify/verdict.hpp"

namespace attest {

// One row per task, with its longest response as analysed and as simulated. A simulated response
// longer than the period is marked.
std::string render_tasks(const TaskSet& set, const std::vector<std::vector<TaskJob>>& jobs);

// For each unit: the delays from the release to the start and to the command, and the age of the
// sample at the command. For the attitude unit, the setpoint takes the place of the command.
std::string render_delays(const TaskSet& set, const std::vector<std::vector<TaskJob>>& jobs,
                          const FlightTiming& timing);

// The metrics of the scheduled flight, compared with the same flight with every tick in time.
std::string render_flights(const VectorResult& in_time, const VectorResult& scheduled);

}  // namespace attest
