// A flight against bare MuJoCo: as many steps of the model as its file describes it, with the same
// rotor commands read from memory. A flight leaves out the geoms, so it may take less time.
#include <chrono>
#include <map>
#include <memory>
#include <string>
#include <thread>
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

struct Flying {
  Case the_case;
  RunConfiguration configuration;
  std::shared_ptr<const VehicleModel> iris =
      *VehicleModel::load(ATTEST_SOURCE_DIR "/models", "iris");
  std::unique_ptr<Port> port = *open_port("builtin");

  // The same step of the pitch, of the controller or of the cascade.
  explicit Flying(const LoopRate& rate)
      : the_case(*parse_case(std::string(ATTEST_SOURCE_DIR "/cases/") +
                             (rate.attitude_unit ? "px4-v1.16.0" : "px4-v1.5.5") +
                             "/flight/tilt_step_30.toml")),
        configuration{rate, PlantConfiguration{"iris", PlantKind::mujoco}} {}

  PortUnits units() const { return *units_for(the_case, *port); }
  FlightTiming timing() const { return flight_timing(the_case, configuration.rate); }
};

// Kept, so that later turns start fast.
const Flying& flying(const LoopRate& rate) {
  static std::map<LoopRate, Flying> all;
  return all.try_emplace(rate, rate).first->second;
}

LoopRate cascade_rate() { return {Rate::hz(250), Rate::hz(1000)}; }

void flight(benchmark::State& state, const LoopRate& rate, bool keep_trace) {
  const Flying& f = flying(rate);
  const Case scripted = bound_to_vehicle(f.the_case, f.iris->vehicle());
  const std::size_t ticks = f.timing().unit.size();
  for (auto _ : state) {
    const auto plant = *plant_for(f.the_case, f.configuration, *f.iris);
    const PortUnits units = f.units();
    ClosedLoop loop(scripted, rate, f.timing(), f.iris->vehicle(), *plant, units.for_flight());
    Trace trace, attitude_trace;
    for (Trace* const one : {&trace, &attitude_trace}) one->samples.reserve(ticks);
    trace.plant.reserve(ticks);
    const auto begin = Clock::now();
    benchmark::DoNotOptimize(
        loop.run(keep_trace ? FlightTraces{&trace, &attitude_trace} : FlightTraces{}));
    state.SetIterationTime(std::chrono::duration<double>(Clock::now() - begin).count());
  }
}

// The commanded rotor speeds [rad/s], four for each tick of the unit that commands the motors.
std::vector<double> commands(const Flying& f) {
  const PortUnits units = f.units();
  const auto flown = *fly(f.the_case, f.configuration, *f.iris, units.for_flight());
  std::vector<double> all;
  for (const PlantSample& sample : flown.trace.plant) {
    for (std::size_t i = 0; i < 4; ++i) {
      all.push_back((static_cast<double>(sample.motor[i]) + 1) / 2 *
                    f.iris->vehicle().rotor_max_rad_s);
    }
  }
  return all;
}

// As many bare steps as a flight makes.
class BareSteps {
 public:
  explicit BareSteps(const LoopRate& rate) : vehicle_(flying(rate).iris->vehicle()) {
    static std::map<LoopRate, std::vector<double>> flown;  // kept, so that later turns start fast
    const Flying& f = flying(rate);
    if (!flown.contains(rate)) flown[rate] = commands(f);  // installs MuJoCo's callbacks too
    commands_ = flown[rate];
    per_tick_ = static_cast<int>(physics_of(f.the_case, rate.motor_unit).hertz() / rate.hertz());
  }
  ~BareSteps() {
    mj_deleteData(data_);
    mj_deleteModel(model_);
  }
  BareSteps(const BareSteps&) = delete;
  BareSteps& operator=(const BareSteps&) = delete;

  void reset() {
    mj_resetData(model_, data_);
    mju_copy(data_->userdata, vehicle_.drag_kg_s.data(), 3);
    for (int i = 0; i < 4; ++i) data_->act[i] = vehicle_.hover_rotor_rad_s();
  }

  void run() {
    for (std::size_t tick = 0; tick + 4 < commands_.size(); tick += 4) {
      mju_copy(data_->ctrl, commands_.data() + tick, 4);
      for (int i = 0; i < per_tick_; ++i) mj_step(model_, data_);
    }
  }

 private:
  const Vehicle& vehicle_;
  std::vector<double> commands_;
  int per_tick_ = 0;
  mjModel* model_ = mj_loadXML(ATTEST_SOURCE_DIR "/models/iris.xml", nullptr, nullptr, 0);
  mjData* data_ = mj_makeData(model_);
};

void bare_steps(benchmark::State& state, const LoopRate& rate) {
  BareSteps steps(rate);
  for (auto _ : state) {
    steps.reset();
    const auto begin = Clock::now();
    steps.run();
    state.SetIterationTime(std::chrono::duration<double>(Clock::now() - begin).count());
  }
}

// The flights of a sweep shared by two threads: the time of one flight.
void two_threads(benchmark::State& state) {
  constexpr std::size_t flights = 64, threads = 2;
  std::vector<std::unique_ptr<BareSteps>> steps;
  for (std::size_t i = 0; i < threads; ++i) {
    steps.push_back(std::make_unique<BareSteps>(Rate::hz(250)));
  }
  for (auto _ : state) {
    const auto begin = Clock::now();
    std::vector<std::jthread> all;
    for (const auto& one : steps) {
      all.emplace_back([&] {
        for (std::size_t i = 0; i < flights / threads; ++i) {
          one->reset();
          one->run();
        }
      });
    }
    all.clear();
    const std::chrono::duration<double> took = Clock::now() - begin;
    state.SetIterationTime(took.count() / static_cast<double>(flights));
  }
}

// The preparation of a flight after the vehicle was loaded.
void set_up(benchmark::State& state) {
  const Flying& f = flying(Rate::hz(250));
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

BENCHMARK_CAPTURE(flight, at_250, Rate::hz(250), false)->Name("flight/250hz")->UseManualTime();
BENCHMARK_CAPTURE(flight, traced, Rate::hz(250), true)->Name("flight/250hz_trace")->UseManualTime();
BENCHMARK_CAPTURE(bare_steps, at_250, Rate::hz(250))->Name("mj_step/250hz")->UseManualTime();
BENCHMARK_CAPTURE(flight, at_1000, Rate::hz(1000), false)->Name("flight/1000hz")->UseManualTime();
BENCHMARK_CAPTURE(bare_steps, at_1000, Rate::hz(1000))->Name("mj_step/1000hz")->UseManualTime();
BENCHMARK_CAPTURE(flight, cascade, cascade_rate(), false)->Name("flight/cascade")->UseManualTime();
BENCHMARK_CAPTURE(bare_steps, cascade, cascade_rate())->Name("mj_step/cascade")->UseManualTime();
// As many as the flights of a sweep.
BENCHMARK_CAPTURE(bare_steps, of_sweep, Rate::hz(250))
    ->Name("sweep/mj_step")
    ->UseManualTime()
    ->Iterations(64);
BENCHMARK(two_threads)->Name("sweep/mj_step_two")->UseManualTime()->Iterations(1);
BENCHMARK(set_up)->Name("plant/set_up");
BENCHMARK(bare_set_up)->Name("mujoco/set_up");

}  // namespace
}  // namespace attest::bench
