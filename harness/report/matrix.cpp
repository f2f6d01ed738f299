#include "harness/report/matrix.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>

#include <fmt/format.h>

#include "harness/report/text.hpp"

namespace attest {
namespace {

// The gravest verdict is the last one.
constexpr std::array by_gravity = {
    Verdict::skip, Verdict::unsupported, Verdict::pass,     Verdict::xfail,   Verdict::xpass,
    Verdict::fail, Verdict::non_finite,  Verdict::protocol, Verdict::timeout, Verdict::crash};
static_assert(by_gravity.size() == verdict_count);

Verdict gravest(const Together& results) {
  for (auto verdict = by_gravity.rbegin(); verdict != by_gravity.rend(); ++verdict) {
    const auto has_it = [&](const VectorResult* result) { return result->verdict == *verdict; };
    if (std::any_of(results.begin(), results.end(), has_it)) return *verdict;
  }
  return by_gravity.front();
}

// The smallest headroom of the results, in small type.
std::string headroom_text(const Together& results) {
  double smallest = std::numeric_limits<double>::infinity();
  for (const VectorResult* result : results) {
    if (result->verdict != Verdict::pass || !result->tightest) continue;
    smallest = std::min(smallest, result->tightest->ratio);
  }
  return std::isfinite(smallest) ? fmt::format("{:.2g}\u00d7", smallest) : "";
}

// The cell of the results of a profile for which `wanted` is true.
template <typename Wanted>
Cell cell_of(const Together& all, Wanted wanted) {
  Together results;
  std::size_t passed = 0, failed = 0;
  for (const VectorResult* result : all) {
    if (!wanted(*result)) continue;
    results.push_back(result);
    passed += result->verdict == Verdict::pass ? 1 : 0;
    failed += fails_a_run(result->verdict) ? 1 : 0;
  }
  if (results.empty()) return "-";
  const std::size_t apart = results.size() - passed - failed;
  return {fmt::format("{}{}{}", passed, failed > 0 ? fmt::format("/{}", passed + failed) : "",
                      apart > 0 ? fmt::format("+{}", apart) : ""),
          gravest(results), headroom_text(results)};
}

DocumentTable matrix_of(const Together& results) {
  std::set<LoopRate> rates;
  std::vector<std::string> groups;
  for (const VectorResult* result : results) {
    rates.insert(result->rate);
    const bool is_known = std::find(groups.begin(), groups.end(), result->group) != groups.end();
    if (!is_known) groups.push_back(result->group);
  }
  DocumentTable table{one_line(results.front()->profile) + ": vectors by group and rate [Hz]",
                      {"group"}};
  for (const LoopRate& rate : rates) table.header.push_back(rate.to_string());
  table.header.emplace_back("total");
  const auto add_row = [&](const std::string& name, auto is_in_row) {
    std::vector<Cell> row = {name};
    for (const LoopRate& rate : rates) {
      row.push_back(cell_of(results, [&](const VectorResult& result) {
        return is_in_row(result) && result.rate == rate;
      }));
    }
    row.push_back(cell_of(results, is_in_row));
    table.rows.push_back(std::move(row));
  };
  for (const std::string& group : groups) {
    add_row(group, [&](const VectorResult& result) { return result.group == group; });
  }
  add_row("total", [](const VectorResult&) { return true; });
  return table;
}

}  // namespace

std::vector<DocumentTable> matrices_of(const RunResult& run) {
  std::vector<Together> profiles = grouped(
      run, [](const VectorResult&) { return true; },
      [](const VectorResult& a, const VectorResult& b) { return a.profile == b.profile; });
  std::stable_partition(profiles.begin(), profiles.end(),
                        [](const auto& profile) { return fails_a_run(gravest(profile)); });
  std::vector<DocumentTable> tables;
  for (const auto& profile : profiles) tables.push_back(matrix_of(profile));
  return tables;
}

}  // namespace attest
