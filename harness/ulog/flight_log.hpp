// Reads the log of a flight as traces: the inputs and the outputs of each unit.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "harness/core/result.hpp"
#include "harness/trace/trace.hpp"
#include "harness/ulog/assumptions.hpp"
#include "harness/ulog/log_contents.hpp"
#include "harness/ulog/step_gaps.hpp"

namespace attest {

// The samples of a topic of outputs.
struct LoggedOutput {
  std::string topic;
  std::size_t samples = 0;  // of this unit
  std::size_t paired = 0;   // of these, with a tick
};

// Whether the log shows the setpoint that the unit follows at a tick.
enum class Known : std::uint8_t {
  all,            // yes
  if_every_step,  // if the log has every step: the unit filters the sticks to get the setpoint
  nothing         // no: the log has no setpoint up to this tick
};

struct LoggedUnit {
  Module module = Module::mc_att_control;
  std::string step_topic;  // "control_state"
  // A tick for each sample of the step topic, at its timestamp. An input is the last sample logged
  // before that time; in a log of attest, and of the controller of v1.5.5 and v1.3.4, also at that
  // time. If the log has an output of the tick, its `published` is 1. Otherwise the tick repeats
  // the output of the tick before. A field that the log's topic does not have is not in
  // `trace.present`.
  Trace trace;
  std::vector<LoggedOutput> outputs;
  std::vector<Known> known;  // of each tick
  // The log has every step of the unit. A log of v1.14 to v1.16 also begins on the ground, and no
  // input was assumed. Otherwise outputs that depend on earlier steps (the integral, the
  // derivative) cannot be computed from the log.
  bool has_every_step = false;
  bool begins_in_flight = false;  // so the state of the unit at the first tick is not known
  // Why the outputs that depend on earlier steps cannot be computed, even approximately. Empty if
  // they can. If the log has too little for the unit, this is not empty, and the trace has no
  // ticks.
  std::string not_judged;
};

struct FlightLog {
  // One: the controller, or the unit of a log that attest wrote. Two: the attitude unit and the
  // rate unit. At least one has ticks.
  std::vector<LoggedUnit> units;
  std::string profile;                   // of the case, in a log of attest; else empty
  std::optional<ulog::Release> release;  // of the PX4 that wrote it, if the log says so
  bool is_of_attest = false;  // attest wrote the log: at each step, all that the unit received
  // Remarks for the user, one line each: for example on damage, missing fields and assumptions.
  std::vector<std::string> notes;
};

// Reads a ULog: of the controller, if it has the topic control_state, else of the units of v1.14 to
// v1.16. Its parameters are in the traces, those of other modules too.
//
// An output is paired with the step whose sample has its `timestamp_sample`, where the topic has
// this field. Otherwise it is paired with the last step before it; in a log of v1.14 to v1.16 only
// if that step is at most 2 ms before it, because the log may lack a later step. A second output
// before the next step is not paired.
//
// In a log of v1.14 to v1.16, several modules publish the setpoints, depending on the mode. Outputs
// of the attitude unit are vehicle_rates_setpoint in modes with attitude control, and
// vehicle_attitude_setpoint where the unit makes it from the sticks; otherwise the latter is an
// input of the unit. vehicle_rates_setpoint is an output of the rate unit in acro mode, and
// otherwise an input. quat_reset_counter counts from the first sample on, because a unit that
// starts there knows of no earlier reset.
//
// `assumed` are some of assumption_words(); empty: those by default, none in a log of attest.
// They apply to topics without a sample in the log. Errors: the file cannot be read or is no ULog;
// it has too little for any unit; an unknown word, or one for a topic that the log has.
Result<FlightLog> read_flight_log(const std::filesystem::path& path,
                                  const std::vector<std::string>& assumed = {});

// Whether the name is that of a log.
bool is_log(const std::filesystem::path& path);

}  // namespace attest
