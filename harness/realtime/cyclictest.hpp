// The idle machine as measured by cyclictest (rt-tests): an independent check of our own pacer.
#pragma once

#include <functional>
#include <optional>

#include "harness/core/time.hpp"
#include "harness/realtime/live_flight.hpp"
#include "harness/schedule/rate.hpp"

namespace attest {

struct Cyclictest {
  Nanoseconds median{0};  // interpolated within its bins of 1 us
  Nanoseconds max{0};
  std::int64_t cycles = 0;
};

// On the unit's CPU, with its scheduler. Empty when it is not installed, failed, printed something
// else, did not end some seconds after `duration`, or `stop` became true.
std::optional<Cyclictest> run_cyclictest(const Rate& rate, Nanoseconds duration,
                                         const LiveOptions& options,
                                         const std::function<bool()>& stop);

// Parses its output with --json. Empty when the text is something else.
std::optional<Cyclictest> parse_cyclictest(const std::string& json);

}  // namespace attest
