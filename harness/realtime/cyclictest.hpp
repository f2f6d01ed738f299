// The idle machine as cyclictest (rt-tests) sees it: a judge of our own pacer.
#pragma once

#include <functional>
#include <optional>

#include "harness/core/time.hpp"
#include "harness/realtime/live_flight.hpp"
#include "harness/schedule/rate.hpp"

namespace attest {

struct Cyclictest {
  Nanoseconds median{0};  // within its bins of 1 us taken as evenly spread
  Nanoseconds max{0};
  std::int64_t cycles = 0;
};

// On the unit's CPU, with its scheduler. Empty when it is not installed, failed, printed something
// else, did not end some seconds after `duration`, or `stop` became true.
std::optional<Cyclictest> run_cyclictest(const Rate& rate, Nanoseconds duration,
                                         const LiveOptions& options,
                                         const std::function<bool()>& stop);

// What it prints with --json. Empty when it is not that.
std::optional<Cyclictest> parse_cyclictest(const std::string& json);

}  // namespace attest
