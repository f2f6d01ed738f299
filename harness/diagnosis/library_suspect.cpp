#include "harness/diagnosis/library_suspect.hpp"

#include <bit>
#include <functional>
#include <set>
#include <tuple>
#include <utility>

namespace attest {
namespace {

// The share of the vectors that do not pass that the calls must explain.
constexpr double least_explained = 0.5;

// Calls of the C library that may explain the deviations.
struct CandidateCalls {
  const faults::Fault* port;
  int functions;
  bool all;  // all calls of these functions, not a single one
  std::function<std::size_t(const LibraryMatches&)> matched;
};

std::vector<CandidateCalls> candidate_calls(const std::vector<ExactVector>& vectors) {
  std::vector<CandidateCalls> candidates;
  for (LibraryCalls calls = 1; calls < library_call_sets; ++calls) {
    candidates.push_back({&port_that_calls(calls), std::popcount(calls), true,
                          [calls](const LibraryMatches& one) { return one.with_set[calls]; }});
  }
  std::set<LibraryCall> single_calls;
  for (const ExactVector& vector : vectors) {
    for (const auto& [single, matched] : vector.library.with_single) single_calls.insert(single);
  }
  for (const LibraryCall& single : single_calls) {
    candidates.push_back({&port_that_calls(single), 1, false,
                          [single](const LibraryMatches& one) { return one.with(single); }});
  }
  return candidates;
}

struct Ranked {
  Suspect suspect;
  std::size_t matched = 0;  // ticks of vectors that do not pass
};

// A suspect that makes these calls. Empty if the calls are refuted, because they do not explain a
// vector that passes or deviates by more than rounding, or if they explain too little.
std::optional<Ranked> suspect_that_calls(const CandidateCalls& calls,
                                         const std::vector<ExactVector>& vectors) {
  Ranked found;
  Suspect& suspect = found.suspect;
  suspect.fault = calls.port;
  for (const ExactVector& vector : vectors) {
    const std::size_t matched = calls.matched(vector.library);
    const bool is_explained = matched == vector.ticks;
    if (!is_explained && (passes(vector) || vector.deviates)) return std::nullopt;
    if (passes(vector)) continue;
    found.matched += matched;
    suspect.explained += is_explained ? 1 : 0;
    ++suspect.failing;
  }
  const double enough = least_explained * static_cast<double>(suspect.failing);
  if (suspect.explained == 0 || static_cast<double>(suspect.explained) < enough)
    return std::nullopt;
  return found;
}

}  // namespace

std::optional<Suspect> find_library_calls(const std::vector<ExactVector>& vectors) {
  std::optional<Suspect> best;
  std::tuple<std::size_t, int, std::size_t, bool> best_rank;
  for (const CandidateCalls& calls : candidate_calls(vectors)) {
    auto found = suspect_that_calls(calls, vectors);
    if (!found) continue;
    const std::tuple rank(found->suspect.explained, -calls.functions, found->matched, calls.all);
    if (!best || rank > best_rank) {
      best = std::move(found->suspect);
      best_rank = rank;
    } else if (rank == best_rank && best->ambiguity_group.size() < most_in_group) {
      best->ambiguity_group.push_back(found->suspect.fault);
    }
  }
  return best;
}

}  // namespace attest
