// New goldens of cases, written next to the old ones, to be put in place together.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "harness/casefile/select.hpp"
#include "harness/golden/new_goldens.hpp"
#include "harness/host/port_process.hpp"

namespace attest {

struct BlessingOptions {
  std::filesystem::path models;          // folder of the suite
  Making making;                         // kept in the provenance
  std::optional<HostOptions> port = {};  // the reference of the suite; empty: attest's own
  GoldenKeys all_cases = {};             // goldens of other cases are removed
  // Called with one line about each case whose golden changes.
  std::function<void(const std::string& line)> on_change = [](const std::string&) {};
  std::function<bool()> stop = [] { return false; };  // returns true: end with an error
};

struct PendingGoldens {
  NewGoldens goldens;
  std::size_t unchanged = 0;                    // cases
  std::map<std::string, std::size_t> left_out;  // reason -> cases without a golden of the port
};

// Makes the golden of each case at all its rates. In the profiles of these cases, goldens without a
// case are removed. `goldens`: the old ones; it outlives the result.
// REQUIRES: the caller holds the GoldenLock of their folder; `all_cases` has the cases. Errors:
// those of Reference::of_port(), make_golden(), change_of_golden() and NewGoldens::add().
Result<PendingGoldens> write_new_goldens(const std::vector<SelectedCase>& cases,
                                         const Goldens& goldens, const BlessingOptions& options);

}  // namespace attest
