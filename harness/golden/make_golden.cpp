#include "harness/golden/make_golden.hpp"

#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "harness/casefile/stimulus.hpp"
#include "harness/compare/compare.hpp"
#include "harness/golden/keyframes.hpp"
#include "harness/golden/reference.hpp"
#include "harness/golden/reference_flight.hpp"
#include "harness/host/manifest.hpp"

namespace attest {
namespace {

bool does_not_have_it(const PortFault& fault) {
  using enum PortFault::Kind;
  return fault.kind == profile || fault.kind == module || fault.kind == unsupported;
}

// The outputs of a trace at some ticks. `extra`: further channels that are kept.
GoldenTrace kept(const Trace& trace, std::vector<std::size_t> ticks,
                 const RunConfiguration& configuration, const ChannelSet& extra = {}) {
  GoldenTrace golden{{configuration.label()}, std::move(ticks), {}};
  golden.outputs.present = trace.present & (channels_of(module_of(trace.present), "out/") | extra);
  for (const std::size_t tick : golden.ticks) {
    golden.outputs.samples.push_back(trace.samples[tick]);
  }
  return golden;
}

std::vector<std::size_t> every_tick(const Trace& trace) {
  std::vector<std::size_t> ticks(trace.samples.size());
  std::iota(ticks.begin(), ticks.end(), std::size_t{0});
  return ticks;
}

// Adds the trace of an open-loop vector. If the reference is a port that does not support the case,
// sets `made.left_out` instead.
Result<void> add_open_loop(const Case& the_case, const RunConfiguration& configuration,
                           GoldenSource& source, MadeGolden& made) {
  Trace trace = stimulate(the_case, configuration.rate.motor_unit);
  const std::string inputs = source.is_own() ? "" : sha256_of_inputs(trace);
  if (const auto fault = source.drive(subject_of(the_case), trace)) {
    if (!source.is_own() && does_not_have_it(*fault)) {
      made.left_out = fault->what;
      return {};
    }
    return fail_at(
        the_case.file.string(),
        fmt::format("the reference, at {} Hz: {}", configuration.rate.to_string(), fault->what));
  }
  if (!inputs.empty()) made.inputs[configuration.label()] = inputs;
  const bool is_whole = !source.is_own() || keeps_every_tick(trace.samples.size());
  made.traces.push_back(
      kept(trace, is_whole ? every_tick(trace) : keyframes_of(trace), configuration));
  return {};
}

Result<void> add_flight(const Case& the_case, const RunConfiguration& configuration,
                        const VehicleModel& vehicle_model, MadeGolden& made) {
  auto flight = reference_flight(the_case, configuration, vehicle_model);
  if (!flight) return tl::unexpected(flight.error());
  GoldenTrace trace = kept(flight->rows, keyframes_of(flight->rows), configuration,
                           ChannelSet().set(timestamp_channel));
  trace.horizon_s = flight->horizon_s;
  trace.metrics = std::move(flight->metrics);
  made.traces.push_back(std::move(trace));
  return {};
}

}  // namespace

GoldenSource GoldenSource::own() { return GoldenSource(open_reference()); }

Result<GoldenSource> GoldenSource::of_port(const HostOptions& options) {
  auto host = start_host(options);
  if (!host) return tl::unexpected(host.error());
  auto again = start_host(options);
  if (!again) return tl::unexpected(again.error());
  GoldenSource source(*std::move(host));
  source.again_ = *std::move(again);
  return source;
}

std::optional<PortFault> GoldenSource::drive(const ModuleUnderTest& subject, Trace& trace) {
  Trace second = trace;
  if (auto fault = host_->drive(subject, trace)) return fault;
  if (is_own()) return std::nullopt;
  if (auto fault = again_->drive(subject, second)) return fault;
  const Comparison comparison = compare(second, trace, Tolerances(Level::exact));
  if (comparison.agrees()) return std::nullopt;
  return PortFault{PortFault::Kind::protocol, 0,
                   fmt::format("its outputs differ from those of a second process with the same "
                               "inputs, first at tick {}; a reference must be repeatable",
                               comparison.first ? comparison.first->tick : 0)};
}

Result<Golden> golden_by_reference(const Case& the_case, const RunConfiguration& configuration,
                                   const VehicleModel* vehicle_model) {
  MadeGolden made;
  GoldenOrigin origin;
  GoldenSource source = GoldenSource::own();
  const auto added = vehicle_model ? add_flight(the_case, configuration, *vehicle_model, made)
                                   : add_open_loop(the_case, configuration, source, made);
  if (!added) return tl::unexpected(added.error());
  if (vehicle_model) origin.models = hashes_of(vehicle_model->vehicle());
  return Golden("the reference", std::move(origin), std::move(made.traces));
}

Result<MadeGolden> make_golden(const Case& the_case, GoldenSource& source,
                               VehicleModels& vehicle_models, const std::function<bool()>& stop) {
  MadeGolden made;
  if (the_case.flight && !source.is_own()) {
    made.left_out = "flights are compared with attest's own law";
    return made;
  }
  for (const RunConfiguration& configuration : the_case.configurations()) {
    if (stop()) return fail("interrupted");
    if (!configuration.plant_configuration) {
      auto added = add_open_loop(the_case, configuration, source, made);
      if (!added) return tl::unexpected(added.error());
      if (!made.left_out.empty()) return made;
      continue;
    }
    const auto vehicle_model = vehicle_models.get(configuration.plant_configuration->vehicle);
    if (!vehicle_model) return tl::unexpected(vehicle_model.error());
    auto added = add_flight(the_case, configuration, **vehicle_model, made);
    if (!added) return tl::unexpected(added.error());
    made.models.merge(hashes_of((*vehicle_model)->vehicle()));
  }
  return made;
}

}  // namespace attest
