#include "harness/diagnosis/diagnose.hpp"

#include <algorithm>
#include <bit>
#include <functional>
#include <map>
#include <set>
#include <tuple>

namespace attest {
namespace {

constexpr std::size_t most_suspects = 3;
constexpr std::size_t most_in_group = 4;

// The share of the passing vectors that a suspect must match. It is below 1 because a port may have
// several mistakes: on some passing vectors, one of them may hide that of the suspect.
constexpr double passing_part = 0.95;

// The share that a suspect must explain of the failing vectors that the suspects before it leave
// unexplained. In a short vector, a fault may match by chance: the fault integral-in-12-bits
// matched 1 of the 24 failing vectors of a port with a tanh in its integrator.
constexpr double least_part = 0.1;

// The share of the failing vectors that all suspects together must explain, and the share of the
// deviating values that the nearest fault must have in common with the port.
constexpr double least_explained = 0.5, least_in_common = 0.5;

struct Record {
  std::size_t fault = 0;               // index in the catalogue
  std::size_t matched = 0, ticks = 0;  // of all ticks of failing vectors, it matches `matched`
  std::size_t passes = 0;              // passing vectors that it matches at every tick
  std::size_t matched_passing = 0;     // ticks of passing vectors that it matches
  std::vector<std::size_t> explained;  // failing vectors that it matches at every tick
  std::size_t intersection = 0, union_size = 0;

  double jaccard_index() const {
    return union_size == 0 ? 0
                           : static_cast<double>(intersection) / static_cast<double>(union_size);
  }
};

Record record_of(std::size_t fault, const std::vector<VectorSimilarity>& vectors) {
  Record record;
  record.fault = fault;
  for (std::size_t v = 0; v < vectors.size(); ++v) {
    const Similarity& one = vectors[v].similarities[fault];
    const bool all = one.matched == vectors[v].ticks;
    record.intersection += one.intersection;
    record.union_size += one.union_size;
    if (!vectors[v].deviates) {
      record.passes += all ? 1 : 0;
      record.matched_passing += one.matched;
      continue;
    }
    record.matched += one.matched;
    record.ticks += vectors[v].ticks;
    if (all) record.explained.push_back(v);
  }
  return record;
}

std::vector<Record> records_of(const std::vector<VectorSimilarity>& vectors) {
  std::vector<Record> records;
  for (std::size_t i = 0; i < faults::catalogue().size(); ++i) {
    if (faults::catalogue()[i]->equivalent.empty()) records.push_back(record_of(i, vectors));
  }
  return records;
}

// Drops the faults that deviate in too many vectors in which the port does not.
void drop_contradicted(std::size_t passing, std::vector<Record>& records) {
  const double enough = passing_part * static_cast<double>(passing);
  std::erase_if(records, [enough](const Record& record) {
    return static_cast<double>(record.passes) < enough;
  });
}

std::vector<std::size_t> failing_of(const std::vector<VectorSimilarity>& vectors) {
  std::vector<std::size_t> indices;
  for (std::size_t v = 0; v < vectors.size(); ++v) {
    if (vectors[v].deviates) indices.push_back(v);
  }
  return indices;
}

std::size_t explains(const Record& record, const std::vector<std::size_t>& left) {
  return static_cast<std::size_t>(
      std::count_if(record.explained.begin(), record.explained.end(), [&](std::size_t vector) {
        return std::find(left.begin(), left.end(), vector) != left.end();
      }));
}

auto rank(const Record& record, const std::vector<std::size_t>& left) {
  return std::tuple(explains(record, left), record.passes, record.matched, record.matched_passing);
}

Suspect suspect_of(const Record& best, const std::vector<Record>& records,
                   const std::vector<std::size_t>& left, std::size_t failing) {
  const auto all = faults::catalogue();
  Suspect suspect{all[best.fault], best.matched, best.ticks, best.explained.size(), failing, {}};
  for (const Record& other : records) {
    const bool as_good = other.fault != best.fault && other.explained == best.explained &&
                         rank(other, left) == rank(best, left);
    if (as_good && suspect.ambiguity_group.size() < most_in_group) {
      suspect.ambiguity_group.push_back(all[other.fault]);
    }
  }
  return suspect;
}

const Record* best_of(const std::vector<Record>& records, const std::vector<std::size_t>& left) {
  const auto best = std::max_element(
      records.begin(), records.end(),
      [&](const Record& a, const Record& b) { return rank(a, left) < rank(b, left); });
  return best == records.end() ? nullptr : &*best;
}

bool is_enough(std::size_t explained, std::size_t left) {
  return static_cast<double>(explained) >= least_part * static_cast<double>(left);
}

// Keeps the nearest fault only if it has at least half of the deviating values in common.
void find_nearest(const std::vector<Record>& records, Diagnosis& diagnosis) {
  const auto nearest =
      std::max_element(records.begin(), records.end(), [](const Record& a, const Record& b) {
        return std::tuple(a.jaccard_index(), a.matched) < std::tuple(b.jaccard_index(), b.matched);
      });
  if (nearest->jaccard_index() < least_in_common) return;
  diagnosis.nearest = faults::catalogue()[nearest->fault];
  diagnosis.jaccard_index = nearest->jaccard_index();
}

void find_first_stages(const std::vector<VectorSimilarity>& vectors,
                       const std::vector<std::size_t>& failing, Diagnosis& diagnosis) {
  std::map<unsigned long, std::size_t> counts;
  for (const std::size_t v : failing) ++counts[vectors[v].stages.to_ulong()];
  for (const auto& [stages, count] : counts) {
    if (count <= diagnosis.in_first_stages) continue;
    diagnosis.first_stages = StageSet(stages);
    diagnosis.in_first_stages = count;
  }
}

void find_specific_case(const std::vector<VectorSimilarity>& vectors,
                        const std::vector<std::size_t>& failing, Diagnosis& diagnosis) {
  const auto shown_in = [&](std::size_t v) {
    std::size_t shown = 0;
    for (const Similarity& one : vectors[v].similarities) shown += one.deviates ? 1 : 0;
    return shown;
  };
  const auto best =
      std::min_element(failing.begin(), failing.end(),
                       [&](std::size_t a, std::size_t b) { return shown_in(a) < shown_in(b); });
  diagnosis.specific_case = vectors[*best].case_id;
  diagnosis.shown_by_it = shown_in(*best);
}

void find_suspects(const std::vector<Record>& records, std::vector<std::size_t> left,
                   Diagnosis& diagnosis) {
  while (!left.empty() && diagnosis.suspects.size() < most_suspects) {
    const Record* const best = best_of(records, left);
    if (!best || !is_enough(explains(*best, left), left.size())) break;
    diagnosis.suspects.push_back(suspect_of(*best, records, left, diagnosis.failing));
    std::erase_if(left, [&explained = best->explained](std::size_t vector) {
      return std::find(explained.begin(), explained.end(), vector) != explained.end();
    });
  }
  diagnosis.unexplained = left.size();
}

void find_pair(const std::vector<Record>& records, const std::vector<std::size_t>& all,
               const CombinedWith& combined_with, Diagnosis& diagnosis) {
  const Record* const first = best_of(records, all);
  if (!first || first->explained.empty()) return;
  const faults::Fault* const fault = faults::catalogue()[first->fault];
  const std::vector<VectorSimilarity> together = combined_with(*fault);
  if (failing_of(together) != all) return;  // the port answered in another way, or not at all
  std::vector<Record> pairs = records_of(together);
  drop_contradicted(together.size() - all.size(), pairs);
  const Record* const second = best_of(pairs, all);
  const std::size_t explained = second ? second->explained.size() : 0;
  const std::size_t alone = first->explained.size();
  if (explained <= std::max(alone, diagnosis.failing - diagnosis.unexplained) ||
      !is_enough(explained - alone, diagnosis.failing - alone)) {
    return;
  }
  diagnosis.suspects = {suspect_of(*first, records, all, diagnosis.failing),
                        suspect_of(*second, pairs, all, diagnosis.failing)};
  diagnosis.suspects.back().with = fault;
  diagnosis.unexplained = all.size() - explained;
}

bool passes(const VectorSimilarity& vector) { return vector.library.with_set[0] == vector.ticks; }

// Calls of the C library that may explain the deviations.
struct CandidateCalls {
  const faults::Fault* port;
  int functions;
  bool all;  // all calls of these functions, not a single one
  std::function<std::size_t(const LibraryMatches&)> matched;
};

std::vector<CandidateCalls> candidate_calls(const std::vector<VectorSimilarity>& vectors) {
  std::vector<CandidateCalls> candidates;
  for (LibraryCalls calls = 1; calls < library_call_sets; ++calls) {
    candidates.push_back({&port_that_calls(calls), std::popcount(calls), true,
                          [calls](const LibraryMatches& one) { return one.with_set[calls]; }});
  }
  std::set<LibraryCall> single_calls;
  for (const VectorSimilarity& vector : vectors) {
    for (const auto& [single, matched] : vector.library.with_single) single_calls.insert(single);
  }
  for (const LibraryCall& single : single_calls) {
    candidates.push_back({&port_that_calls(single), 1, false,
                          [single](const LibraryMatches& one) { return one.with(single); }});
  }
  return candidates;
}

// A suspect that makes these calls. Empty if the calls are refuted, because they do not explain a
// vector that passes or deviates by more than rounding, or if they explain too little.
std::optional<Suspect> suspect_that_calls(const CandidateCalls& calls,
                                          const std::vector<VectorSimilarity>& vectors) {
  Suspect suspect;
  suspect.fault = calls.port;
  for (const VectorSimilarity& vector : vectors) {
    const std::size_t matched = calls.matched(vector.library);
    const bool is_explained = matched == vector.ticks;
    if (!is_explained && (passes(vector) || vector.deviates)) return std::nullopt;
    if (passes(vector)) continue;
    suspect.matched += matched;
    suspect.ticks += vector.ticks;
    suspect.explained += is_explained ? 1 : 0;
    ++suspect.failing;
  }
  const double enough = least_explained * static_cast<double>(suspect.failing);
  if (suspect.explained == 0 || static_cast<double>(suspect.explained) < enough)
    return std::nullopt;
  return suspect;
}

// Of those that explain the most vectors, the one with the fewest functions. All calls of a
// function come before a single one that explains no more.
std::optional<Suspect> find_library_calls(const std::vector<VectorSimilarity>& vectors) {
  std::optional<Suspect> best;
  std::tuple<std::size_t, int, std::size_t, bool> best_rank;
  for (const CandidateCalls& calls : candidate_calls(vectors)) {
    auto suspect = suspect_that_calls(calls, vectors);
    if (!suspect) continue;
    const std::tuple rank(suspect->explained, -calls.functions, suspect->matched, calls.all);
    if (!best || rank > best_rank) {
      best = std::move(suspect);
      best_rank = rank;
    } else if (rank == best_rank && best->ambiguity_group.size() < most_in_group) {
      best->ambiguity_group.push_back(suspect->fault);
    }
  }
  return best;
}

std::optional<Diagnosis> diagnose_library_calls(const std::vector<VectorSimilarity>& vectors) {
  const auto lacks_library = [](const auto& one) { return one.library.with_set.empty(); };
  if (std::any_of(vectors.begin(), vectors.end(), lacks_library)) return std::nullopt;
  const auto suspect = find_library_calls(vectors);
  if (!suspect) return std::nullopt;
  std::vector<std::size_t> failing;
  for (std::size_t v = 0; v < vectors.size(); ++v) {
    if (!passes(vectors[v])) failing.push_back(v);
  }
  Diagnosis diagnosis;
  diagnosis.vectors = vectors.size();
  diagnosis.failing = failing.size();
  diagnosis.unexplained = failing.size() - suspect->explained;
  diagnosis.stage = suspect->fault->stage;
  diagnosis.suspects = {*suspect};
  find_first_stages(vectors, failing, diagnosis);
  return diagnosis;
}

}  // namespace

std::optional<Diagnosis> diagnose(const std::vector<VectorSimilarity>& vectors,
                                  const CombinedWith& combined_with) {
  if (auto found = diagnose_library_calls(vectors)) return found;
  const std::vector<std::size_t> failing = failing_of(vectors);
  if (failing.empty()) return std::nullopt;
  Diagnosis diagnosis;
  diagnosis.vectors = vectors.size();
  diagnosis.failing = failing.size();
  std::vector<Record> records = records_of(vectors);
  find_nearest(records, diagnosis);
  drop_contradicted(vectors.size() - failing.size(), records);
  find_suspects(records, failing, diagnosis);
  if (combined_with && diagnosis.unexplained > 0) {
    find_pair(records, failing, combined_with, diagnosis);
  }
  auto& suspects = diagnosis.suspects;
  const auto explained = static_cast<double>(failing.size() - diagnosis.unexplained);
  if (explained < least_explained * static_cast<double>(failing.size())) {
    suspects.clear();
    diagnosis.unexplained = failing.size();
  }
  find_first_stages(vectors, failing, diagnosis);
  find_specific_case(vectors, failing, diagnosis);
  const faults::Fault* const named = suspects.empty() ? diagnosis.nearest : suspects.front().fault;
  if (named) diagnosis.stage = named->stage;
  return diagnosis;
}

}  // namespace attest
