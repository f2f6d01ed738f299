// The report of `attest sweep`.
#pragma once

#include <filesystem>

#include "harness/report/document.hpp"
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

// Requirements, differences from the reference, metrics, sensitivities and worst flights as tables;
// distributions, and metrics over dispersions, as plots. The page has a few megabytes, with any
// number of samples.
Document sweep_document(const SweepRun& run);

}  // namespace attest
