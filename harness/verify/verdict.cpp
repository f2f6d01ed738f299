#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "harness/verify/run_result.hpp"

namespace attest {
namespace {

constexpr std::array<std::string_view, verdict_count> names{
    "pass",       "fail",        "crash", "timeout", "protocol",
    "non-finite", "unsupported", "skip",  "xfail",   "xpass",
};

}  // namespace

std::string_view name_of(Verdict verdict) { return names[static_cast<std::size_t>(verdict)]; }

std::optional<Verdict> parse_verdict(std::string_view name) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) return std::nullopt;
  return static_cast<Verdict>(found - names.begin());
}

bool fails_a_run(Verdict verdict) {
  switch (verdict) {
    case Verdict::pass:
    case Verdict::unsupported:
    case Verdict::skip:
    case Verdict::xfail:
      return false;
    case Verdict::fail:
    case Verdict::crash:
    case Verdict::timeout:
    case Verdict::protocol:
    case Verdict::non_finite:
    case Verdict::xpass:
      return true;
  }
  return true;
}

bool is_judged(Verdict verdict) {
  return verdict != Verdict::skip && verdict != Verdict::unsupported;
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
