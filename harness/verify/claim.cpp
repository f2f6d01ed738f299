#include "harness/verify/claim.hpp"

#include <algorithm>
#include <map>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/port/profiles.hpp"

namespace attest {
namespace {

// Whether the group is of an optional module, such as `mixer`. Its cases are in a group of that
// name.
bool is_module(const std::string& group) {
  const auto module = module_named(group);
  return module && !info_of(*module).is_unit();
}

// The number of vectors of a group at a rate. `good`: those that passed, and those that were
// skipped because they are compared at the exact level only.
struct Tally {
  std::size_t in_suite = 0, run = 0, good = 0;
};

struct Group {
  std::map<LoopRate, Tally> rates;
  bool passes = false, fails = false;
  std::set<std::string> silent;  // topics that its vectors need and the port did not publish
  // `skipped` is without the `good` vectors, `unsupported` without is_of_another_step().
  std::size_t unsupported = 0, skipped = 0, expected_failures = 0;

  bool was_run() const {
    return std::any_of(rates.begin(), rates.end(),
                       [](const auto& rate) { return rate.second.run > 0; });
  }
  bool was_compared() const { return passes || fails || expected_failures > 0; }
};

using Groups = std::map<std::string, Group>;

bool has_step(const LoopRate& rate, const Rate& step) {
  return rate.motor_unit == step && rate.attitude_unit.value_or(step) == step;
}

// Whether a fixed step of the port excludes the rate of the result. Such results do not count as
// unsupported, because the claim names the fixed step.
bool is_of_another_step(const VectorResult& result, const RunResult& run) {
  return run.fixed_step && !has_step(result.rate, *run.fixed_step) &&
         result.verdict == Verdict::unsupported;
}

void add(const VectorResult& result, const RunResult& run, Group& group) {
  Tally& tally = group.rates[result.rate];
  ++tally.run;
  const bool is_exact_only =
      result.verdict == Verdict::skip && run.level != Level::exact && result.exact_only;
  if (result.verdict == Verdict::pass || is_exact_only) ++tally.good;
  group.passes = group.passes || result.verdict == Verdict::pass;
  group.fails = group.fails || fails_a_run(result.verdict);
  if (result.verdict == Verdict::xfail) ++group.expected_failures;
  group.silent.insert(result.silent.begin(), result.silent.end());
  if (result.verdict == Verdict::skip && !is_exact_only) ++group.skipped;
  if (result.verdict == Verdict::unsupported && !is_of_another_step(result, run)) {
    ++group.unsupported;
  }
}

std::map<std::string, Groups> groups_of(const RunResult& run) {
  std::map<std::string, Groups> profiles;
  for (const auto& [name, rates] : run.suite) {
    const std::size_t slash = name.find('/');
    Group& group = profiles[name.substr(0, slash)][name.substr(slash + 1)];
    for (const auto& [rate, cases] : rates) group.rates[rate].in_suite = cases;
  }
  for (const VectorResult& result : run.results) {
    add(result, run, profiles[result.profile][result.group]);
  }
  return profiles;
}

bool was_judged(const Groups& groups) {
  return std::any_of(groups.begin(), groups.end(),
                     [](const auto& group) { return group.second.was_compared(); });
}

// Whether a vector of the group passed, and all its vectors are good at the rates that were run.
// For a port with a fixed step only the vectors at that rate count.
bool is_whole(const Group& group, const RunResult& run) {
  const std::set<LoopRate> selected(run.rates.begin(), run.rates.end());
  return group.passes && std::all_of(group.rates.begin(), group.rates.end(), [&](const auto& each) {
           const auto& [rate, tally] = each;
           if (run.fixed_step ? !has_step(rate, *run.fixed_step) : !selected.contains(rate)) {
             return true;
           }
           return tally.good >= std::max(tally.in_suite, tally.run);
         });
}

// Adds "3 vectors unsupported (modes, tpa)" to `missing`, unless the count is 0.
void say(const Groups& groups, std::size_t Group::*count, const char* singular, const char* plural,
         std::vector<std::string>& missing) {
  std::size_t all = 0;
  std::vector<std::string> names;
  for (const auto& [name, group] : groups) {
    if (is_module(name) || group.*count == 0) continue;
    all += group.*count;
    names.push_back(name);
  }
  if (all == 0) return;
  missing.push_back(
      fmt::format("{} {} ({})", all, all == 1 ? singular : plural, fmt::join(names, ", ")));
}

// Up to four names: "100, 250 Hz". More names do not fit into a line, so they are counted:
// "19 groups".
std::string few_or_counted(const std::vector<std::string>& names, std::string_view unit,
                           std::string_view noun) {
  constexpr std::size_t few = 4;
  if (names.size() > few) return fmt::format("{} {}", names.size(), noun);
  return fmt::format("{}{}", fmt::join(names, ", "), unit);
}

// Adds the selection, the groups and the rates of which no vector was run, and the number of
// vectors that were not run. Optional modules do not count.
void say_what_was_not_run(const Groups& groups, const RunResult& run,
                          std::vector<std::string>& missing) {
  std::vector<std::string> names, rates;
  std::map<LoopRate, std::size_t> run_at;
  std::size_t left_out = 0;
  for (const auto& [name, group] : groups) {
    if (is_module(name)) continue;
    if (!group.was_run()) names.push_back(name);
    for (const auto& [rate, tally] : group.rates) {
      run_at[rate] += tally.run;
      left_out += tally.in_suite - std::min(tally.in_suite, tally.run);
    }
  }
  for (const auto& [rate, cases] : run_at) {
    if (cases == 0) rates.push_back(rate.to_string());
  }
  if (left_out == 0) return;
  if (const std::string part = run.selection_text(); !part.empty()) {
    missing.push_back("only " + part);
  }
  if (!names.empty()) missing.push_back("no vector of " + few_or_counted(names, "", "groups"));
  if (!rates.empty()) missing.push_back("no vector at " + few_or_counted(rates, " Hz", "rates"));
  missing.push_back(
      fmt::format("{} not run", left_out == 1 ? "1 vector" : fmt::format("{} vectors", left_out)));
}

// Adds the groups of which all vectors were run, but no outputs were compared.
void say_what_was_not_compared(const Groups& groups, std::vector<std::string>& missing) {
  std::vector<std::string> names;
  for (const auto& [name, group] : groups) {
    const bool is_said = group.unsupported + group.skipped > 0;
    if (!is_module(name) && group.was_run() && !group.was_compared() && !is_said) {
      names.push_back(name);
    }
  }
  if (!names.empty())
    missing.push_back("no output compared of " + few_or_counted(names, "", "groups"));
}

// "sign-flip 1.0" of "sign-flip 1.0 (lib:./mine.so, SHA-256 ab12...)", for each port of the text.
std::string without_files(std::string_view ports) {
  constexpr std::string_view between = "; ";
  std::string names;
  while (true) {
    const std::size_t end = ports.find(between);
    const std::string_view port = ports.substr(0, end);
    names += port.substr(0, port.find(" ("));
    if (end == std::string_view::npos) return names;
    names += between;
    ports.remove_prefix(end + between.size());
  }
}

// Whether the port has no unit of the profile, so that its optional modules are all that it is.
bool has_modules_only(const std::string& profile, const RunResult& run) {
  const ProfileInfo* const known = find_profile(profile);
  return known && std::ranges::none_of(modules(), [&](const ModuleInfo& info) {
           return info.is_unit() && contains(known->modules & run.port_modules, info.module);
         });
}

// Adds the optional modules of which some vectors were not run or are not good, although none
// failed.
void say_which_modules_are_in_part(const Groups& groups, std::vector<std::string>& missing) {
  for (const auto& [name, group] : groups) {
    const bool has_all = std::ranges::all_of(
        group.rates, [](const auto& rate) { return rate.second.good >= rate.second.in_suite; });
    if (!is_module(name) || !group.was_compared() || group.fails || has_all) continue;
    missing.push_back("only a part of " + name);
  }
}

std::vector<std::string> missing_of(const Groups& groups, const RunResult& run,
                                    bool is_of_modules) {
  std::vector<std::string> missing;
  if (!run.suite_is_released) {
    missing.push_back(run.suite_reference.empty()
                          ? "custom suite"
                          : "custom suite, reference " + without_files(run.suite_reference));
  }
  if (!run.limits.own_process) missing.emplace_back("port not isolated: --in-process");
  for (const ParameterChange& parameter : run.parameters) {
    missing.push_back(fmt::format("with {}={}", parameter.name, parameter.value));
  }
  if (run.lacks.any()) {
    missing.push_back(fmt::format("lacks {}", fmt::join(run.lacks.words, ", ")));
  }
  std::set<std::string> silent;
  for (const auto& [name, group] : groups) silent.insert(group.silent.begin(), group.silent.end());
  if (!silent.empty()) {
    missing.push_back(fmt::format("does not publish {}", fmt::join(silent, ", ")));
  }
  if (!run.timing.empty()) missing.emplace_back("at recorded times");
  if (run.fixed_step) {
    missing.push_back(fmt::format("fixed step of {} Hz", run.fixed_step->to_string()));
  }
  if (is_of_modules) {
    say_which_modules_are_in_part(groups, missing);
    return missing;
  }
  say_what_was_not_run(groups, run, missing);
  if (!run.fixed_step) say_what_was_not_compared(groups, missing);
  say(groups, &Group::unsupported, "vector unsupported", "vectors unsupported", missing);
  say(groups, &Group::skipped, "vector skipped", "vectors skipped", missing);
  say(groups, &Group::expected_failures, "expected failure", "expected failures", missing);
  return missing;
}

Claim claim_of(const std::string& profile, const Groups& groups, const RunResult& run) {
  Claim claim;
  claim.profile = profile;
  claim.level = run.level;
  claim.has_all_groups = true;
  claim.is_of_modules = has_modules_only(profile, run);
  for (const auto& [name, group] : groups) {
    const bool whole = is_whole(group, run);
    if (group.fails) claim.failing.push_back(name);
    if (!is_module(name)) claim.has_all_groups = claim.has_all_groups && whole && !group.fails;
    if (group.fails || !(whole || group.passes)) continue;
    if (!is_module(name)) {
      (whole ? claim.whole : claim.in_part).push_back(name);
    } else if (whole) {
      claim.modules.push_back(name);
    }
  }
  claim.missing = missing_of(groups, run, claim.is_of_modules);
  const bool is_empty = claim.whole.empty() && claim.modules.empty();
  if (is_empty && claim.missing.empty()) claim.missing.emplace_back("no vector passed");
  return claim;
}

}  // namespace

std::vector<Claim> claims_of(const RunResult& run) {
  std::vector<Claim> claims;
  for (const auto& [profile, groups] : groups_of(run)) {
    if (was_judged(groups)) claims.push_back(claim_of(profile, groups, run));
  }
  return claims;
}

std::string_view name_of(Standing standing) {
  switch (standing) {
    case Standing::conformant:
      return "conformant";
    case Standing::events_agree:
      return "events agree";
    case Standing::partial:
      return "partial";
    case Standing::none:
      break;
  }
  return "none";
}

Standing standing_of(const RunResult& run) {
  const bool is_complete = !run.failed() && run.errors.empty() && !run.stopped_early;
  if (!is_complete || run.count(Verdict::pass) == 0) return Standing::none;
  if (!std::ranges::any_of(claims_of(run), &Claim::is_complete)) return Standing::partial;
  return run.level == Level::events ? Standing::events_agree : Standing::conformant;
}

}  // namespace attest
