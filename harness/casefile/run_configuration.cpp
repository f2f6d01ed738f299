#include "harness/casefile/run_configuration.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "harness/casefile/case.hpp"
#include "harness/port/profiles.hpp"

namespace attest {
namespace {

// The rates at which the lead vehicle flies in the further profiles of a file. REQUIRES: `rates`
// ascend.
// - Controller: of the rates above 500 Hz only the fastest. At all of them the law uses dt = 2 ms,
//   so its arithmetic is the same.
// - Cascade: the slowest and the fastest. What differs between its profiles does not depend on the
//   rate.
std::vector<LoopRate> distinct_time_steps(const std::vector<LoopRate>& rates) {
  if (!rates.empty() && rates.front().attitude_unit) {
    return rates.size() < 2 ? rates : std::vector{rates.front(), rates.back()};
  }
  std::vector<LoopRate> distinct;
  for (const LoopRate& rate : rates) {
    if (!(Rate::hz(500) < rate.motor_unit) || rate == rates.back()) distinct.push_back(rate);
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

Signal Case::parameter(std::string_view parameter_name, double otherwise) const {
  for (const ParameterStimulus& own : parameters) {
    if (own.name == parameter_name) return own.signal;
  }
  return Constant{otherwise};
}

Case Case::of_module(Module unit_of_flight) const {
  Case own = *this;
  if (!attitude_loop) return own;
  own.flight->airmode = parameter("MC_AIRMODE", 0);
  own.module = unit_of_flight;
  const std::vector<std::string> known = parameter_names(unit_of_flight, profile);
  std::erase_if(own.parameters, [&](const ParameterStimulus& parameter) {
    return std::find(known.begin(), known.end(), parameter.name) == known.end();
  });
  if (unit_of_flight != Module::attitude_unit) return own;
  own.topics = attitude_loop->topics;
  own.unit = attitude_loop->unit;
  own.unit.start = unit.start;
  return own;
}

Case Case::from_one_period_on() const {
  Case same = *this;
  same.unit.start = {1, Span::In::ticks};
  return same;
}

std::vector<RunConfiguration> Case::configurations() const {
  std::vector<RunConfiguration> all;
  if (!flight) {
    for (const LoopRate& rate : rates) all.push_back({rate, std::nullopt});
    return all;
  }
  const std::vector<LoopRate> lead_rates =
      is_of_first_profile() ? rates : distinct_time_steps(rates);
  for (const PlantConfiguration& plant_configuration : flight->plant_configurations) {
    const bool leads = plant_configuration.vehicle == flight->lead_vehicle;
    for (const LoopRate& rate : leads ? lead_rates : flight->other_rates)
      all.push_back({rate, plant_configuration});
  }
  return all;
}

Tolerances tolerances_of(const Case& the_case, Level level, std::optional<int> fraction_bits,
                         std::size_t ticks) {
  Tolerances tolerances(level);
  for (const auto& [prefix, tolerance] : the_case.tolerances) tolerances.set(prefix, tolerance);
  if (fraction_bits) tolerances.allow_lsb(*fraction_bits, ticks);
  return tolerances;
}

}  // namespace attest
