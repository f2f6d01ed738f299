// The one flight that a command line names.
#pragma once

#include <memory>
#include <string>

#include "harness/casefile/case.hpp"
#include "harness/cli/suite_folder.hpp"
#include "harness/plant/plant.hpp"
#include "harness/run/timing_file.hpp"

namespace attest::cli {

// `name` is a case file, or the name or pattern of exactly one case. Errors: it is no flight; it
// names none or several.
Result<Case> find_flight(const std::string& name, const SuiteFolder& suite);

// What flies it: empty texts leave it to the case, whose lead vehicle and first plant fly.
Result<Flyer> find_flyer(const Case& the_case, const std::string& vehicle,
                         const std::string& plant);

// A recorded timing with what it is flown with.
struct TimedFlight {
  Case the_case;  // as long as it was
  TimingFile timing;
  std::shared_ptr<const Airframe> airframe;
};

// Errors, with the file: it is no timing; its case is not in the suite, or is another than when it
// was recorded.
Result<TimedFlight> find_timed_flight(const std::string& file, const SuiteFolder& suite);

}  // namespace attest::cli
