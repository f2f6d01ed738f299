// A log of a flight as a trace: what the controller was given, and what it answered.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "harness/core/result.hpp"
#include "harness/trace/trace.hpp"

namespace attest {

// What is assumed of a flight whose log has no sample of a topic. The words of --assume.
struct FlightAssumption {
  std::string_view word;     // "armed"
  std::string_view channel;  // that is 1: "in/actuator_armed.armed"
  bool by_default;
};
std::span<const FlightAssumption> flight_assumptions();

// The samples of a topic of outputs.
struct LoggedOutput {
  std::string topic;
  std::size_t samples = 0;
  std::size_t paired = 0;  // of these, with a tick
};

struct FlightLog {
  // A tick for each sample of control_state, at its timestamp. An input is the last sample logged
  // at that time or before. A tick has an output, with `published` 1, if the log has the answer to
  // its control_state. A tick without one has the values of the tick before.
  // An output that the log's topic does not have is not in `trace.present`.
  Trace trace;
  std::vector<LoggedOutput> outputs;
  // The log has every step of the controller. Otherwise outputs that depend on earlier steps (the
  // integral, the derivative) cannot be computed from it.
  bool has_every_step = false;
  std::string profile;  // of the case, in a log of attest; else empty
  bool is_of_attest =
      false;  // attest wrote the log: at each step, all that the controller received
  // Of the log, assumptions and omissions: one line each.
  std::vector<std::string> notes;
};

// Reads a ULog. Its parameters are in the trace, those of other modules too.
//
// An output is paired with the control_state whose timestamp is its `timestamp_sample`, where the
// topic has this field. Otherwise it is the answer to the last control_state before it, and a
// further output before the next control_state is not paired.
//
// `assumed` are words of flight_assumptions(); empty: those by default, none in a log of attest.
// They apply to topics without a sample in the log. Memory: the samples of the topics that the
// controller reads or publishes. Errors: the file cannot be read or is no ULog; it has no sample of
// control_state, of vehicle_attitude_setpoint or of any output, or lacks a field that the law
// reads; an unknown word, or one for a topic that the log has.
Result<FlightLog> read_flight_log(const std::filesystem::path& path,
                                  const std::vector<std::string>& assumed = {});

// By its name.
bool is_log(const std::filesystem::path& path);

}  // namespace attest
