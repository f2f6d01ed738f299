// One step of the reference against the same law written by hand in C (the C starter), and against
// the same law with the C library's elementary functions. All run through the ABI and come from the
// same compiler. The inputs are recorded from the firmware, with every mode, every tilt and
// parameter changes.
#include <benchmark/benchmark.h>

#include "benchmarks/host_functions.hpp"
#include "controller/attest_unit.h"
#include "controller/mc_att_control/mc_att_control_definition.hpp"
#include "controller/mc_att_control/unit.hpp"
#include "controller/mc_att_control/unit_table.hpp"
#include "harness/trace/csv.hpp"

extern "C" const attest_unit* attest_floor_unit(void);

namespace attest::bench {
namespace {

const Trace& recorded() {
  static const Trace trace =
      *read_csv(ATTEST_SOURCE_DIR "/golden/recorded/px4-v1.5.5/fuzz_250hz.csv", TraceNeed::inputs);
  return trace;
}

void step(benchmark::State& state, const attest_unit* unit) {
  const Trace& trace = recorded();
  void* self = unit->create("px4-v1.5.5");
  for (const ParameterChange& change : trace.parameters) {
    if (change.tick == 0) unit->set_parameter(self, change.name.c_str(), change.value);
  }
  attest_outputs out{};
  std::size_t tick = 0;
  for (auto _ : state) {
    unit->step(self, &trace.samples[tick].in, &out);
    benchmark::DoNotOptimize(out);
    tick = tick + 1 < trace.samples.size() ? tick + 1 : 0;
  }
  unit->destroy(self);
}

void reference_step(benchmark::State& state) { step(state, mc_att_control::mc_att_control_unit()); }
void by_hand_step(benchmark::State& state) { step(state, attest_floor_unit()); }
void host_functions_step(benchmark::State& state) {
  using Controller = mc_att_control::McAttControl<HostFloat>;
  static constexpr attest_unit unit = mc_att_control::UnitTable<Controller>::named("host", "1");
  step(state, &unit);
}

BENCHMARK(reference_step)->Name("step/reference");
BENCHMARK(by_hand_step)->Name("step/by_hand");
BENCHMARK(reference_step)->Name("elementary/controller_own");
BENCHMARK(host_functions_step)->Name("elementary/controller_host");

}  // namespace
}  // namespace attest::bench
