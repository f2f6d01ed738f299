// Finds the one case that a command line names.
#pragma once

#include <memory>
#include <string>

#include "harness/casefile/case.hpp"
#include "harness/cli/globals.hpp"
#include "harness/cli/suite_folder.hpp"
#include "harness/loop/timing_file.hpp"
#include "harness/plant/plant.hpp"

namespace attest::cli {

// Without a profile, a name that several profiles have is that of the first of them in the order of
// known_profile_names(), where the newest profile of a law is its first; a case file gives that of
// its folder. If flights of both laws match, the law that flies at `rate` is chosen: the cascade at
// a pair of rates, else the controller. Errors: the case is not a flight; no case matches; cases
// with different names match.
Result<Case> find_flight(const CaseChoice& choice, const LoopRate& rate, const SuiteFolder& suite);

// The same for a case in open loop, of any law. If several match, those of `modules` are preferred,
// which a port has. Errors: the case is a flight; the others above.
Result<Case> find_open_loop_case(const CaseChoice& choice, const SuiteFolder& suite,
                                 const ModuleSet& modules);

// The rates of the units in a flight. A single rate of the cascade is that of its rate unit: then
// the attitude unit has 250 Hz, as in most flights of PX4, or the same rate if that is lower.
LoopRate rate_of_flight(const Case& the_case, const LoopRate& given);

// The flight with its vehicle and plant. Empty texts select the case's lead vehicle and first
// plant.
struct ChosenFlight {
  Case the_case;
  PlantConfiguration plant_configuration;
  std::shared_ptr<const VehicleModel> vehicle_model;
};
Result<ChosenFlight> choose_flight(const CaseChoice& choice, const LoopRate& rate,
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
