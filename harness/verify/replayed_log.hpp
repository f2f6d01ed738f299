// Gives the inputs of a unit of a log to a port, and to the reference.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "harness/core/result.hpp"
#include "harness/host/port_host.hpp"
#include "harness/ulog/flight_log.hpp"

namespace attest {

// The parameters of a unit in a log. Those that it does not have in its profile are left out.
struct LogParameters {
  std::vector<ParameterChange> of_port;   // the log's; those of `given` take the place of the log's
  std::vector<ParameterChange> as_flown;  // the log's; those of `given` that the log does not have

  LogParameters(const LoggedUnit& log, const ModuleUnderTest& subject,
                const std::vector<ParameterChange>& given);
};

// An instance of a port that gets the inputs of a log part by part. REQUIRES: `host` and
// `parameters` outlive it.
class ReplayedPort {
 public:
  ReplayedPort(PortHost& host, ModuleUnderTest subject,
               const std::vector<ParameterChange>& parameters)
      : host_(host), subject_(std::move(subject)), parameters_(parameters) {}

  // The inputs of a part, without outputs.
  Trace inputs(const Trace& logged, std::size_t first_tick) const;

  // Adds the outputs. The instance is made for the first part, and ends with the last.
  std::optional<PortFault> answer(Trace& inputs, std::size_t first_tick, bool is_last) {
    subject_.part = {first_tick, is_last};
    return host_.drive(subject_, inputs);
  }

 private:
  PortHost& host_;
  ModuleUnderTest subject_;
  const std::vector<ParameterChange>& parameters_;
};

// Calls for_each_part() from the first tick on.
template <typename Take>
Result<std::size_t> for_each_part_of(LoggedTicks& ticks, std::size_t most_ticks, Take take) {
  return ticks.rewind().and_then([&] { return for_each_part(ticks, most_ticks, take); });
}

}  // namespace attest
