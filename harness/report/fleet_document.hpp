// Many logs or traces that were replayed, as one page: a table, the worst first, and below it what
// the terminal says of each.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "harness/report/document.hpp"
#include "harness/verify/verdict.hpp"

namespace attest {

struct FleetLog {
  std::string file;
  std::vector<Verdict> verdicts;                // of each entry
  std::vector<nlohmann::ordered_json> entries;  // of the JSON report (replay_document.hpp)
  std::string text;                             // lines
};

// Failures come first, then what was not compared, then what passed by its largest deviation.
Document fleet_document(const std::string& port, const std::vector<FleetLog>& logs);

}  // namespace attest
