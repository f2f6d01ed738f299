#include "harness/report/conclusion.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/report/failure_text.hpp"
#include "harness/report/matrix.hpp"
#include "harness/report/text.hpp"
#include "harness/verify/declared_lacks.hpp"

namespace attest {
namespace {

// "9 fail, 2 crash"
std::string failing_verdicts(const RunResult& run) {
  std::vector<std::string> parts;
  for (int i = 0; i < verdict_count; ++i) {
    const auto verdict = static_cast<Verdict>(i);
    if (run.count(verdict) == 0 || !fails_a_run(verdict)) continue;
    parts.push_back(fmt::format("{} {}", run.count(verdict), name_of(verdict)));
  }
  return fmt::format("{}", fmt::join(parts, ", "));
}

std::string setting(const RunResult& run) {
  std::vector<std::string> profiles;
  for (const VectorResult& result : run.results) {
    if (result.verdict == Verdict::skip) continue;
    const std::string profile = one_line(result.profile);
    if (std::find(profiles.begin(), profiles.end(), profile) == profiles.end()) {
      profiles.push_back(profile);
    }
  }
  std::string out = fmt::format("{}", fmt::join(profiles, ", "));
  if (!out.empty()) out += ", ";
  return fmt::format("{}{}, {}", out, name_of(run.level), counted(run.rates.size(), "rate"));
}

// "47 need --level exact, 30 do not apply to this port, 1 skip": what was not judged or expected to
// fail.
std::string counted_apart(const RunResult& run) {
  std::vector<std::pair<std::string, std::size_t>> needs;
  for (const VectorResult& result : run.results) {
    if (result.verdict == Verdict::pass || fails_a_run(result.verdict)) continue;
    std::string what(name_of(result.verdict));
    if (result.exact_only) what = "need --level exact";
    if (!result.applies) what = "do not apply to this port";
    auto known = std::ranges::find(needs, what, &std::pair<std::string, std::size_t>::first);
    if (known == needs.end()) known = needs.emplace(needs.end(), what, 0);
    ++known->second;
  }
  std::vector<std::string> parts;
  for (const auto& [what, count] : needs) parts.push_back(fmt::format("{} {}", count, what));
  return fmt::format("{}", fmt::join(parts, ", "));
}

std::string cases_of(const Together& group) {
  constexpr std::size_t named = 3;
  std::vector<std::string> ids;
  for (const VectorResult* result : group) {
    const std::string id = one_line(result->case_id());
    if (std::find(ids.begin(), ids.end(), id) == ids.end()) ids.push_back(id);
  }
  const std::size_t unnamed = ids.size() - std::min(ids.size(), named);
  ids.resize(ids.size() - unnamed);
  std::string out = fmt::format("{}", fmt::join(ids, ", "));
  if (unnamed > 0) out += fmt::format(" and {} more", unnamed);
  return out;
}

// "  28 do not apply to this port, which need not have all modules:", and a line for each reason.
std::string not_applicable(const RunResult& run) {
  const auto reasons = grouped(
      run, [](const VectorResult& result) { return !result.applies; },
      [](const VectorResult& a, const VectorResult& b) { return a.reason == b.reason; });
  std::size_t count = 0;
  std::string lines;
  for (const Together& group : reasons) {
    count += group.size();
    lines += fmt::format("      {}: {}\n", group.size(), one_line(group.front()->reason));
  }
  return count == 0 ? ""
                    : fmt::format(
                          "  {} do not apply to this port, which need not have all "
                          "modules and profiles:\n{}",
                          count, lines);
}

// `in_part`: some failing vectors have deviations that no suspect explains.
std::string suspect_text(const Suspect& suspect, bool in_part) {
  const faults::Fault& fault = *suspect.fault;
  std::string out = fmt::format(
      "  `{}`: {} ({}; in the stage {})\n"
      "      gives {} in {} of {}\n",
      fault.id, fault.what, fault.kind, name_of(fault.stage),
      in_part ? "all or some of the port's values" : "the port's values", suspect.explained,
      counted(suspect.failing, "failing vector"));
  if (suspect.ambiguity_group.empty()) return out;
  std::vector<std::string> others;
  for (const faults::Fault* other : suspect.ambiguity_group)
    others.push_back(fmt::format("`{}`", other->id));
  return out + fmt::format("      equally well: {}\n", fmt::join(others, ", "));
}

std::string patterns_text(const Diagnosis& diagnosis) {
  std::string out;
  for (const Pattern& pattern : diagnosis.patterns) {
    out += fmt::format("  in the {}\n      in {} of the {} {}\n", pattern_text(pattern),
                       counted(pattern.vectors, "failing vector"),
                       pattern.groups.size() == 1 ? "group" : "groups",
                       fmt::join(pattern.groups, ", "));
  }
  return out;
}

std::string suspects_text(const Diagnosis& diagnosis) {
  if (diagnosis.suspects.empty()) {
    if (diagnosis.failing == 0) return {};
    return fmt::format(
        "it looks like no fault of the catalogue; {} of {} deviate first in the {}\n",
        diagnosis.in_first_stage, counted(diagnosis.failing, "failing vector"),
        stages_text(only(diagnosis.first_stage.value_or(Stage::input))));
  }
  std::string out;
  for (const Suspect& suspect : diagnosis.suspects)
    out += suspect_text(suspect, diagnosis.unexplained > 0);
  return out;
}

// What more failing vectors have in common comes first.
bool begins_with_patterns(const Diagnosis& diagnosis) {
  return !diagnosis.patterns.empty() && !diagnosis.suspects.empty() &&
         diagnosis.patterns.front().vectors > diagnosis.suspects.front().explained;
}

}  // namespace

Conclusion conclusion_of(const RunResult& run) {
  if (run.failed() || !run.errors.empty()) return Conclusion::fail;
  if (run.stopped_early) return Conclusion::stopped;
  return run.count(Verdict::pass) > 0 ? Conclusion::pass : Conclusion::none;
}

std::string conclusion_text(const RunResult& run, std::string_view duration) {
  const auto failed = static_cast<std::size_t>(std::ranges::count_if(
      run.results, [](const VectorResult& result) { return fails_a_run(result.verdict); }));
  const std::size_t passed = run.count(Verdict::pass);
  std::string out = fmt::format("{} passed, 0 failed", counted(passed, "vector"));
  if (failed > 0) {
    const std::string kinds = failing_verdicts(run);
    const bool only_fail = kinds == fmt::format("{} {}", failed, name_of(Verdict::fail));
    out = fmt::format("{} of {} failed{}, {} passed", failed, counted(run.results.size(), "vector"),
                      only_fail ? "" : " (" + kinds + ")", passed);
  }
  if (!run.errors.empty()) out = counted(run.errors.size(), "error") + "; " + out;
  const std::string apart = counted_apart(run);
  if (!apart.empty()) out += "; " + apart;
  out += fmt::format(" ({}){}", setting(run), duration);
  if (run.stopped_early) {
    const std::size_t left = run.selected - std::min(run.selected, run.results.size());
    out += fmt::format("; stopped early, {} of {} not run", left, counted(run.selected, "vector"));
  }
  return out;
}

std::string counted_apart_text(const RunResult& run) {
  std::string out = not_applicable(run);
  for (const Verdict verdict : {Verdict::unsupported, Verdict::skip, Verdict::xfail}) {
    const auto groups = grouped(
        run,
        [verdict](const VectorResult& result) {
          return result.verdict == verdict && result.applies;
        },
        [](const VectorResult& a, const VectorResult& b) { return a.reason == b.reason; });
    for (const Together& group : groups) {
      const std::string reason = one_line(group.front()->reason);
      out += fmt::format("  {} {}: {}\n      {}\n", group.size(), name_of(verdict),
                         reason.empty() ? "no reason given" : reason, cases_of(group));
    }
  }
  return out.empty() ? out : "vectors counted apart, not as conformant:\n" + out + "\n";
}

std::string first_stages(const RunResult& run) {
  std::array<std::size_t, stage_count> counts{};
  for (const VectorResult& result : run.results) {
    if (!fails_a_run(result.verdict) || !result.first) continue;
    ++counts[static_cast<std::size_t>(stage_of(*result.first))];
  }
  std::vector<std::string> parts;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (counts[i] == 0) continue;
    const std::string stage = stages_text(only(static_cast<Stage>(i)));
    parts.push_back(fmt::format("{} in {}", stage, counted(counts[i], "vector")));
  }
  if (parts.empty()) return {};
  return fmt::format("first stage to differ: {}", fmt::join(parts, ", "));
}

std::string pattern_text(const Pattern& pattern) {
  return fmt::format("{}: values {}", name_of(pattern.stage), pattern.values());
}

std::string mistakes_text(const Diagnosis& diagnosis) {
  const std::string suspects = suspects_text(diagnosis), patterns = patterns_text(diagnosis);
  const auto left = [&](const char* unexplaining) {
    return diagnosis.unexplained == 0
               ? std::string()
               : fmt::format("{} of {} have deviations that {} not explain\n",
                             diagnosis.unexplained, counted(diagnosis.failing, "failing vector"),
                             unexplaining);
  };
  std::string out;
  if (diagnosis.suspects.empty()) {
    out = suspects + patterns;
  } else if (begins_with_patterns(diagnosis)) {
    out = left("the faults of the catalogue do") + patterns + "in part it looks like:\n" + suspects;
  } else {
    out = "it looks like:\n" + suspects +
          left(diagnosis.suspects.size() == 1 ? "this does" : "these do") + patterns;
  }
  for (const std::string& remark : diagnosis.remarks) out += remark + "\n";
  return out;
}

std::string specific_case_text(const Diagnosis& diagnosis) {
  if (diagnosis.why.empty()) return {};
  return fmt::format(
      "most specific failing case: {}, which {} of the catalogue would fail\n"
      "  it tests: {}\n",
      diagnosis.specific_case, counted(diagnosis.shown_by_it, "fault"), one_line(diagnosis.why));
}

std::string diagnosis_text(const Diagnosis& diagnosis) {
  return mistakes_text(diagnosis) + specific_case_text(diagnosis);
}

std::string needless_lacks_text(const RunResult& run) {
  const std::vector<std::string> had = needless_lacks(run.results);
  if (had.empty()) return "";
  return fmt::format("the port declares that it lacks {}, but it has {}", fmt::join(had, ", "),
                     had.size() == 1 ? "that" : "them");
}

}  // namespace attest
