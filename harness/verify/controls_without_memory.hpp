// Finds the controls of a log that can be judged although the log lacks steps.
#pragma once

#include <string>

#include "harness/trace/channels.hpp"
#include "harness/ulog/flight_log.hpp"
#include "harness/verify/replayed_log.hpp"

namespace attest {

// The controls of mc_att_control that depend on earlier steps by their integral only: not those of
// an axis with a D term, nor in v1.3.4 of one with feed-forward, which is of the change of the
// setpoint there.
struct ControlsWithoutMemory {
  ChannelSet channels;    // empty if there is no such axis
  std::string condition;  // such as "yaw and thrust, while the integrals are 0"

  ControlsWithoutMemory(const LoggedUnit& log, const std::string& profile,
                        const LogParameters& parameters);
};

}  // namespace attest
