#include "harness/report/conclusion.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/report/text.hpp"

namespace attest {
namespace {

// "9 fail, 2 crash", of the verdicts for which `wanted` is true.
template <typename Wanted>
std::string verdict_counts(const RunResult& run, Wanted wanted) {
  std::vector<std::string> parts;
  for (int i = 0; i < verdict_count; ++i) {
    const auto verdict = static_cast<Verdict>(i);
    if (run.count(verdict) == 0 || !wanted(verdict)) continue;
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

}  // namespace

Conclusion conclusion_of(const RunResult& run) {
  if (run.failed() || !run.errors.empty()) return Conclusion::fail;
  return run.count(Verdict::pass) > 0 ? Conclusion::pass : Conclusion::none;
}

std::string_view name_of(Conclusion conclusion) {
  switch (conclusion) {
    case Conclusion::pass:
      return "PASS";
    case Conclusion::fail:
      return "FAIL";
    case Conclusion::none:
      break;
  }
  return "NONE";
}

std::string conclusion_text(const RunResult& run, std::string_view duration) {
  std::string out;
  const auto failed = static_cast<std::size_t>(
      std::count_if(run.results.begin(), run.results.end(),
                    [](const VectorResult& result) { return fails_a_run(result.verdict); }));
  if (failed > 0) {
    const std::string kinds = verdict_counts(run, fails_a_run);
    const bool only_fail = kinds == fmt::format("{} {}", failed, name_of(Verdict::fail));
    out += fmt::format("{} failed{}; ", failed, only_fail ? "" : fmt::format(" ({})", kinds));
  }
  if (!run.errors.empty()) out += counted(run.errors.size(), "error") + "; ";
  out += fmt::format("{} of {} conform", run.count(Verdict::pass),
                     counted(run.results.size(), "vector"));
  const std::string apart = verdict_counts(
      run, [](Verdict verdict) { return verdict != Verdict::pass && !fails_a_run(verdict); });
  if (!apart.empty()) out += ", " + apart;
  out += fmt::format(" ({}){}", setting(run), duration);
  if (run.stopped_early) out += "; stopped early, the rest was not run";
  return out;
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
    parts.push_back(fmt::format("{} in {}", name_of(static_cast<Stage>(i)), counts[i]));
  }
  if (parts.empty()) return {};
  return fmt::format("first stage to differ: {}", fmt::join(parts, ", "));
}

}  // namespace attest
