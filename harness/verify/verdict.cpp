#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "harness/verify/run_result.hpp"

namespace attest {
namespace {

struct VerdictWord {
  std::string_view word;
  bool fails_a_run;
  std::string_view meaning;
};

// In the order of Verdict.
constexpr std::array<VerdictWord, verdict_count> verdicts{{
    {"pass", false, "agrees with the reference"},
    {"fail", true, "differs from the reference"},
    {"crash", true, "the port's process died"},
    {"timeout", true, "the port did not answer in time"},
    {"protocol", true, "the port broke the rules of the ABI"},
    {"non-finite", true, "NaN or infinity where the reference has a number"},
    {"unsupported", false, "the port does not do this"},
    {"skip", false, "not run"},
    {"xfail", false, "failed, as expected"},
    {"xpass", true, "passed although it is listed as an expected failure"},
}};

const VerdictWord& word_of(Verdict verdict) { return verdicts[static_cast<std::size_t>(verdict)]; }

// In the orders of Conclusion and RowVerdict.
constexpr std::array<std::string_view, conclusion_count> conclusions{"pass", "fail",     "partial",
                                                                     "none", "measured", "stopped"};
constexpr std::array<std::string_view, row_verdict_count> row_verdicts{
    "agrees", "differs", "within", "missed", "not judged"};

}  // namespace

std::string_view name_of(Verdict verdict) { return word_of(verdict).word; }
std::string_view meaning_of(Verdict verdict) { return word_of(verdict).meaning; }
bool fails_a_run(Verdict verdict) { return word_of(verdict).fails_a_run; }

std::optional<Verdict> parse_verdict(std::string_view name) {
  const auto found = std::ranges::find(verdicts, name, &VerdictWord::word);
  if (found == verdicts.end()) return std::nullopt;
  return static_cast<Verdict>(found - verdicts.begin());
}

bool is_judged(Verdict verdict) {
  return verdict != Verdict::skip && verdict != Verdict::unsupported;
}

std::string_view name_of(Conclusion conclusion) {
  return conclusions[static_cast<std::size_t>(conclusion)];
}

Verdict verdict_of(Conclusion conclusion) {
  if (conclusion == Conclusion::fail) return Verdict::fail;
  const bool is_good = conclusion == Conclusion::pass || conclusion == Conclusion::measured;
  return is_good ? Verdict::pass : Verdict::skip;
}

Conclusion conclusion_of(Verdict verdict) {
  if (verdict == Verdict::pass) return Conclusion::pass;
  return fails_a_run(verdict) ? Conclusion::fail : Conclusion::none;
}

std::string_view name_of(RowVerdict verdict) {
  return row_verdicts[static_cast<std::size_t>(verdict)];
}

std::string RunResult::selection_text() const {
  if (shard.count == 1) return selection;
  return fmt::format("{}{}--shard {}", selection, selection.empty() ? "" : " ", shard.to_string());
}

std::size_t RunResult::count(Verdict verdict) const {
  return static_cast<std::size_t>(
      std::count_if(results.begin(), results.end(),
                    [verdict](const VectorResult& result) { return result.verdict == verdict; }));
}

bool RunResult::failed() const {
  return std::any_of(results.begin(), results.end(),
                     [](const VectorResult& result) { return fails_a_run(result.verdict); });
}

bool MetricResult::within() const {
  // With an infinite reference, difference and tolerance may both be infinite, and `<=` would hold.
  const bool near =
      value == reference || (std::isfinite(reference) && std::abs(value - reference) <= tolerance);
  return near && value >= min && value <= max;
}

}  // namespace attest
