// Finds the one case that a command line names.
#pragma once

#include <memory>
#include <string>

#include "harness/casefile/case.hpp"
#include "harness/cli/suite_folder.hpp"
#include "harness/loop/timing_file.hpp"
#include "harness/plant/plant.hpp"

namespace attest::cli {

// `name` is a case file, or the name, pattern or id of one case. A name that several profiles have
// is that of the first of them in the order of known_profile_names(), where the newest profile of a
// law is its first; a case file gives that of its folder. If flights of both laws match, the law
// that flies at `rate` is chosen: the cascade at a pair of rates, else the controller. Errors: the
// case is not a flight; no case matches; cases with different names match.
Result<Case> find_flight(const std::string& name, const LoopRate& rate, const SuiteFolder& suite);

// The same for a case in open loop, of any law. Errors: the case is a flight; the others above.
Result<Case> find_open_loop_case(const std::string& name, const SuiteFolder& suite);

// The flight with its vehicle and plant. Empty texts select the case's lead vehicle and first
// plant.
struct ChosenFlight {
  Case the_case;
  PlantConfiguration plant_configuration;
  std::shared_ptr<const VehicleModel> vehicle_model;
};
Result<ChosenFlight> choose_flight(const std::string& name, const LoopRate& rate,
                                   const std::string& vehicle, const std::string& plant,
                                   const SuiteFolder& suite);

// A recorded timing with its case and vehicle.
struct TimedFlight {
  Case the_case;  // with the duration of the recording
  TimingFile timing;
  std::shared_ptr<const VehicleModel> vehicle_model;
};

// Errors: the file is not a timing file; its case is not in the suite, or has changed since the
// recording.
Result<TimedFlight> find_timed_flight(const std::string& file, const SuiteFolder& suite);

}  // namespace attest::cli
