// New goldens of cases, written next to the old ones, to be put in place together.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "harness/casefile/select.hpp"
#include "harness/golden/golden.hpp"

namespace attest {

struct BlessingOptions {
  std::filesystem::path golden, models;  // folders of the suite
  std::string reason;                    // kept in the provenance
  // A line about each case whose golden changes.
  std::function<void(const std::string& line)> on_change = [](const std::string&) {};
  std::function<bool()> stop = [] { return false; };  // true: end with an error
};

// The destructor removes goldens that were not put in place.
struct PendingGoldens {
  std::vector<NewGolden> goldens;
  std::size_t unchanged = 0;  // cases
};

// REQUIRES: the caller holds the GoldenLock of the folder. A case file is blessed in all its
// profiles, whichever of them is selected: the goldens of the others are based on that of the
// first. Errors: those of make_golden() and NewGolden::write().
Result<PendingGoldens> write_new_goldens(const std::vector<SelectedCase>& cases,
                                         const BlessingOptions& options);

}  // namespace attest
