#include "harness/report/fleet_document.hpp"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "harness/report/replay_document.hpp"

namespace attest {
namespace {

struct FleetRow {
  Verdict verdict = Verdict::skip;
  double largest = 0;  // deviation in a judged topic
  std::vector<Cell> cells;

  // Lower is worse.
  int rank() const {
    if (fails_a_run(verdict)) return verdict == Verdict::fail ? 1 : 0;
    return verdict == Verdict::pass ? 3 : 2;
  }
};

// A number that is not finite is no number in JSON.
double number_in(const nlohmann::ordered_json& json, const char* key) {
  const auto found = json.find(key);
  return found != json.end() && found->is_number() ? found->get<double>()
                                                   : std::numeric_limits<double>::infinity();
}

FleetRow row_of(const nlohmann::ordered_json& entry, Verdict verdict, const std::string& link) {
  FleetRow row;
  row.verdict = verdict;
  std::size_t compared = 0, within = 0;
  for (const auto& topic : entry.value("topics", nlohmann::ordered_json::array())) {
    if (!topic.value("judged", false)) continue;
    row.largest = std::max(row.largest, number_in(topic, "largest"));
    compared += topic.at("paired").get<std::size_t>();
    within += topic.at("within").get<std::size_t>();
  }
  const auto reason = entry.at("reason").get<std::string>();
  Cell file = entry.at("file").get<std::string>();
  file.link = link;
  row.cells = {file,
               entry.at("module").get<std::string>(),
               entry.at("profile").get<std::string>(),
               Cell(std::string(name_of(verdict)), verdict),
               fmt::format("{}", entry.at("ticks").get<std::size_t>()),
               fmt::format("{}", compared),
               compared > 0 ? fmt::format("{:.1f}%", 100 * static_cast<double>(within) /
                                                         static_cast<double>(compared))
                            : "-",
               compared > 0 ? fmt::format("{:.3g}", row.largest) : "-",
               reason.empty() ? not_judged_text({entry}) : reason};
  return row;
}

DocumentTable details_of(const FleetLog& log, const std::string& id) {
  DocumentTable details{log.file, {}};
  details.id = id;
  for (std::size_t begin = 0; begin < log.text.size();) {
    const std::size_t end = std::min(log.text.find('\n', begin), log.text.size());
    details.below.emplace_back(log.text.substr(begin, end - begin));
    begin = end + 1;
  }
  return details;
}

}  // namespace

Document fleet_document(const std::string& port, const std::vector<FleetLog>& logs) {
  std::vector<FleetRow> rows;
  std::vector<DocumentTable> details;
  for (std::size_t i = 0; i < logs.size(); ++i) {
    const std::string id = fmt::format("log-{}", i + 1);
    for (std::size_t j = 0; j < logs[i].entries.size(); ++j) {
      rows.push_back(row_of(logs[i].entries[j], logs[i].verdicts[j], id));
    }
    details.push_back(details_of(logs[i], id));
  }
  std::stable_sort(rows.begin(), rows.end(), [](const FleetRow& a, const FleetRow& b) {
    return std::pair(a.rank(), -a.largest) < std::pair(b.rank(), -b.largest);
  });
  DocumentTable table{"Logs, the worst first",
                      {"log", "module", "profile", "verdict", "steps", "compared samples", "within",
                       "largest deviation", "reason"}};
  std::size_t failed = 0, passed = 0;
  for (FleetRow& row : rows) {
    failed += fails_a_run(row.verdict) ? 1 : 0;
    passed += row.verdict == Verdict::pass ? 1 : 0;
    table.rows.push_back(std::move(row.cells));
  }
  Document document;
  const Conclusion conclusion = failed > 0   ? Conclusion::fail
                                : passed > 0 ? Conclusion::pass
                                             : Conclusion::none;
  document.head = {conclusion, fmt::format("{} logs", logs.size()),
                   fmt::format("{}: {} agree, {} differ, {} not compared", port, passed, failed,
                               rows.size() - passed - failed)};
  document.tables.push_back(std::move(table));
  std::move(details.begin(), details.end(), std::back_inserter(document.tables));
  return document;
}

}  // namespace attest
