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
  constexpr double much = 1000;  // more has no meaning: most values then agree to the bit
  if (!(smallest < much)) return "";
  return fmt::format("{}\u00d7", smallest < 10 ? fmt::format("{:.1f}", smallest)
                                               : fmt::format("{:.0f}", smallest));
}

// The results of a table, and a result without a verdict for each group and rate of which vectors
// were left out when the run was stopped.
struct Content {
  Together results;
  std::vector<VectorResult> left_out;
};

Content content_of(const RunResult& run, Together results) {
  Content content{std::move(results), {}};
  for (const NotRun& left : run.not_run) {
    const bool is_in_table = std::ranges::any_of(content.results, [&](const VectorResult* result) {
      return result->profile == left.profile;
    });
    if (!is_in_table) continue;
    VectorResult& one = content.left_out.emplace_back();
    one.profile = left.profile;
    one.group = left.group;
    one.rate = left.rate;
  }
  return content;
}

// The cell of the results for which `wanted` is true.
template <typename Wanted>
Cell cell_of(const Content& content, Wanted wanted) {
  Together results;
  std::size_t passed = 0, failed = 0;
  for (const VectorResult* result : content.results) {
    if (!wanted(*result)) continue;
    results.push_back(result);
    passed += result->verdict == Verdict::pass ? 1 : 0;
    failed += fails_a_run(result->verdict) ? 1 : 0;
  }
  if (results.empty()) return "-";
  const std::size_t apart = results.size() - passed - failed;
  const bool is_stopped = std::ranges::any_of(content.left_out, wanted);
  return {fmt::format("{}{}{}{}", passed, failed > 0 ? fmt::format("/{}", passed + failed) : "",
                      apart > 0 ? fmt::format("+{}", apart) : "", is_stopped ? "*" : ""),
          is_stopped && failed == 0 ? verdict_of(Conclusion::stopped) : gravest(results),
          headroom_text(results)};
}

// The results that belong to a column, and its header.
template <typename Key>
struct Column {
  std::string header;
  Key key;
};

// A table with a row for each group, a column for each key, and the sums. `key_of`: of a result.
template <typename Key, typename KeyOf>
DocumentTable table_of(const Content& content, std::string title,
                       const std::vector<Column<Key>>& columns, KeyOf key_of) {
  std::vector<std::string> groups;
  for (const VectorResult* result : content.results) {
    if (std::ranges::find(groups, result->group) == groups.end()) groups.push_back(result->group);
  }
  DocumentTable table{std::move(title), {"group"}};
  for (const Column<Key>& column : columns) table.header.push_back(column.header);
  table.header.emplace_back("total");
  const auto add_row = [&](const std::string& name, auto is_in_row) {
    std::vector<Cell> row = {name};
    for (const Column<Key>& column : columns) {
      row.push_back(cell_of(content, [&](const VectorResult& result) {
        return is_in_row(result) && key_of(result) == column.key;
      }));
    }
    row.push_back(cell_of(content, is_in_row));
    if (row.back().text.ends_with('*')) {
      row.back().text.back() = ' ';
      row.back().text += capitals(name_of(Conclusion::stopped));
    }
    table.rows.push_back(std::move(row));
  };
  for (const std::string& group : groups) {
    add_row(group, [&](const VectorResult& result) { return result.group == group; });
  }
  add_row("total", [](const VectorResult&) { return true; });
  return table;
}

DocumentTable matrix_of(const Content& content) {
  std::set<LoopRate> rates;
  for (const VectorResult* result : content.results) rates.insert(result->rate);
  std::vector<Column<LoopRate>> columns;
  for (const LoopRate& rate : rates) columns.push_back({rate.to_string(), rate});
  return table_of(content,
                  one_line(content.results.front()->profile) + ": vectors by group and rate [Hz]",
                  columns, [](const VectorResult& result) { return result.rate; });
}

// The results of each profile of which a vector was judged.
std::vector<Together> judged_profiles(const RunResult& run) {
  std::vector<Together> profiles = grouped(
      run, [](const VectorResult&) { return true; },
      [](const VectorResult& a, const VectorResult& b) { return a.profile == b.profile; });
  std::erase_if(profiles, [](const Together& profile) {
    return std::ranges::none_of(
        profile, [](const VectorResult* result) { return is_judged(result->verdict); });
  });
  return profiles;
}

}  // namespace

std::vector<DocumentTable> matrices_of(const RunResult& run) {
  std::vector<Together> profiles = judged_profiles(run);
  std::stable_partition(profiles.begin(), profiles.end(),
                        [](const auto& profile) { return fails_a_run(gravest(profile)); });
  std::vector<DocumentTable> tables;
  for (auto& profile : profiles) tables.push_back(matrix_of(content_of(run, std::move(profile))));
  return tables;
}

DocumentTable matrix_by_profile(const RunResult& run) {
  std::vector<Column<std::string>> columns;
  Together results;
  for (const Together& profile : judged_profiles(run)) {
    const std::string& name = profile.front()->profile;
    columns.push_back({one_line(name), name});
    results.insert(results.end(), profile.begin(), profile.end());
  }
  return table_of(content_of(run, std::move(results)), "vectors by group and profile", columns,
                  [](const VectorResult& result) { return result.profile; });
}

}  // namespace attest
