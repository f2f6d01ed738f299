// Makes a case of a part of a flight's log, or of a trace. The inputs become signals of the kind
// `samples`.
#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "harness/core/rate.hpp"
#include "harness/core/result.hpp"
#include "harness/trace/trace.hpp"

namespace attest {

// Times since the first step of the unit in the log.
struct LogPart {
  double from_s = 0;                                      // included
  double to_s = std::numeric_limits<double>::infinity();  // not included; infinite: to the end
};

inline constexpr const char* log_case_group = "from_log";

struct LogCase {
  std::string name;         // of the log and the part: "gust", "gust_1_5s_to_3s"
  std::string toml;         // the case file, as in SCHEMA.md
  std::string step_topic;   // "control_state"
  std::size_t samples = 0;  // of the step_topic
  double duration_s = 0;
};

// `log` has a tick for each step of the unit (ulog/flight_log.hpp). The case begins at the first
// tick of the part, with the timestamp of that tick, and ends one mean period after the last tick.
// A sample of a topic other than step_topic is published at the tick that first received it in the
// log. Samples received before the part are published at the first tick. At the times of the log's
// ticks, a unit receives the values of the log, to the bit. Parameters that `profile` does not have
// are left out. quat_reset_counter counts from the first tick of the part. `notes` are added to the
// case's `why`.
//
// Errors: a log or a part with fewer than two ticks; a part that is empty or not in the log; a part
// with too many ticks for a case (max_ticks) at the fastest rate.
Result<LogCase> case_of_log(const Trace& log, const std::string& profile, const LogPart& part,
                            const std::vector<std::string>& notes);

// What a case of a trace says in addition to its inputs.
struct TraceCase {
  std::string profile, group, why;
  Rate rate = Rate::hz(250);
  std::string rates_why;
  bool exact_only = false;
  std::string mixer = {};  // only for Module::mixer: its definition
};

// The text of a case that gives a module exactly the inputs of `trace`, at `about.rate`. Values
// that are the baseline are left out. REQUIRES: each tick of the trace is at a multiple of the
// period, rounded down to whole microseconds; a topic changes only at a tick that has its bit.
std::string case_of_trace(const Trace& trace, const TraceCase& about);

}  // namespace attest
