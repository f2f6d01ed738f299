// The report of `attest replay`. For machines:
//
//     {"schema": "attest-replay-1", "attest_version": "0.1.0", "port": "builtin",
//      "level": "numeric",
//      "log_limits": {"within": 1e-4, "least_part_within": 0.85, "most_unexplained": 0.02},
//      "results": [
//        {"file": "flight.ulg", "kind": "log", "module": "attitude_unit", "profile": "px4-v1.16.0",
//         "verdict": "pass", "reason": "", "ticks": 1000, "has_every_step": false,
//         "topics": [{"topic": "vehicle_rates_setpoint", "judged": true, "not_judged": "",
//                     "agrees": true, "logged": 1000, "paired": 500, "left_out": 0, "within": 500,
//                     "between_samples": 0, "unexplained": 0, "missing": 0, "non_finite": 0,
//                     "median": 0, "p90": 0, "p99": 0, "largest": 0}],
//         "notes": ["logged by PX4 v1.16.0"]}]}
//
// A log of v1.14 to v1.18 has an entry for each of its two units. A sample is unexplained if it is
// outside the limit and not "between_samples" (compare/log_agreement.hpp). A topic with such a
// sample has the member "first_unexplained": tick, timestamp_us, channel, got, logged. An entry of
// the kind "trace" has, in place of has_every_step, topics and notes, the members deviating_ticks,
// first, worst and tightest of the report of a run (report.schema.json). A judged log has
// "not_judged": [{"what": "actuator_controls_0", "why": "it depends on ..."}], the outputs that did
// not decide. A log that passes has "pass_means", a text for people.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "harness/report/document.hpp"
#include "harness/trace/module.hpp"
#include "harness/ulog/flight_log.hpp"
#include "harness/verify/evaluate_log.hpp"
#include "harness/verify/verdict.hpp"

namespace attest {

// What a pass by a log says, and the command that lists the mistakes that the log shows.
std::string meaning_of_pass(const std::string& log);

// Outputs of a judged unit that did not decide its verdict.
struct NotJudged {
  std::string what;  // "actuator_controls_0", "vehicle_torque_setpoint.xyz[2]"
  std::string why;

  bool operator==(const NotJudged&) const = default;
};
std::vector<NotJudged> not_judged_in(const LoggedUnit& unit, const LogResult& result);

// The same of entries of the report of `replay`: "not judged: actuator_controls_0 (it depends on
// ...)", each output once. Empty if all outputs were judged.
std::string not_judged_text(const std::vector<nlohmann::ordered_json>& entries);

// "flight.ulg"; for a unit of v1.14 to v1.18 "flight.ulg: attitude unit".
std::string title_of(const LoggedUnit& log);

// The samples of the topic in the log. A topic may be judged in parts.
const LoggedOutput& output_of(const LoggedUnit& unit, std::string_view topic);

// The agreement of each topic of a unit. The lines below the table say how many of the deviations
// are explained.
DocumentTable unit_table(const LoggedUnit& unit, const LogResult& result, const LogLimits& limits);

// A port compared with a log: the agreement of each unit, and a plot of each output of port and
// log. REQUIRES: a result for each unit.
Document log_document(const FlightLog& log, const std::vector<LogResult>& results,
                      const LogLimits& limits, const std::string& port);

// A port compared with a trace: the first and the worst deviation, and a plot of each output of
// port and trace.
Document trace_document(const Trace& want, const Trace& got, const VectorResult& result,
                        const std::string& port);

nlohmann::ordered_json json_of_trace(const VectorResult& result, Module module);
// REQUIRES: `result` is that of `unit`, which is a unit of `log`.
nlohmann::ordered_json json_of_unit(const FlightLog& log, const LoggedUnit& unit,
                                    const LogResult& result, const LogLimits& limits);

// `results`: values of json_of_trace() and json_of_unit().
std::string replay_json(const std::string& port, std::string_view level, const LogLimits& limits,
                        const std::vector<nlohmann::ordered_json>& results);

}  // namespace attest
