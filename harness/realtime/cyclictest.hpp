// Wake-up latencies of the idle machine, measured by cyclictest (rt-tests). They are an independent
// check of those that attest measures (idle_latency()).
#pragma once

#include <functional>
#include <optional>

#include "harness/core/rate.hpp"
#include "harness/core/time.hpp"
#include "harness/realtime/live_flight.hpp"

namespace attest {

struct Cyclictest {
  Nanoseconds median{0};  // interpolated within the 1 us bins of cyclictest
  Nanoseconds max{0};
  std::int64_t cycles = 0;
};

// Runs cyclictest on the unit's CPU with the unit's scheduler. Empty when cyclictest is not
// installed, failed, printed other text, did not end within 10 s after `duration`, or `stop` became
// true.
std::optional<Cyclictest> run_cyclictest(const Rate& rate, Nanoseconds duration,
                                         const LiveOptions& options,
                                         const std::function<bool()>& stop);

// Parses the output of cyclictest with --json. Empty for other text.
std::optional<Cyclictest> parse_cyclictest(const std::string& json);

}  // namespace attest
