// A flight against its unavoidable part: the same steps of MuJoCo on the same model, with the same
// rotor commands read from memory.
#include <chrono>
#include <map>
#include <memory>
#include <vector>

#include <benchmark/benchmark.h>
#include <mujoco/mujoco.h>

#include "harness/casefile/parse.hpp"
#include "harness/loop/case_timing.hpp"
#include "harness/loop/closed_loop.hpp"
#include "harness/loop/flight.hpp"
#include "harness/plant/plant.hpp"
#include "harness/port/port.hpp"

namespace attest::bench {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int physics_hz = 1000;

struct Flying {
  Case the_case = *parse_case(ATTEST_SOURCE_DIR "/cases/px4-v1.5.5/flight/tilt_step_30.toml");
  std::shared_ptr<const VehicleModel> iris =
      *VehicleModel::load(ATTEST_SOURCE_DIR "/models", "iris");
  std::unique_ptr<Port> port = *open_port("builtin");

  RunConfiguration configuration(int hertz) const {
    return {Rate::hz(hertz), PlantConfiguration{"iris", PlantKind::mujoco}};
  }
};

const Flying& flying() {
  static const Flying all;
  return all;
}

void flight(benchmark::State& state, int hertz, bool keep_trace) {
  const Flying& f = flying();
  const Case scripted = bound_to_vehicle(f.the_case, f.iris->vehicle());
  for (auto _ : state) {
    const auto plant = *plant_for(f.the_case, f.configuration(hertz), *f.iris);
    const auto unit = f.port->create("px4-v1.5.5");
    ClosedLoop loop(scripted, Rate::hz(hertz), case_timing(scripted, Rate::hz(hertz)),
                    f.iris->vehicle(), *plant, *unit);
    Trace trace;
    trace.samples.reserve(static_cast<std::size_t>(3 * hertz));
    trace.plant.reserve(static_cast<std::size_t>(3 * hertz));
    const auto begin = Clock::now();
    benchmark::DoNotOptimize(loop.run(keep_trace ? &trace : nullptr));
    state.SetIterationTime(std::chrono::duration<double>(Clock::now() - begin).count());
  }
}

// The commanded rotor speeds [rad/s], four a tick.
std::vector<double> commands(int hertz) {
  const Flying& f = flying();
  const auto unit = f.port->create("px4-v1.5.5");
  const auto flown = *fly(f.the_case, f.configuration(hertz), *f.iris, *unit);
  std::vector<double> all;
  for (const PlantSample& sample : flown.trace.plant) {
    for (std::size_t i = 0; i < 4; ++i) {
      all.push_back((static_cast<double>(sample.motor[i]) + 1) / 2 *
                    f.iris->vehicle().rotor_max_rad_s);
    }
  }
  return all;
}

void bare_steps(benchmark::State& state, int hertz) {
  static std::map<int, std::vector<double>> flown;  // kept, so that later turns start fast
  if (!flown.contains(hertz)) flown[hertz] = commands(hertz);  // installs MuJoCo's callbacks too
  const std::vector<double>& all = flown[hertz];
  mjModel* model = mj_loadXML(ATTEST_SOURCE_DIR "/models/iris.xml", nullptr, nullptr, 0);
  mjData* data = mj_makeData(model);
  for (auto _ : state) {
    mj_resetData(model, data);
    mju_copy(data->userdata, flying().iris->vehicle().drag_kg_s.data(), 3);
    for (int i = 0; i < 4; ++i) data->act[i] = flying().iris->vehicle().hover_rotor_rad_s();
    const auto begin = Clock::now();
    for (std::size_t tick = 0; tick + 4 < all.size(); tick += 4) {
      mju_copy(data->ctrl, all.data() + tick, 4);
      for (int i = 0; i < physics_hz / hertz; ++i) mj_step(model, data);
    }
    state.SetIterationTime(std::chrono::duration<double>(Clock::now() - begin).count());
  }
  mj_deleteData(data);
  mj_deleteModel(model);
}

// The preparation of a flight after the vehicle was loaded.
void set_up(benchmark::State& state) {
  const Flying& f = flying();
  for (auto _ : state) {
    const auto plant = *f.iris->make_plant(PlantKind::mujoco, {});
    plant->reset({});
    benchmark::DoNotOptimize(plant->state());
  }
}

void bare_set_up(benchmark::State& state) {
  mjModel* model = mj_loadXML(ATTEST_SOURCE_DIR "/models/iris.xml", nullptr, nullptr, 0);
  for (auto _ : state) {
    mjModel* copy = mj_copyModel(nullptr, model);
    mjData* data = mj_makeData(copy);
    mj_resetData(copy, data);
    benchmark::DoNotOptimize(data->time);
    mj_deleteData(data);
    mj_deleteModel(copy);
  }
  mj_deleteModel(model);
}

BENCHMARK_CAPTURE(flight, at_250, 250, false)->Name("flight/250hz")->UseManualTime();
BENCHMARK_CAPTURE(flight, traced, 250, true)->Name("flight/250hz_trace")->UseManualTime();
BENCHMARK_CAPTURE(bare_steps, at_250, 250)->Name("mj_step/250hz")->UseManualTime();
BENCHMARK_CAPTURE(flight, at_1000, 1000, false)->Name("flight/1000hz")->UseManualTime();
BENCHMARK_CAPTURE(bare_steps, at_1000, 1000)->Name("mj_step/1000hz")->UseManualTime();
BENCHMARK(set_up)->Name("plant/set_up");
BENCHMARK(bare_set_up)->Name("mujoco/set_up");

}  // namespace
}  // namespace attest::bench
