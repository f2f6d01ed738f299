#include "harness/verify/expected_failures.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <fnmatch.h>

#include "harness/core/toml.hpp"
#include "harness/port/profiles.hpp"

namespace attest {
namespace {

bool matches(const std::string& pattern, const std::string& vector) {
  const std::string of_case = vector.substr(0, vector.rfind('@'));
  return ::fnmatch(pattern.c_str(), vector.c_str(), 0) == 0 ||
         ::fnmatch(pattern.c_str(), of_case.c_str(), 0) == 0;
}

// The profile that the pattern would excuse as a whole; empty if there is none. The pattern then
// matches all vectors of the profile in `suite`, and an invented vector in a group that the suite
// does not have. Without the invented vector, no pattern could name the only group of a suite.
std::string wholly_excused(const std::string& pattern, const std::vector<std::string>& suite) {
  const auto matches_other_group = [&](const std::string& profile) {
    const std::string id = profile + "/another_group/another_case";
    return matches(pattern, id + "@50hz") && matches(pattern, id + "@250hz");
  };
  std::map<std::string, bool> all_match;
  for (const std::string& profile : known_profile_names()) {
    all_match[profile] = matches_other_group(profile);
  }
  for (const std::string& vector : suite) {
    const std::string profile = vector.substr(0, vector.find('/'));
    const auto [match, is_new] = all_match.try_emplace(profile, true);
    if (is_new) match->second = matches_other_group(profile);
    match->second = match->second && matches(pattern, vector);
  }
  const auto found = std::ranges::find_if(all_match, [](const auto& one) { return one.second; });
  return found == all_match.end() ? "" : found->first;
}

// The verdicts that a reason begins with, as in "crash, timeout: reason". For a reason that begins
// with other text: `fail` and `non-finite`, the verdicts of wrong outputs.
std::vector<Verdict> excused_by(std::string_view reason) {
  const std::vector<Verdict> differences{Verdict::fail, Verdict::non_finite};
  std::vector<Verdict> excused;
  while (true) {
    const std::size_t end = reason.find_first_of(",:");
    const auto verdict = parse_verdict(reason.substr(0, end));
    if (end == std::string_view::npos || !verdict) return differences;
    if (!fails_a_run(*verdict) || *verdict == Verdict::xpass) return differences;
    excused.push_back(*verdict);
    if (reason[end] == ':') return excused;
    reason.remove_prefix(end + 1);
    reason.remove_prefix(std::min(reason.find_first_not_of(' '), reason.size()));
  }
}

std::string names_of(const std::vector<Verdict>& verdicts) {
  std::vector<std::string_view> names;
  for (const Verdict verdict : verdicts) names.push_back(name_of(verdict));
  return fmt::format("{}", fmt::join(names, ", "));
}

std::string with_reason_of(const VectorResult& result, const std::string& text) {
  return fmt::format("{}{}{}", text, result.reason.empty() ? "" : "; ", result.reason);
}

}  // namespace

bool ExpectedFailure::excuses(Verdict verdict) const {
  return std::ranges::find(excused, verdict) != excused.end();
}

Result<ExpectedFailures> ExpectedFailures::read(const std::filesystem::path& file,
                                                const std::vector<std::string>& suite) {
  auto toml = TomlFile::read(file);
  if (!toml) return tl::unexpected(toml.error());
  ExpectedFailures expected;
  expected.file_ = file;
  const TomlTable table = toml->root().table("expected");
  for (const std::string& pattern : table.keys()) {
    const std::string reason = table.text(pattern);
    if (reason.empty()) table.error(pattern, "needs a reason");
    if (const auto profile = wholly_excused(pattern, suite); !profile.empty()) {
      table.error(pattern, fmt::format("`{}` would excuse every case of {}; name a group or a case",
                                       pattern, profile));
    }
    expected.entries_.push_back({pattern, reason, excused_by(reason)});
  }
  if (auto done = toml->finish(); !done) return tl::unexpected(done.error());
  return expected;
}

bool ExpectedFailures::expects(const VectorResult& result) const {
  return std::ranges::any_of(entries_, [&](const ExpectedFailure& entry) {
    return entry.excuses(result.verdict) && matches(entry.pattern, result.id());
  });
}

void ExpectedFailures::expect(VectorResult& result, std::vector<bool>& used) const {
  // The first matching entry that excuses the verdict, else the first matching entry.
  const ExpectedFailure* entry = nullptr;
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    if (!matches(entries_[i].pattern, result.id())) continue;
    used[i] = true;
    const bool is_better =
        entry != nullptr && !entry->excuses(result.verdict) && entries_[i].excuses(result.verdict);
    if (entry == nullptr || is_better) entry = &entries_[i];
  }
  if (entry == nullptr) return;
  if (result.verdict == Verdict::pass) {
    result.verdict = Verdict::xpass;
    result.reason = "expected to fail: " + entry->reason;
  } else if (entry->excuses(result.verdict)) {
    result.verdict = Verdict::xfail;
    result.reason = with_reason_of(result, entry->reason);
  } else if (fails_a_run(result.verdict)) {
    result.reason =
        with_reason_of(result, fmt::format("the list of expected failures excuses {} here, not {}",
                                           names_of(entry->excused), name_of(result.verdict)));
  }
}

void ExpectedFailures::apply(bool complete, RunResult& run) const {
  std::vector<bool> used(entries_.size(), false);
  for (VectorResult& result : run.results) expect(result, used);
  for (std::size_t i = 0; complete && i < entries_.size(); ++i) {
    if (used[i]) continue;
    run.errors.push_back({fmt::format("`{}` is no case that was run; case ids never change "
                                      "meaning, so remove it or correct it",
                                      entries_[i].pattern),
                          file_.string()});
  }
}

std::string expected_failures_of(const RunResult& run) {
  struct Count {
    std::size_t all = 0;
    std::vector<const VectorResult*> failed;
  };
  std::map<std::string, Count> cases;
  for (const VectorResult& result : run.results) {
    Count& count = cases[result.case_id()];
    ++count.all;
    const bool fails = fails_a_run(result.verdict) && result.verdict != Verdict::xpass;
    if (fails || result.verdict == Verdict::xfail) count.failed.push_back(&result);
  }
  TomlWriter toml;
  const auto reason = [](const std::vector<const VectorResult*>& failed) {
    std::vector<Verdict> verdicts;
    for (const VectorResult* result : failed) {
      if (result->verdict == Verdict::xfail) {  // in a merged report: what its list excused
        std::ranges::copy(excused_by(result->reason), std::back_inserter(verdicts));
      } else {
        verdicts.push_back(result->verdict);
      }
    }
    std::ranges::sort(verdicts);
    verdicts.erase(std::unique(verdicts.begin(), verdicts.end()), verdicts.end());
    return fmt::format("{}: say why this is accepted, and until when", names_of(verdicts));
  };
  for (const auto& [id, count] : cases) {
    if (count.failed.empty()) continue;
    if (run.all_configurations && run.shard.count == 1 && count.failed.size() == count.all) {
      toml.set("expected", id + "@*", reason(count.failed));
      continue;
    }
    for (const VectorResult* result : count.failed) {
      toml.set("expected", result->id(), reason({result}));
    }
  }
  return toml.to_string();
}

}  // namespace attest
