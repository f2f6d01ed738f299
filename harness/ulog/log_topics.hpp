// The channels of a module as topics and fields of a log. Logs are written and read by this table.
//
// Topics and fields have the names of the channels, which are PX4's, with two exceptions. A field
// that a topic of PX4 does not have, because it is a state of another field there, is logged in
// both forms. A `timestamp` of a topic is the field timestamp_published in a log of attest, where
// `timestamp` is the time of the step.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "harness/trace/channels.hpp"

namespace attest {

// What a topic of PX4 has instead of a flag: a field that is `if_true` or has other values.
struct LogState {
  std::string_view field;
  std::uint8_t if_true, if_false;  // as PX4 and attest write it
};

struct LogField {
  std::size_t channel;  // index into channels()
  std::string name;     // "q[0]"
  std::optional<LogState> state = {};
  float if_absent = 0;  // what a unit receives if the log's topic does not have it

  // True for "timestamp_published", whose name in a log of PX4 is "timestamp", and for
  // "timestamp_sample", which is about the same time.
  bool is_time_of_topic() const;
};

struct LogTopic {
  std::string name;
  bool is_output = false;
  // The instance in a log of attest. Where a module publishes a topic that it also reads, the
  // instance 0 is its own and the instance 1 that of others. PX4 has both in the instance 0.
  std::uint8_t multi_id = 0;
  std::vector<LogField> fields = {};
  std::optional<std::size_t> is_new = {};  // channel of its bit or flag; empty: new at each step
};

// In the order of the channels. The topic `parameter_update` has no fields. REQUIRES: the module
// has updated bits (ModuleInfo::has_updated).
std::vector<LogTopic> log_topics(Module module);

// The input that is new at each step: "vehicle_attitude". REQUIRES: as above.
std::string step_topic(Module module);

}  // namespace attest
