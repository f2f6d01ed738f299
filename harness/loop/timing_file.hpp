// The times of a loop as a file: measured in a stress run, to be flown again in simulation.
//
//     {"attest_timing": 1, "case": "px4-v1.5.5/flight/hover", "case_sha256": "...", "rate": "1000",
//      "vehicle": "iris", "plant": "mujoco", "duration_s": 10,
//      "ticks_ns": [[0, 8113, 1000000], [0, 1009001, null], ...]}
//
// A tick is [sampled, begins, commanded] as in LoopTick; `commanded` is null where the outputs of
// the tick were never used. A flight of the cascade has its pair as rate, "250:1000", and the ticks
// of its attitude unit as "attitude_ticks_ns".
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>

#include "harness/casefile/case.hpp"
#include "harness/core/file.hpp"
#include "harness/core/loop_timing.hpp"
#include "harness/core/result.hpp"

namespace attest {

struct TimingFile {
  std::string case_id;
  std::string case_sha256;
  RunConfiguration configuration;
  double duration_s = 0;
  FlightTiming ticks;
};

// Errors, with the file: it cannot be read or written; it is not a timing file; its times decrease
// (with the tick).
Result<TimingFile> read_timing(const std::filesystem::path& path);
Result<void> write_timing(const TimingFile& timing, AtomicFile file);
// The same for the path of a file.
Result<void> write_timing(const TimingFile& timing, const std::filesystem::path& path);

// The first tick that does not follow the one before it as LoopTiming requires. Ticks have to be at
// least 1 us apart, because timestamps are whole microseconds.
std::optional<std::size_t> first_disorder(const LoopTiming& timing);

// The case as the recorded flight flew it: with the duration of the timing, and without metrics
// whose windows begin after it. REQUIRES: `timing` was recorded with this case.
Case with_timing(Case the_case, const TimingFile& timing);

}  // namespace attest
