// The content of a golden: the outputs of the reference for a case.
#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "harness/golden/golden.hpp"
#include "harness/plant/vehicle_models.hpp"
#include "harness/port/port.hpp"

namespace attest {

struct MadeGolden {
  std::vector<GoldenTrace> traces;  // one for each of the case's configurations, in that order
  std::vector<std::filesystem::path> vehicle_files;  // that its flights depend on
};

// `reference` is open_builtin(). `stop` is called before each configuration. Errors: `stop`
// returned true; the reference refuses the case; those of reference_flight() and
// branch_alternatives().
Result<MadeGolden> make_golden(const Case& the_case, Port& reference, VehicleModels& vehicle_models,
                               const std::function<bool()>& stop);

}  // namespace attest
