// Reads the log of a flight as traces: the inputs and the outputs of each unit.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "harness/core/result.hpp"
#include "harness/trace/trace.hpp"
#include "harness/trace/trace_parts.hpp"
#include "harness/ulog/assumptions.hpp"
#include "harness/ulog/log_contents.hpp"
#include "harness/ulog/step_gaps.hpp"

namespace attest {

// The number of samples of an output topic.
struct LoggedOutput {
  std::string topic;
  std::size_t samples = 0;      // published by this unit
  std::size_t paired = 0;       // of these, assigned to a tick
  std::size_t other_wings = 0;  // published by others, in fixed-wing flight or a transition to it
};

// Whether the log shows the setpoint that the unit follows at a tick.
enum class Known : std::uint8_t {
  all,            // yes
  if_every_step,  // only if it has every step: the unit filters the sticks to get the setpoint
  nothing         // no: the log has no setpoint, or no mode, up to this tick
};

// The setpoint that the unit follows at a tick, as far as the log shows it.
struct LoggedSetpoint {
  Known known = Known::all;
  std::uint64_t time_us = 0;  // of the last logged sample of the setpoint; 0: there is none
  bool is_own = false;        // of a single step: the unit made the setpoint from the sticks

  bool operator==(const LoggedSetpoint&) const = default;
};

// The ticks of a unit of a log, part by part.
class LoggedTicks : public TraceParts {
 public:
  // Of each tick of the part last read.
  const std::vector<LoggedSetpoint>& setpoints() const { return setpoints_; }

  // The changes of parameters in the parts; at first those of the log.
  void set_parameters(std::vector<ParameterChange> changes) { parameters_ = std::move(changes); }

 protected:
  std::vector<LoggedSetpoint> setpoints_;
  std::vector<ParameterChange> parameters_;
};

// What the single steps of a unit are, and which logged outputs are not among them.
struct SingleSteps {
  struct LeftOut {
    std::string why;
    std::size_t outputs = 0;
  };

  std::size_t with_own_setpoint = 0;    // steps whose setpoint the unit made from the sticks
  std::size_t with_given_setpoint = 0;  // the other steps
  // Set where the steps are judged: setpoints that were given are younger. 0: no limit is known.
  std::uint64_t oldest_us = 0;
  std::size_t logged = 0;         // outputs in the log: of rates, or of integrals
  std::vector<LeftOut> left_out;  // the other outputs
};

namespace ulog {
class SingleStepFinder;
}

struct LoggedUnit {
  Module module = Module::mc_att_control;
  std::string step_topic;  // "control_state"
  // A tick for each sample of the step topic, at its timestamp. An input is the last sample logged
  // before that time; in a log of attest, and of the controller of v1.5.5 and v1.3.4, also at that
  // time. If the log has an output of the tick, its `published` is 1. Otherwise the tick repeats
  // the output of the tick before. An output field that the log does not have is not in
  // `trace.present`. An input field that it does not have is there, as LogField::if_absent.
  Trace trace;
  std::vector<LoggedSetpoint> setpoints;  // of each tick
  // Unless null: the ticks, which are then neither in `trace` nor in `setpoints`.
  std::shared_ptr<LoggedTicks> ticks;
  std::vector<LoggedOutput> outputs;
  // True if nothing shows that the log lacks a step of the unit. For a log of v1.14 to v1.18, it
  // must also begin on the ground, with no input assumed. If false, outputs that depend on earlier
  // steps (the integral, the derivative) cannot be computed exactly from the log.
  bool has_every_step = false;
  bool begins_in_flight = false;  // then the unit's state at the first tick is not known
  double period_us = 0;  // of the loop, estimated; 0: not known, because the log does not limit it
  // For single_steps_of(): what it would find in the ticks. Null if it has to read them, because
  // the log was expected to judge the outputs that depend on earlier steps.
  std::shared_ptr<const ulog::SingleStepFinder> found_steps;
  // Set if the ticks are those of single_steps_of().
  std::optional<SingleSteps> single_steps;
  // Why the outputs that depend on earlier steps cannot be computed, even approximately. Empty if
  // they can be. If the log has too little for the unit, this says why, and the trace has no ticks.
  std::string not_judged;
};

struct FlightLog {
  // One: the controller, or the unit of a log that attest wrote. Two: the attitude unit and the
  // rate unit.
  std::vector<LoggedUnit> units;
  std::string too_little;  // why no unit has ticks; empty: at least one has
  std::string profile;     // in a log of attest, that of the case; else empty
  std::string no_profile;  // for the reader of `profile`: why there is none that attest knows
  std::optional<ulog::Release> release;  // of the PX4 that wrote it, if the log says so
  std::string branch;                    // of its source; empty: the log does not say it
  bool is_of_attest = false;  // if true, the log has all that the unit received at each step
  // Remarks for the user, one line each: for example on damage, missing fields and assumptions.
  std::vector<std::string> notes;

  // Whether it can be judged like a trace: attest wrote it, with the outputs of all steps.
  bool is_like_trace() const {
    return is_of_attest && units.front().has_every_step && too_little.empty();
  }
};

// Reads a ULog: of the controller, if it has samples of control_state, else of the units of v1.14
// to v1.16. All parameters of the log are in the traces, those of other modules too.
//
// An output topic with the field `timestamp_sample` is paired with the earlier step whose sample
// has this time. Any other output is paired with the last step that is not after it; in a log of
// v1.14 to v1.18 only if that step is at most 2 ms earlier, because the log may lack a later step.
// Not paired: a second output of the same step, and an output that is logged 1000 steps after its
// own.
//
// In a log of v1.14 to v1.18, several modules publish the setpoints, depending on the mode:
// - vehicle_attitude_setpoint is an output of the attitude unit if the unit makes it from the
//   sticks, else an input of this unit.
// - vehicle_rates_setpoint is an output of the attitude unit in modes with attitude control. It is
//   an output of the rate unit in acro mode, else an input of this unit.
// quat_reset_counter counts from the first sample on, because a unit that starts there knows of no
// earlier reset.
//
// `assumed` has some of assumption_words(). If it is empty, the default words are used; for a log
// of attest, none. The words apply to topics without a sample in the log. Errors: the file cannot
// be read or is not a ULog; it has no data; those of check_assumed().
//
// Not `whole`: with LoggedUnit::ticks, which read the file again. They keep the samples of a short
// time, so their memory does not grow with the log; it grows with the time by which samples are out
// of order in the file.
Result<FlightLog> read_flight_log(const std::filesystem::path& path,
                                  const std::vector<std::string>& assumed = {}, bool whole = true);

// The ticks of the unit, from the first one on. REQUIRES: the unit outlives them, and has ticks.
std::shared_ptr<LoggedTicks> ticks_of(const LoggedUnit& unit);

}  // namespace attest
