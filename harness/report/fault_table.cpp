#include "harness/report/fault_table.hpp"

#include <algorithm>
#include <map>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/port/profiles.hpp"
#include "harness/report/conclusion.hpp"
#include "harness/report/text.hpp"

namespace attest {
namespace {

std::string caught_by(const FaultFinding& finding) {
  if (!finding.is_detectable()) {
    if (finding.fault->equivalent.empty()) return "the profile does not have this";
    return fmt::format("equivalent: {}", finding.fault->equivalent);
  }
  if (!finding.is_caught()) return "**survives**";
  std::string id = finding.found.by;
  const std::string profile = finding.profile + "/";
  if (id.starts_with(profile)) id.erase(0, profile.size());
  return id;
}

std::string tick_of(const FaultFinding& finding) {
  return finding.found.tick ? fmt::format("{}", *finding.found.tick) : "";
}

std::string naive(const FaultFinding& finding) {
  if (finding.by_hover && finding.by_random_attitudes) return "both";
  if (finding.by_hover) return "hover";
  return finding.by_random_attitudes ? "attitudes" : "";
}

// In the order in which the groups first occur.
std::vector<std::pair<std::string_view, std::vector<FaultFinding>>> by_group(
    const std::vector<FaultFinding>& findings) {
  std::vector<std::pair<std::string_view, std::vector<FaultFinding>>> groups;
  for (const FaultFinding& finding : findings) {
    const auto same = std::find_if(groups.begin(), groups.end(), [&](const auto& known) {
      return known.first == finding.fault->group;
    });
    if (same != groups.end())
      same->second.push_back(finding);
    else
      groups.push_back({finding.fault->group, {finding}});
  }
  return groups;
}

double percent(std::size_t part, std::size_t whole) {
  return whole == 0 ? 100 : 100 * static_cast<double>(part) / static_cast<double>(whole);
}

// For how many faults the report of most failing vectors names the stage.
std::string stage_lines(const std::vector<SelfDiagnosis>& results, const std::string& profile) {
  const auto count = [&](StageLine line) {
    return std::ranges::count_if(results, [line](const SelfDiagnosis& result) {
      return !result.stage_lines.empty() && result.usual_stage_line() == line;
    });
  };
  std::string out;
  for (const SelfDiagnosis& result : results) {
    const auto& lines = result.stage_lines;
    if (lines.empty() || result.usual_stage_line() != StageLine::wrong) continue;
    out += fmt::format("{}: most reports do not name the stage {}\n", result.fault->id,
                       name_of(result.fault->stage));
  }
  return out +
         fmt::format(
             "{}: \"look first at\" names the stage of {} faults; of {} more, whose stage has "
             "no output, it names a later stage; of {} another stage\n",
             profile, count(StageLine::own), count(StageLine::later), count(StageLine::wrong));
}

// How the reference deviates from a log, and the faults that agree with it.
std::string faults_like_log(const std::string& log, const std::string& profile,
                            const ReferenceOnLog& reference,
                            const std::vector<FaultFinding>& findings) {
  std::string out = fmt::format(
      "{}: the reference does not agree with {}, so it does not show which faults {} can have\n",
      log, reference.any_passes ? "a unit of this log" : "this log",
      reference.any_passes ? "this unit of a port" : "a port");
  for (const std::string& deviation : reference.deviations) {
    out += fmt::format("  {}\n", one_line(deviation));
  }
  std::string rows;
  std::size_t count = 0;
  for (const FaultFinding& finding : findings) {
    if (!finding.found.agrees_with_log) continue;
    rows += fmt::format("| `{}` | {} |\n", finding.fault->id, finding.fault->what);
    ++count;
  }
  if (count > 0) out += "\n| agrees with the log | what it does |\n|---|---|\n" + rows + "\n";
  return out + fmt::format("{}: of {} faults of {}, {} {} with the log\n", log, findings.size(),
                           profile, count, count == 1 ? "agrees" : "agree");
}

}  // namespace

bool FaultFinding::is_detectable() const { return fault->is_detectable(profile); }

bool FaultFinding::is_caught_by_own_group() const {
  const std::string own = profile + "/" + std::string(fault->group) + "/";
  return is_caught() && found.by.starts_with(own);
}

std::vector<const faults::Fault*> detectable(std::vector<const faults::Fault*> faults,
                                             const std::vector<std::string>& profiles) {
  std::erase_if(faults, [&](const faults::Fault* fault) {
    return std::ranges::none_of(
        profiles, [&](const std::string& profile) { return fault->is_detectable(profile); });
  });
  return faults;
}

FaultSummary summary_of(const std::vector<FaultFinding>& findings) {
  FaultSummary summary;
  for (const FaultFinding& finding : findings) {
    if (!finding.is_detectable()) {
      if (finding.is_caught()) summary.false_alarms.push_back(&finding);
      continue;
    }
    ++summary.detectable;
    summary.caught += finding.is_caught() ? 1 : 0;
    summary.by_hover += finding.by_hover ? 1 : 0;
    summary.by_random_attitudes += finding.by_random_attitudes ? 1 : 0;
    summary.by_naive += finding.by_hover || finding.by_random_attitudes ? 1 : 0;
    if (!finding.is_caught()) summary.survivors.push_back(&finding);
    if (finding.is_caught() && !finding.is_caught_by_own_group()) {
      summary.not_by_own.push_back(&finding);
    }
  }
  return summary;
}

std::vector<std::string> wrong_of_suite(const std::vector<FaultFinding>& findings) {
  const FaultSummary summary = summary_of(findings);
  std::vector<std::string> lines;
  for (const FaultFinding* finding : summary.survivors) {
    lines.push_back(fmt::format("survives: {}: {}", finding->fault->id, finding->fault->what));
  }
  for (const FaultFinding* finding : summary.not_by_own) {
    lines.push_back(fmt::format("not caught by its group {}: {}: {}", finding->fault->group,
                                finding->fault->id, finding->fault->what));
  }
  for (const FaultFinding* finding : summary.false_alarms) {
    lines.push_back(fmt::format("listed as equivalent, but caught: {} by {}", finding->fault->id,
                                finding->found.by));
  }
  return lines;
}

std::string render_fault_table(const std::vector<FaultFinding>& findings) {
  std::string out =
      "| group | faults | caught by it | by any | by a naive suite |\n|---|---|---|---|---|\n";
  for (const auto& [group, of_group] : by_group(findings)) {
    const FaultSummary of = summary_of(of_group);
    out += fmt::format("| {} | {} | {} | {} | {} |\n", group, of.detectable,
                       of.caught - of.not_by_own.size(), of.caught, of.by_naive);
  }
  out +=
      "\n| fault | stage | what it does | first caught by | at tick | naive suite |\n"
      "|---|---|---|---|---|---|\n";
  for (const FaultFinding& finding : findings) {
    out += fmt::format("| `{}` | {} | {} | {} | {} | {} |\n", finding.fault->id,
                       name_of(finding.fault->stage), finding.fault->what, caught_by(finding),
                       tick_of(finding), naive(finding));
  }
  const FaultSummary summary = summary_of(findings);
  out += fmt::format(
      "\n{}: {} faults; {} of {} detectable faults are caught ({:.1f}%), {} by their own group; {} "
      "are equivalent to the law. A hover trace catches {} ({:.0f}%), random attitude "
      "pairs {} ({:.0f}%), both together {} ({:.0f}%).\n",
      findings.empty() ? "" : findings.front().profile, findings.size(), summary.caught,
      summary.detectable, percent(summary.caught, summary.detectable),
      summary.caught - summary.not_by_own.size(), findings.size() - summary.detectable,
      summary.by_hover, percent(summary.by_hover, summary.detectable), summary.by_random_attitudes,
      percent(summary.by_random_attitudes, summary.detectable), summary.by_naive,
      percent(summary.by_naive, summary.detectable));
  return out;
}

std::string render_hunted_faults(const std::vector<FaultFinding>& findings,
                                 const std::vector<std::size_t>& steps) {
  const std::size_t most = std::ranges::max(steps);
  std::string out = "| fault | what it does | suite |", rule = "|---|---|---|";
  for (const std::size_t count : steps) {
    out += fmt::format(" hunt, {} |", counted(count, "step"));
    rule += "---|";
  }
  out += "\n" + rule + "\n";
  std::map<std::size_t, std::size_t> found_in;
  std::vector<std::string_view> only_suite, only_hunt, neither;
  for (const FaultFinding& finding : findings) {
    if (!finding.is_detectable()) continue;
    const std::string_view id = finding.fault->id;
    out += fmt::format("| `{}` | {} | {} |", id, finding.fault->what, caught_by(finding));
    for (const std::size_t count : steps) {
      const bool is_found = finding.hunted.is_found_in(count);
      found_in[count] += is_found ? 1 : 0;
      out += is_found ? " found |" : " |";
    }
    out += "\n";
    const bool is_found = finding.hunted.is_found_in(most);
    if (!is_found) (finding.is_caught() ? only_suite : neither).push_back(id);
    if (is_found && !finding.is_caught()) only_hunt.push_back(id);
  }
  const FaultSummary summary = summary_of(findings);
  out += fmt::format("\n{}: of {} detectable faults the suite catches {}",
                     findings.empty() ? "" : findings.front().profile, summary.detectable,
                     summary.caught);
  for (const std::size_t count : steps) {
    out += fmt::format(", a hunt of {} {}", counted(count, "step"), found_in[count]);
  }
  out += fmt::format("; neither catches {}.\n", neither.size());
  const auto add = [&](const char* by, const std::vector<std::string_view>& ids) {
    if (!ids.empty()) out += fmt::format("{}: `{}`.\n", by, fmt::join(ids, "`, `"));
  };
  add("Only by the suite", only_suite);
  add("Only by a hunt", only_hunt);
  add("By neither", neither);
  return out;
}

std::string render_self_diagnoses(const std::vector<SelfDiagnosis>& results,
                                  const std::string& profile) {
  std::string out;
  for (const SelfDiagnosis& result : results) {
    if (result.is_named()) continue;
    out += fmt::format(
        "{} is not named; the diagnosis is:\n{}", result.fault->id,
        result.diagnosis ? diagnosis_text(*result.diagnosis) : "no deviation from the law\n");
  }
  const auto named =
      static_cast<std::size_t>(std::ranges::count_if(results, &SelfDiagnosis::is_named));
  out += fmt::format(
      "{}: {} of {} faults are named first, alone or with faults that match equally well "
      "({:.1f}%); the stage of {} is named\n",
      profile, named, results.size(), percent(named, results.size()),
      std::ranges::count_if(results, &SelfDiagnosis::is_stage_named));
  return out + stage_lines(results, profile);
}

std::string render_faults_of_log(const std::string& log, const std::string& profile,
                                 const ReferenceOnLog& reference,
                                 const std::vector<FaultFinding>& findings) {
  if (!reference.any_passes) return faults_like_log(log, profile, reference, findings);
  std::string out = "| group | faults | shown |\n|---|---|---|\n";
  for (const auto& [group, of_group] : by_group(findings)) {
    const FaultSummary of = summary_of(of_group);
    out += fmt::format("| {} | {} | {} |\n", group, of.detectable, of.caught);
  }
  out += "\n| fault | what it does | fails in the | at step |\n|---|---|---|---|\n";
  for (const FaultFinding& finding : findings) {
    out += fmt::format("| `{}` | {} | {} | {} |\n", finding.fault->id, finding.fault->what,
                       finding.is_caught() ? finding.found.by : "", tick_of(finding));
  }
  const FaultSummary summary = summary_of(findings);
  out +=
      fmt::format("\n{}: of {} faults of {}, {} fail ({:.0f}%).{}\n", log, summary.detectable,
                  profile, summary.caught, percent(summary.caught, summary.detectable),
                  reference.agrees() ? " A port can have the others and agree with this log." : "");
  return reference.agrees() ? out : out + "\n" + faults_like_log(log, profile, reference, findings);
}

std::string render_fault_list(const std::vector<const faults::Fault*>& faults) {
  std::string out;
  for (const faults::Fault* fault : faults) {
    std::string profiles;
    for (const ProfileInfo& profile : known_profiles()) {
      if (!fault->is_detectable(profile.name)) continue;
      profiles += fmt::format("{}{}", profiles.empty() ? "" : " ", profile.name);
    }
    out += fmt::format("{:<36} {:<17} {:<16} {:<22} {}\n", fault->id, fault->group,
                       name_of(fault->stage), profiles, fault->what);
  }
  return out;
}

}  // namespace attest
