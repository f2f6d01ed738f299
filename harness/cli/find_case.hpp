// The one flight that a command line names.
#pragma once

#include <memory>
#include <string>

#include "harness/casefile/case.hpp"
#include "harness/cli/suite_folder.hpp"
#include "harness/loop/timing_file.hpp"
#include "harness/plant/plant.hpp"

namespace attest::cli {

// `name` is a case file, or the name, pattern or id of exactly one. Of a file with several profiles
// it is the case of the first, unless the id says another. Errors: it is no flight; it names none
// or several.
Result<Case> find_flight(const std::string& name, const SuiteFolder& suite);

// With what flies it: empty texts leave that to the case, whose lead vehicle and first plant fly.
struct ChosenFlight {
  Case the_case;
  PlantConfiguration plant_configuration;
  std::shared_ptr<const VehicleModel> vehicle_model;
};
Result<ChosenFlight> choose_flight(const std::string& name, const std::string& vehicle,
                                   const std::string& plant, const SuiteFolder& suite);

// A recorded timing with what it is flown with.
struct TimedFlight {
  Case the_case;  // as long as it was
  TimingFile timing;
  std::shared_ptr<const VehicleModel> vehicle_model;
};

// Errors, with the file: it is no timing; its case is not in the suite, or is another than when it
// was recorded.
Result<TimedFlight> find_timed_flight(const std::string& file, const SuiteFolder& suite);

}  // namespace attest::cli
