#include "harness/casefile/setup.hpp"

#include <fmt/format.h>

#include "harness/casefile/case.hpp"

namespace attest {

std::string Setup::label() const {
  if (!flyer) return rate.label();
  return fmt::format("{}-{}-{}", rate.label(), flyer->vehicle, name_of(flyer->plant));
}

std::vector<Setup> Case::setups() const {
  std::vector<Setup> all;
  if (!flight) {
    for (const Rate& rate : rates) all.push_back({rate, std::nullopt});
    return all;
  }
  for (const Flyer& flyer : flight->flyers) {
    const bool leads = flyer.vehicle == flight->lead_vehicle;
    for (const Rate& rate : leads ? rates : flight->other_rates) all.push_back({rate, flyer});
  }
  return all;
}

}  // namespace attest
