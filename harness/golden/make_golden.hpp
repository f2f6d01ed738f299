// What a golden is made of: the answers of the reference to a case.
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

// `reference` is open_builtin(). `stop` is looked at before each configuration. Errors: it said so;
// the reference refuses the case, or misses what reference_flight() and branch_alternatives() name.
Result<MadeGolden> make_golden(const Case& the_case, Port& reference, VehicleModels& vehicle_models,
                               const std::function<bool()>& stop);

}  // namespace attest
