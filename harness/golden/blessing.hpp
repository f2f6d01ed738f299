// New goldens of cases, written next to the old ones, to be put in place together.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "harness/casefile/select.hpp"
#include "harness/golden/golden.hpp"
#include "harness/host/port_process.hpp"

namespace attest {

struct BlessingOptions {
  std::filesystem::path golden, models;  // folders of the suite
  Making making;                         // kept in the provenance
  std::optional<HostOptions> port = {};  // the reference of the suite; empty: attest's own
  // Called with one line about each case whose golden changes.
  std::function<void(const std::string& line)> on_change = [](const std::string&) {};
  std::function<bool()> stop = [] { return false; };  // returns true: end with an error
};

// The destructor removes goldens that were not put in place.
struct PendingGoldens {
  std::vector<NewGolden> goldens;
  std::size_t unchanged = 0;                    // cases
  std::map<std::string, std::size_t> left_out;  // reason -> cases without a golden of the port
};

// REQUIRES: the caller holds the GoldenLock of the folder. A case file is blessed in all its
// profiles, whichever of them is selected, because the golden of the first profile is the base of
// the others. Errors: those of Reference::of_port(), make_golden() and NewGolden::write().
Result<PendingGoldens> write_new_goldens(const std::vector<SelectedCase>& cases,
                                         const BlessingOptions& options);

}  // namespace attest
