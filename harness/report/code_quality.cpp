// The code quality report for GitLab.
#include <optional>
#include <set>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "harness/core/file.hpp"
#include "harness/core/json_text.hpp"
#include "harness/report/failure_text.hpp"
#include "harness/report/report.hpp"
#include "harness/report/text.hpp"

namespace attest {
namespace {

const char* severity_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::crash:
    case Verdict::timeout:
    case Verdict::protocol:
      return "critical";
    case Verdict::xpass:
      return "minor";
    default:
      return "major";
  }
}

}  // namespace

std::string code_quality_report(const RunResult& run, const std::optional<Diagnosis>& diagnosis) {
  nlohmann::ordered_json entries = nlohmann::ordered_json::array();
  std::set<std::string> known;
  for (const VectorResult& result : run.results) {
    const std::string key = fmt::format("{} {}", result.case_id(), name_of(result.verdict));
    if (!fails_a_run(result.verdict) || !known.insert(key).second) continue;
    std::string what = fmt::format("{}: {}: {}", one_line(result.id()), name_of(result.verdict),
                                   failure_headline(result));
    if (diagnosis && !diagnosis->suspects.empty()) {
      what += fmt::format("; it looks like `{}`", diagnosis->suspects.front().fault->id);
    }
    entries.push_back(
        {{"description", what},
         {"check_name", fmt::format("attest {}", name_of(result.verdict))},
         {"fingerprint", sha256(key)},
         {"severity", severity_of(result.verdict)},
         {"location", {{"path", run.case_files.at(result.case_id())}, {"lines", {{"begin", 1}}}}}});
  }
  return document_of(entries);
}

}  // namespace attest
