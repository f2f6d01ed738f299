#include "harness/golden/make_golden.hpp"

#include <set>
#include <utility>

#include <fmt/format.h>

#include "harness/casefile/stimulus.hpp"
#include "harness/compare/compare.hpp"
#include "harness/golden/keyframes.hpp"
#include "harness/golden/reference_flight.hpp"
#include "harness/host/in_process_host.hpp"
#include "harness/port/builtin.hpp"

namespace attest {
namespace {

bool does_not_have_it(const PortFault& fault) {
  return fault.kind == PortFault::Kind::unsupported || fault.kind == PortFault::Kind::profile;
}

// Empty if the reference is a port that does not support the case; `left_out` is then the reason.
Result<std::optional<GoldenTrace>> open_loop_trace(const Case& the_case,
                                                   const RunConfiguration& configuration,
                                                   Reference& reference, std::string& left_out) {
  Trace trace = stimulate(the_case, configuration.rate.unit);
  if (const auto fault = reference.drive(subject_of(the_case), trace)) {
    if (!reference.is_own() && does_not_have_it(*fault)) {
      left_out = fault->what;
      return std::nullopt;
    }
    return fail_at(
        the_case.file.string(),
        fmt::format("the reference, at {} Hz: {}", configuration.rate.to_string(), fault->what));
  }
  GoldenTrace golden{configuration, std::move(trace)};
  if (!reference.is_own()) return golden;
  golden.is_whole = keeps_every_tick(golden.trace.samples.size());
  if (!golden.is_whole) golden.trace = keyframes_of(golden.trace);
  return golden;
}

}  // namespace

Reference Reference::own() { return Reference(std::make_unique<InProcessHost>(open_builtin())); }

Result<Reference> Reference::of_port(const HostOptions& options) {
  auto host = start_host(options);
  if (!host) return tl::unexpected(host.error());
  auto again = start_host(options);
  if (!again) return tl::unexpected(again.error());
  Reference reference(*std::move(host));
  reference.again_ = *std::move(again);
  return reference;
}

std::optional<PortFault> Reference::drive(const Subject& subject, Trace& trace) {
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

Result<MadeGolden> make_golden(const Case& the_case, Reference& reference,
                               VehicleModels& vehicle_models, const std::function<bool()>& stop) {
  MadeGolden made;
  if (the_case.flight && !reference.is_own()) {
    made.left_out = "flights are compared with attest's own law";
    return made;
  }
  std::set<std::filesystem::path> files;
  for (const RunConfiguration& configuration : the_case.configurations()) {
    if (stop()) return fail("interrupted");
    if (!configuration.plant_configuration) {
      auto trace = open_loop_trace(the_case, configuration, reference, made.left_out);
      if (!trace) return tl::unexpected(trace.error());
      if (!*trace) return made;
      made.traces.push_back(**std::move(trace));
      continue;
    }
    const auto vehicle_model = vehicle_models.get(configuration.plant_configuration->vehicle);
    if (!vehicle_model) return tl::unexpected(vehicle_model.error());
    auto flight = reference_flight(the_case, configuration, **vehicle_model);
    if (!flight) return tl::unexpected(flight.error());
    made.traces.push_back({configuration, std::move(flight->rows), false, flight->horizon_s,
                           std::move(flight->metrics)});
    for (auto& file : (*vehicle_model)->vehicle().files()) files.insert(std::move(file));
  }
  made.vehicle_files.assign(files.begin(), files.end());
  return made;
}

}  // namespace attest
