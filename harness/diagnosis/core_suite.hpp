// The core of the suite: few vectors that still catch every fault of the catalogue that the suite
// catches at the level numeric. A slow port, such as one on a board, is judged by them first.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "controller/faults/fault.hpp"
#include "harness/casefile/select.hpp"
#include "harness/golden/golden.hpp"
#include "harness/verify/case_job.hpp"

namespace attest {

struct CoreOptions {
  int processes = 1;
  std::function<bool()> stop = [] { return false; };
};

// The core of one module in one profile, or of the flights of the profile.
struct CoreOfModule {
  Module module = Module::mc_att_control;  // in flights: that of the motors
  bool flights = false;
  std::vector<std::string> vectors;  // ids, sorted
  std::size_t ticks = 0;             // of all of them
  std::size_t faults = 0;            // that the vectors catch, as do all their candidates
};

// For each module of `cases`: again and again the vector that catches the most faults that no
// vector before it catches; at a tie the shorter one, then the one with the smaller id. Vectors at
// 250 Hz come first; those at other rates catch the faults that are left. Long cases (is_long())
// and cases of the exact level are left out. For the flights the same, each in the configuration
// with the lowest rate, on the plant `ode` if it has it. REQUIRES: `cases` are of `profile`.
// Errors: a golden or a vehicle model cannot be read.
Result<std::vector<CoreOfModule>> core_of(const std::vector<SelectedCase>& cases,
                                          const std::string& profile, const Goldens& goldens,
                                          VehicleModels& vehicle_models,
                                          const CoreOptions& options);

}  // namespace attest
