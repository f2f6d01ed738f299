// The page of `attest sweep --html`.
#pragma once

#include <filesystem>
#include <string>

#include "harness/sweep/flight_sampler.hpp"
#include "harness/sweep/identity.hpp"
#include "harness/sweep/summary.hpp"

namespace attest {

struct SweepRun {
  const FlightSampler& sampler;
  const SampleColumns& columns;
  const SampleData& data;
  const SweepSummary& summary;
  const SweepIdentity& identity;
  std::filesystem::path kept;  // the folder of keep_flights(); empty: no flight was kept
};

// Requirements, metrics, differences from the reference, sensitivities and worst flights as tables;
// distributions, and metrics over dispersions, as plots. The page has a few megabytes, with any
// number of samples.
std::string sweep_page(const SweepRun& run);

}  // namespace attest
