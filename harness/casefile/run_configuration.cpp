#include "harness/casefile/run_configuration.hpp"

#include <fmt/format.h>

#include "harness/casefile/case.hpp"

namespace attest {
namespace {

// Of the rates above 500 Hz only the fastest is kept: there the law uses dt = 2 ms, so that its
// arithmetic is the same at each rate. REQUIRES: `rates` ascend.
std::vector<Rate> distinct_time_steps(const std::vector<Rate>& rates) {
  std::vector<Rate> distinct;
  for (const Rate& rate : rates) {
    if (!(Rate::hz(500) < rate) || rate == rates.back()) distinct.push_back(rate);
  }
  return distinct;
}

}  // namespace

std::string RunConfiguration::label() const {
  if (!plant_configuration) return rate.label();
  return fmt::format("{}-{}-{}", rate.label(), plant_configuration->vehicle,
                     name_of(plant_configuration->plant));
}

Case Case::in_profile(const std::string& other) const {
  Case same = *this;
  same.profile = other;
  return same;
}

Case Case::from_one_period_on() const {
  Case same = *this;
  same.unit.start = {1, Span::In::ticks};
  return same;
}

std::vector<RunConfiguration> Case::configurations() const {
  std::vector<RunConfiguration> all;
  if (!flight) {
    for (const Rate& rate : rates) all.push_back({rate, std::nullopt});
    return all;
  }
  const std::vector<Rate> lead_rates = is_of_first_profile() ? rates : distinct_time_steps(rates);
  for (const PlantConfiguration& plant_configuration : flight->plant_configurations) {
    const bool leads = plant_configuration.vehicle == flight->lead_vehicle;
    for (const Rate& rate : leads ? lead_rates : flight->other_rates)
      all.push_back({rate, plant_configuration});
  }
  return all;
}

}  // namespace attest
