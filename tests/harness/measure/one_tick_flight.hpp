// A live flight of one tick, as measured, and the times that are written of it.
#pragma once

#include <utility>

#include "harness/loop/timing_file.hpp"
#include "harness/measure/stress.hpp"
#include "tests/harness/core/temporary_directory.hpp"
#include "tests/harness/times.hpp"

namespace attest {

// The tick's outputs are used from `commanded` on.
inline LiveTick one_tick(Nanoseconds commanded) {
  LiveTick tick;
  tick.sampled = us(1);
  tick.begins = us(2);
  tick.commanded = commanded;
  return tick;
}

inline LiveFlight one_tick_flight(Nanoseconds commanded) {
  LiveFlight flight;
  flight.unit.ticks = {one_tick(commanded)};
  return flight;
}

inline Result<TimingFile> written_times(StressTask task, LiveFlight flight) {
  const TemporaryDirectory directory;
  const auto path = directory.path() / "timing.json";
  task.record_timing = std::make_shared<AtomicFile>(*AtomicFile::open(path));
  const auto judged = judge_live(task, {}, std::move(flight));
  return judged ? read_timing(path) : tl::unexpected(judged.error());
}

}  // namespace attest
