#include "harness/cli/prepare_sweep.hpp"

#include <utility>

#include <fmt/format.h>

#include "harness/casefile/parse_limits.hpp"
#include "harness/cli/find_case.hpp"
#include "harness/cli/run_plan.hpp"
#include "harness/core/file.hpp"
#include "harness/core/interrupt.hpp"
#include "harness/core/suite_files.hpp"
#include "harness/core/version.hpp"
#include "harness/loop/flight.hpp"

namespace attest::cli {
namespace {

constexpr const char* only_reference = "builtin";

Result<FlightSampler> make_sampler(const SweepOptions& options, const SuiteFolder& suite) {
  const auto text = read_file(options.file);
  if (!text) return tl::unexpected(text.error());
  auto sweep = parse_sweep(*text, options.file, options.samples);
  if (!sweep) return tl::unexpected(sweep.error());
  if (!options.vehicle.empty()) sweep->vehicle = options.vehicle;
  if (!options.plant.empty()) sweep->plant = options.plant;
  auto chosen =
      choose_flight({sweep->case_name, ""}, sweep->rate, sweep->vehicle, sweep->plant, suite);
  if (!chosen) {
    Error error = chosen.error();
    if (error.file.empty()) error.file = options.file;
    return tl::unexpected(std::move(error));
  }
  auto& [the_case, plant_configuration, vehicle_model] = *chosen;
  if (auto sane = check_rate(the_case, sweep->rate); !sane) return tl::unexpected(sane.error());
  if (auto few = check_ticks(the_case, sweep->rate); !few) return tl::unexpected(few.error());
  auto case_text = read_suite_file(the_case.file);
  if (!case_text) return tl::unexpected(case_text.error());
  auto vehicle_text = read_suite_file(vehicle_model->vehicle().file);
  if (!vehicle_text) return tl::unexpected(vehicle_text.error());
  return FlightSampler::make(
      *std::move(sweep),
      {std::move(the_case), *std::move(case_text), std::move(plant_configuration),
       std::move(vehicle_model), *std::move(vehicle_text)});
}

// The port is asked for its declarations once. Each of its processes must declare the same.
Result<FlightsOptions> flights_of(const SweepOptions& options) {
  FlightsOptions flights;
  flights.processes = options.jobs;
  flights.stop = interrupted;
  flights.with_port = options.host.port != only_reference;
  flights.host = options.host;
  flights.host.stop = interrupted;
  if (!flights.with_port) return flights;
  if (auto port = prepare_port(flights.host); !port) return tl::unexpected(port.error());
  return flights;
}

}  // namespace

Result<PreparedSweep> prepare_sweep(const SweepOptions& options, const SuiteFolder& suite) {
  const auto shard = Shard::parse(options.shard);
  if (!shard) return tl::unexpected(shard.error());
  auto sampler = make_sampler(options, suite);
  if (!sampler) return tl::unexpected(sampler.error());
  auto flights = flights_of(options);
  if (!flights) return tl::unexpected(flights.error());
  if (const std::uint64_t samples = sampler->sweep().design.samples; shard->count > samples) {
    return fail(fmt::format("--shard {}: the sweep has only {} samples", options.shard, samples));
  }
  SweepIdentity identity;
  identity.attest_version = version;
  identity.sweep_sha256 = sampler->sha256();
  identity.shard = shard->to_string();
  if (flights->with_port) {
    identity.port = options.host.port;
    identity.port_sha256 = flights->host.files->sha256();
  }
  return PreparedSweep{*std::move(sampler), *std::move(flights), *shard, std::move(identity)};
}

}  // namespace attest::cli
