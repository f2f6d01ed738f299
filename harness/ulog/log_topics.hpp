// The channels of a module as topics and fields of a log. Logs are written and read by this table.
//
// Topics and fields have the names of the channels, which are PX4's, with two exceptions:
// - A flag may be a state of another field in PX4: `vehicle_status.armed` is a value of
//   arming_state. attest logs such a flag in both forms.
// - The channel `timestamp` of a topic is the field timestamp_published in a log of attest, because
//   the field `timestamp` has the time of the step there.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "harness/trace/channels.hpp"

namespace attest {

// A field of a PX4 topic that stands for a flag: the flag is true if the field is `if_true`.
struct LogState {
  std::string_view field;
  std::uint8_t if_true, if_false;  // attest writes one of these two values
};

struct LogField {
  std::size_t channel;  // index into channels()
  std::string name;     // "q[0]"
  std::optional<LogState> state = {};
  float if_absent = 0;  // the unit's input if the log's topic lacks the field

  // True for the fields for which the topic's `timestamp` is used if the log lacks them:
  // "timestamp_published", which is the `timestamp` of a log of PX4, and "timestamp_sample", which
  // is about the same time.
  bool is_time_of_topic() const;
};

struct LogTopic {
  std::string name;
  bool is_output = false;
  // The instance in a log of attest. If a module publishes a topic that it also reads, it publishes
  // instance 0, and other modules publish instance 1. PX4 has both in instance 0.
  std::uint8_t multi_id = 0;
  std::vector<LogField> fields = {};
  std::optional<std::size_t> is_new = {};  // its updated bit or published flag; empty: always new
};

// In the order of the channels. The topic `parameter_update` has no fields. REQUIRES: a unit.
std::vector<LogTopic> log_topics(Module module);

}  // namespace attest
