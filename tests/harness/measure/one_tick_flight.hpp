// A live flight of one tick, as measured, and the times that are written of it.
#pragma once

#include <utility>

#include "harness/loop/timing_file.hpp"
#include "harness/measure/stress.hpp"
#include "tests/harness/core/temporary_directory.hpp"
#include "tests/harness/times.hpp"

namespace attest {

inline LiveTick one_tick() {
  LiveTick tick;
  tick.sampled = us(1);
  tick.begins = us(2);
  return tick;
}

// The motors follow the tick's command from `commanded` on.
inline StressMeasurement one_tick_flight(Nanoseconds commanded) {
  StressMeasurement measured;
  measured.flight.emplace();
  measured.flight->unit.ticks = {one_tick()};
  measured.flight->plant.commanded = {commanded};
  return measured;
}

inline Result<TimingFile> written_times(StressTask task, StressMeasurement measured) {
  const TemporaryDirectory directory;
  const auto path = directory.path() / "timing.json";
  task.record_timing = std::make_shared<AtomicFile>(*AtomicFile::open(path));
  const auto judged = judge_live(task, std::move(measured));
  return judged ? read_timing(path) : tl::unexpected(judged.error());
}

}  // namespace attest
