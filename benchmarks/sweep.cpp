// The flights of a sweep, from the numbers of a sample to its row: with a worker process, a process
// of its own for each flight of a port, and all checks. The floor is that of a flight: the bare
// steps of MuJoCo.
#include <chrono>
#include <string>

#include <benchmark/benchmark.h>

#include "harness/casefile/parse.hpp"
#include "harness/core/file.hpp"
#include "harness/sweep/flights.hpp"

namespace attest::bench {
namespace {

using Clock = std::chrono::steady_clock;

constexpr const char* rate_sweep_text = R"(
schema = 1
case = "px4-v1.5.5/flight/tilt_step_30"
vehicle = "iris"
plant = "mujoco"
rate = 250
design = "latin_hypercube"
samples = 64

[disperse.mass]
keys = ["vehicle.mass_kg"]
as = "factor"
distribution = "truncated_normal"
mean = 1
deviation = 0.05
low = 0.85
high = 1.15

[disperse.inertia]
keys = ["vehicle.inertia_kg_m2[0]", "vehicle.inertia_kg_m2[1]", "vehicle.inertia_kg_m2[2]"]
as = "factor"
distribution = "log_normal"
median = 1
spread = 0.1

[disperse.tilt]
keys = ["case.flight.start.tilt_deg"]
distribution = "uniform"
low = -5
high = 5
)";

FlightSampler make_sampler() {
  const std::string source = ATTEST_SOURCE_DIR;
  NominalFlight nominal;
  nominal.the_case = *parse_case(source + "/cases/px4-v1.5.5/flight/tilt_step_30.toml");
  nominal.case_text = *read_file(nominal.the_case.file);
  nominal.plant_configuration = {"iris", PlantKind::mujoco};
  nominal.vehicle_model = *VehicleModel::load(source + "/models", "iris");
  nominal.vehicle_text = *read_file(nominal.vehicle_model->vehicle().file);
  return *FlightSampler::make(*parse_sweep(rate_sweep_text, "sweep.toml"), std::move(nominal));
}

// The time of one flight: that of the sweep by its flights.
void fly_sweep(benchmark::State& state, int processes, bool with_port) {
  static const FlightSampler sampler = make_sampler();  // kept, so that later turns start fast
  const std::uint64_t samples = sampler.sweep().design.samples;
  FlightsOptions options;
  options.processes = processes;
  options.with_port = with_port;
  if (with_port) {
    options.host.port = std::string("lib:") + ATTEST_BENCHMARK_PORT;
    options.host.said = *describe_port(options.host);
  }
  const double flights = static_cast<double>(samples) * (with_port ? 2 : 1);
  for (auto _ : state) {
    const auto begin = Clock::now();
    const auto flown = fly_samples(sampler, {0, samples}, options,
                                   [](const std::string&) -> Result<void> { return {}; });
    const std::chrono::duration<double> took = Clock::now() - begin;
    state.SetIterationTime(took.count() / flights);
    if (!flown) return state.SkipWithError(flown.error().message.c_str());
  }
}

void reference(benchmark::State& state) { fly_sweep(state, 1, false); }
void with_port(benchmark::State& state) { fly_sweep(state, 1, true); }
void fly_by_two_jobs(benchmark::State& state) { fly_sweep(state, 2, false); }

BENCHMARK(reference)->Name("sweep/reference")->UseManualTime()->Iterations(1);
BENCHMARK(with_port)->Name("sweep/with_port")->UseManualTime()->Iterations(1);
BENCHMARK(fly_by_two_jobs)->Name("sweep/two_jobs")->UseManualTime()->Iterations(1);

}  // namespace
}  // namespace attest::bench
