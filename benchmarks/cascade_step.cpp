// One step of each unit of the cascade against the same law written by hand in C (its starter), and
// a step of the attitude unit against the same law with the C library's elementary functions. All
// run through the ABI and come from the same compiler. The inputs are recorded from the firmware,
// with every mode, every tilt and parameter changes.
#include <benchmark/benchmark.h>

#include "benchmarks/host_functions.hpp"
#include "controller/attest_cascade.h"
#include "controller/cascade/attitude_unit_definition.hpp"
#include "controller/cascade/unit.hpp"
#include "controller/cascade/unit_table.hpp"
#include "harness/trace/csv.hpp"

extern "C" const attest_unit* attest_cascade_floor_unit(void);

namespace attest::bench {
namespace {

Trace recorded(const char* name) {
  const std::string folder = ATTEST_SOURCE_DIR "/golden/recorded/px4-v1.16.0/";
  return *read_csv(folder + name, TraceNeed::inputs);
}

template <typename In, typename Table, typename Out>
void step(benchmark::State& state, const Table& table, const Trace& trace, Out out) {
  const Block& in = info_of(module_of(trace.present)).in;
  void* self = table.create("px4-v1.16.0");
  for (const ParameterChange& change : trace.parameters) {
    if (change.tick == 0) table.set_parameter(self, change.name.c_str(), change.value);
  }
  std::size_t tick = 0;
  for (auto _ : state) {
    table.step(self, static_cast<const In*>(in.in(trace.samples[tick])), &out);
    benchmark::DoNotOptimize(out);
    tick = tick + 1 < trace.samples.size() ? tick + 1 : 0;
  }
  table.destroy(self);
}

const attest_attitude_unit& attitude_of(const attest_unit* unit) {
  return *static_cast<const attest_attitude_unit*>(unit->extension(ATTEST_EXTENSION_ATTITUDE_UNIT));
}

const attest_rate_unit& rate_of(const attest_unit* unit) {
  return *static_cast<const attest_rate_unit*>(unit->extension(ATTEST_EXTENSION_RATE_UNIT));
}

void attitude(benchmark::State& state, const attest_attitude_unit& unit) {
  static const Trace trace = recorded("fuzz_250hz.attitude.csv");
  step<attest_attitude_inputs>(state, unit, trace, attest_attitude_outputs{});
}

void rate(benchmark::State& state, const attest_unit* unit) {
  static const Trace trace = recorded("fuzz_1000hz.rate.csv");
  step<attest_rate_inputs>(state, rate_of(unit), trace, attest_rate_outputs{});
}

void attitude_step(benchmark::State& state) {
  attitude(state, attitude_of(cascade::cascade_unit()));
}
void attitude_by_hand(benchmark::State& state) {
  attitude(state, attitude_of(attest_cascade_floor_unit()));
}
void attitude_with_host_functions(benchmark::State& state) {
  using Unit = cascade::AttitudeUnit<HostFloat>;
  attitude(state, cascade::UnitTable<attest_attitude_unit, Unit, attest_attitude_inputs,
                                     attest_attitude_outputs>::table);
}
void rate_step(benchmark::State& state) { rate(state, cascade::cascade_unit()); }
void rate_by_hand(benchmark::State& state) { rate(state, attest_cascade_floor_unit()); }

BENCHMARK(attitude_step)->Name("cascade/attitude");
BENCHMARK(attitude_by_hand)->Name("cascade/attitude_by_hand");
BENCHMARK(attitude_step)->Name("elementary/attitude_own");
BENCHMARK(attitude_with_host_functions)->Name("elementary/attitude_host");
BENCHMARK(rate_step)->Name("cascade/rate");
BENCHMARK(rate_by_hand)->Name("cascade/rate_by_hand");

}  // namespace
}  // namespace attest::bench
