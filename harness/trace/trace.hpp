// A recorded run: what the unit was given at each tick and what it answered.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "harness/trace/channels.hpp"

namespace attest {

// Parameters in force from a tick on. A change at tick 0 is made before the first step; one at a
// later tick belongs to a sample whose PARAMETER_UPDATE bit is set.
struct ParameterChange {
  std::size_t tick;
  std::string name;
  float value;

  friend bool operator==(const ParameterChange&, const ParameterChange&) = default;
};

struct Trace {
  std::string source;                       // file or case, for messages
  std::vector<Sample> samples;              // one a tick, timestamps strictly increasing
  std::vector<ParameterChange> parameters;  // by tick, then in the order they are set
  ChannelSet present;                       // the channels that were recorded; the others are 0
};

}  // namespace attest
