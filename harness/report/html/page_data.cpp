#include "harness/report/html/page_data.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/report/conclusion.hpp"
#include "harness/report/diagnosis_text.hpp"
#include "harness/report/failure_text.hpp"
#include "harness/report/html/embedded.hpp"
#include "harness/report/html/page_parts.hpp"
#include "harness/report/matrix.hpp"
#include "harness/report/statement.hpp"
#include "harness/report/text.hpp"

namespace attest {
namespace {

void add_conclusion(const RunResult& run, data& page) {
  const Conclusion conclusion = conclusion_of(run);
  set_text(page, "conclusion", name_of(conclusion));
  set_text(page, "conclusion_symbol",
           symbol_of(conclusion == Conclusion::pass   ? Verdict::pass
                     : conclusion == Conclusion::fail ? Verdict::fail
                                                      : Verdict::skip));
  set_text(page, "conclusion_text", conclusion_text(run));
  set_text(page, "port_name", one_line(run.port_name));
  set_text(page, "port_version", one_line(run.port_version));
  const Statement statement = statement_of(run);
  page.set("claims", list_of(statement.claims,
                             [](const std::string& claim) { return data("claim", text(claim)); }));
  set_text(page, "subject", statement.subject);
  set_text(page, "stages", first_stages(run));
  page.set("errors", list_of(run.errors, [](const Error& error) {
             return data("message", text(one_line(error.to_string())));
           }));
}

// The failures without a deviation (a crash, a metric of a flight), counted by reason.
struct Reason {
  Verdict verdict;
  std::string text;
  std::size_t count;
};

std::vector<Reason> reasons_of(const RunResult& run) {
  constexpr std::size_t most = 8;
  std::vector<Reason> reasons;
  for (const VectorResult& result : run.results) {
    if (!fails_a_run(result.verdict) || result.first) continue;
    const std::string reason = reason_text(result);
    const auto same = std::find_if(reasons.begin(), reasons.end(), [&](const Reason& known) {
      return known.verdict == result.verdict && known.text == reason;
    });
    if (same != reasons.end())
      ++same->count;
    else
      reasons.push_back({result.verdict, reason, 1});
  }
  std::stable_sort(reasons.begin(), reasons.end(),
                   [](const Reason& a, const Reason& b) { return a.count > b.count; });
  if (reasons.size() > most) reasons.resize(most);
  return reasons;
}

void add_reasons(const RunResult& run, data& page) {
  const std::vector<Reason> reasons = reasons_of(run);
  page.set("has_reasons", !reasons.empty());
  page.set("reasons", list_of(reasons, [](const Reason& reason) {
             data out;
             set_text(out, "verdict", name_of(reason.verdict));
             set_text(out, "symbol", symbol_of(reason.verdict));
             set_text(out, "count", fmt::to_string(reason.count));
             set_text(out, "text", reason.text);
             return out;
           }));
}

data suspect_to_data(const Suspect& suspect) {
  std::vector<std::string> others;
  for (const faults::Fault* other : suspect.ambiguity_group) {
    others.push_back(std::string(other->id));
  }
  data out;
  set_text(out, "id", suspect.fault->id);
  set_text(out, "with", suspect.with ? suspect.with->id : std::string_view());
  set_text(out, "what", suspect.fault->what);
  set_text(out, "kind", suspect.fault->kind);
  set_text(out, "stage", name_of(suspect.fault->stage));
  set_text(
      out, "matches",
      fmt::format("{} of {} ticks, and on every tick of {} of {}", suspect.matched, suspect.ticks,
                  suspect.explained, counted(suspect.failing, "failing vector")));
  set_text(out, "others", fmt::format("{}", fmt::join(others, ", ")));
  return out;
}

void add_diagnosis(const std::optional<Diagnosis>& found, data& page) {
  if (!found) return;
  data diagnosis;
  diagnosis.set("suspects", list_of(found->suspects, suspect_to_data));
  if (found->suspects.empty() && found->nearest == nullptr) {
    set_text(diagnosis, "unlike", first_stages(*found));
  } else if (found->suspects.empty()) {
    data nearest;
    set_text(nearest, "id", found->nearest->id);
    set_text(nearest, "what", found->nearest->what);
    set_text(nearest, "stage", name_of(*found->stage));
    set_text(nearest, "percent", fmt::format("{:.0f}", 100 * found->jaccard_index));
    diagnosis.set("nearest", nearest);
  }
  set_text(diagnosis, "specific_case", found->specific_case);
  set_text(diagnosis, "shown_by_it", counted(found->shown_by_it, "fault"));
  set_text(diagnosis, "why", one_line(found->why));
  page.set("diagnosis", diagnosis);
}

// Names and values. add_facts() leaves out an empty value.
std::vector<std::pair<std::string, std::string>> facts_of(const RunResult& run) {
  std::vector<std::string> rates;
  for (const LoopRate& rate : run.rates) rates.push_back(rate.to_string());
  return {{"attest", run.attest_version},
          {"date (UTC)", run.date},
          {"port", run.port},
          {"port, SHA-256", run.port_sha256},
          {"level", std::string(name_of(run.level))},
          {"rates [Hz]", fmt::format("{}", fmt::join(rates, ", "))},
          {"selection", run.selection_text()},
          {"fixed step [Hz]", run.fixed_step ? run.fixed_step->to_string() : ""},
          {"fraction bits", run.fraction_bits ? fmt::to_string(*run.fraction_bits) : ""},
          {"cases, golden", run.cases_version + ", " + run.golden_version},
          {run.suite_is_released ? "released suite, SHA-256" : "custom suite, SHA-256",
           run.suite_sha256},
          {"suite's reference", run.suite_reference}};
}

void add_facts(const RunResult& run, data& page) {
  data list(data::type::list);
  for (const auto& [name, value] : facts_of(run)) {
    if (value.empty()) continue;
    data fact;
    set_text(fact, "name", name);
    set_text(fact, "value", one_line(value));
    list.push_back(fact);
  }
  page.set("facts", list);
}

void add_verdicts(data& page) {
  data list(data::type::list);
  for (int i = 0; i < verdict_count; ++i) {
    const auto verdict = static_cast<Verdict>(i);
    data entry;
    set_text(entry, "verdict", name_of(verdict));
    set_text(entry, "symbol", symbol_of(verdict));
    entry.set("fails", fails_a_run(verdict));
    list.push_back(entry);
  }
  page.set("verdicts", list);
}

// `group` and `rate` select the results of the cell in the list. `group` is "profile/group", or the
// profile in the row of totals; `rate` is a label, or empty in the column of totals.
data cell_to_data(const MatrixCell& cell, const std::string& group, const std::string& rate) {
  data out;
  set_text(out, "group", group);
  set_text(out, "rate", rate);
  MatrixCell compared = cell;
  compared.apart = 0;
  set_text(out, "text", text_of(compared.all() > 0 ? compared : cell));
  if (compared.all() > 0 && cell.apart > 0) set_text(out, "apart", fmt::format("+{}", cell.apart));
  if (!cell.worst) return out;
  set_text(out, "verdict", name_of(*cell.worst));
  set_text(out, "symbol", symbol_of(*cell.worst));
  if (cell.headroom) set_text(out, "headroom", fmt::format("{:.2g}", *cell.headroom));
  return out;
}

data row_to_data(const MatrixRow& row, const std::string& group,
                 const std::vector<LoopRate>& rates) {
  data cells(data::type::list);
  for (std::size_t i = 0; i < rates.size(); ++i) {
    cells.push_back(cell_to_data(row.cells[i], group, rates[i].label()));
  }
  cells.push_back(cell_to_data(row.total, group, ""));
  data out;
  set_text(out, "name", one_line(row.group));
  out.set("cells", cells);
  return out;
}

// Profiles with a failure come first.
std::vector<std::string> profiles_of(const Matrix& matrix) {
  std::vector<std::string> profiles;
  for (const MatrixRow& row : matrix.rows) {
    const bool known = std::find(profiles.begin(), profiles.end(), row.profile) != profiles.end();
    if (!known) profiles.push_back(row.profile);
  }
  std::stable_partition(profiles.begin(), profiles.end(), [&](const std::string& profile) {
    return total_of(matrix, profile).total.failed > 0;
  });
  return profiles;
}

void add_matrices(const RunResult& run, data& page) {
  const Matrix matrix = matrix_of(run);
  const std::vector<std::string> profiles = profiles_of(matrix);
  page.set(
      "matrices", list_of(profiles, [&](const std::string& profile) {
        data rows(data::type::list);
        for (const MatrixRow& row : matrix.rows) {
          if (row.profile != profile) continue;
          const std::string group = one_line(row.profile + "/" + row.group);
          rows.push_back(row_to_data(row, group, matrix.rates));
        }
        rows.push_back(row_to_data(total_of(matrix, profile), one_line(profile), matrix.rates));
        data out;
        set_text(out, "profile", one_line(profile));
        out.set("rates", list_of(matrix.rates, [](const LoopRate& rate) {
                  return data("rate", text(rate.to_string()));
                }));
        out.set("rows", rows);
        return out;
      }));
}

void add_failure(const VectorResult& result, const RunResult& run, data& row) {
  data failure;
  if (result.first) {
    const Deviation& first = *result.first;
    const Channel& channel = channels()[first.channel];
    set_text(failure, "tick", fmt::to_string(first.tick));
    set_text(failure, "time", fmt::to_string(first.timestamp_us));
    set_text(failure, "signal", channel_with_unit(channel));
    set_text(failure, "stage", stages_text(stages_of(first)));
    set_text(failure, "got", value_text(channel, first.got));
    set_text(failure, "want", value_text(channel, first.want));
    set_text(failure, "distance", distance_text(first, run.level));
    set_text(failure, "worst", worst_text(result));
    set_text(failure, "deviating", fmt::to_string(result.deviating_ticks));
  }
  set_text(failure, "reproduce", reproduce_command(result, run));
  if (result.plant_configuration && run.timing.empty()) {
    set_text(failure, "fly", sim_command(result, run));
  }
  row.set("failure", failure);
}

data result_to_data(const VectorResult& result, const RunResult& run) {
  data row;
  set_text(row, "verdict", name_of(result.verdict));
  set_text(row, "group", one_line(result.profile + "/" + result.group));
  set_text(row, "case", one_line(result.name));
  set_text(row, "configuration", one_line(result.configuration().label()));
  set_text(row, "ticks", fmt::to_string(result.ticks));
  if (result.tightest) {
    set_text(row, "headroom", fmt::format("{:.6g}", result.tightest->ratio));
    set_text(row, "tightest", channels()[result.tightest->channel].name);
  }
  const bool is_explained = result.verdict == Verdict::pass || result.first;
  if (!is_explained || !result.reason.empty()) set_text(row, "reason", reason_text(result));
  if (fails_a_run(result.verdict)) add_failure(result, run, row);
  return row;
}

}  // namespace

std::string filled_page(const Report& report) {
  const RunResult& run = report.run;
  data page;
  add_files(page, {{"plots_script", plots_script()},
                   {"details_script", details_script()},
                   {"page_script", page_script()}});
  add_conclusion(run, page);
  add_diagnosis(report.diagnosis, page);
  add_reasons(run, page);
  add_facts(run, page);
  add_verdicts(page);
  add_matrices(run, page);
  page.set("results", list_of(run.results, [&](const VectorResult& result) {
             return result_to_data(result, run);
           }));
  kainjow::mustache::mustache page_of{std::string(page_template())};
  return page_of.render(page);
}

}  // namespace attest
