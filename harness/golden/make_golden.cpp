#include "harness/golden/make_golden.hpp"

#include <set>
#include <utility>

#include <fmt/format.h>

#include "harness/casefile/stimulus.hpp"
#include "harness/golden/branch_alternatives.hpp"
#include "harness/golden/keyframes.hpp"
#include "harness/golden/reference_flight.hpp"
#include "harness/loop/open_loop.hpp"

namespace attest {
namespace {

Result<GoldenTrace> open_loop_trace(const Case& the_case, const RunConfiguration& configuration,
                                    Port& reference) {
  Trace trace = stimulate(the_case, configuration.rate);
  if (const auto fault = drive(reference, subject_of(the_case), trace)) {
    return fail_at(the_case.file.string(), fmt::format("the reference: {}", fault->what));
  }
  GoldenTrace golden{configuration, std::move(trace)};
  auto others = branch_alternatives(the_case, golden.trace);
  if (!others) return tl::unexpected(others.error());
  golden.branch_alternatives = std::move(*others);
  golden.is_whole = keeps_every_tick(golden.trace.samples.size());
  if (!golden.is_whole) golden.trace = keyframes_of(golden.trace);
  return golden;
}

}  // namespace

Result<MadeGolden> make_golden(const Case& the_case, Port& reference, VehicleModels& vehicle_models,
                               const std::function<bool()>& stop) {
  MadeGolden made;
  std::set<std::filesystem::path> files;
  // One provenance covers all configurations.
  for (const RunConfiguration& configuration : the_case.configurations()) {
    if (stop()) return fail("interrupted");
    if (!configuration.plant_configuration) {
      auto trace = open_loop_trace(the_case, configuration, reference);
      if (!trace) return tl::unexpected(trace.error());
      made.traces.push_back(std::move(*trace));
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
