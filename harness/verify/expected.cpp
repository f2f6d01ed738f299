#include "harness/verify/expected.hpp"

#include <algorithm>
#include <map>
#include <string_view>

#include <fmt/format.h>
#include <fnmatch.h>

#include "harness/core/toml.hpp"
#include "harness/port/profiles.hpp"

namespace attest {
namespace {

bool matches(const std::string& pattern, const CaseResult& result) {
  const auto matches_name = [&](const std::string& name) {
    return ::fnmatch(pattern.c_str(), name.c_str(), 0) == 0;
  };
  return matches_name(result.id()) || matches_name(result.case_id());
}

// A pattern that matches a case of any group and name would excuse every mistake of a port,
// including later ones.
bool excuses_everything(const std::string& pattern) {
  constexpr const char* of_no_group = "\x01/\x01";
  const auto profiles = known_profile_names();
  return std::any_of(profiles.begin(), profiles.end(), [&](const std::string& profile) {
    const std::string id = fmt::format("{}/{}", profile, of_no_group);
    return ::fnmatch(pattern.c_str(), id.c_str(), 0) == 0 ||
           ::fnmatch(pattern.c_str(), (id + "@\x01").c_str(), 0) == 0;
  });
}

void expect(const ExpectedFailure& entry, CaseResult& result) {
  if (result.verdict == Verdict::pass) {
    result.verdict = Verdict::xpass;
    result.reason = "expected to fail: " + entry.reason;
  } else if (fails_a_run(result.verdict)) {
    result.reason =
        fmt::format("{}{}{}", entry.reason, result.reason.empty() ? "" : "; ", result.reason);
    result.verdict = Verdict::xfail;
  }
}

}  // namespace

Result<ExpectedFailures> ExpectedFailures::read(const std::filesystem::path& file) {
  auto toml = TomlFile::read(file);
  if (!toml) return tl::unexpected(toml.error());
  ExpectedFailures expected;
  expected.file_ = file;
  const TomlTable table = toml->root().table("expected");
  for (const std::string& pattern : table.keys()) {
    const std::string reason = table.text(pattern);
    if (reason.empty()) table.error(pattern, "needs a reason");
    if (excuses_everything(pattern)) {
      table.error(pattern, fmt::format("`{}` would excuse every case of a profile; name a group or "
                                       "a case",
                                       pattern));
    }
    expected.entries_.push_back({pattern, reason});
  }
  if (auto done = toml->finish(); !done) return tl::unexpected(done.error());
  return expected;
}

bool ExpectedFailures::expects(const CaseResult& result) const {
  return std::any_of(entries_.begin(), entries_.end(),
                     [&](const ExpectedFailure& entry) { return matches(entry.pattern, result); });
}

void ExpectedFailures::apply(bool complete, RunResult& run) const {
  for (const ExpectedFailure& entry : entries_) {
    bool found = false;
    for (CaseResult& result : run.results) {
      if (!matches(entry.pattern, result)) continue;
      found = true;
      const bool judged = result.verdict == Verdict::xfail || result.verdict == Verdict::xpass;
      if (!judged) expect(entry, result);
    }
    if (!found && complete) {
      run.errors.push_back({fmt::format("`{}` is no case that was run; case ids never change "
                                        "meaning, so remove it or correct it",
                                        entry.pattern),
                            file_.string()});
    }
  }
}

std::string expected_failures_of(const RunResult& run) {
  struct Count {
    std::size_t all = 0;
    std::vector<const CaseResult*> failed;
  };
  std::map<std::string, Count> cases;
  for (const CaseResult& result : run.results) {
    Count& count = cases[result.case_id()];
    ++count.all;
    const bool fails = fails_a_run(result.verdict) && result.verdict != Verdict::xpass;
    if (fails || result.verdict == Verdict::xfail) count.failed.push_back(&result);
  }
  TomlWriter toml;
  const auto reason = [](const CaseResult& result) {
    return fmt::format("{}: say why this is accepted, and until when", name_of(result.verdict));
  };
  for (const auto& [id, count] : cases) {
    if (count.failed.empty()) continue;
    if (run.all_configurations && run.shard.count == 1 && count.failed.size() == count.all) {
      toml.set("expected", id + "@*", reason(*count.failed.front()));
      continue;
    }
    for (const CaseResult* result : count.failed) {
      toml.set("expected", result->id(), reason(*result));
    }
  }
  return toml.to_string();
}

}  // namespace attest
