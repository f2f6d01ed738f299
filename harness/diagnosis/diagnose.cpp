#include "harness/diagnosis/diagnose.hpp"

#include <algorithm>
#include <tuple>

namespace attest {
namespace {

constexpr std::size_t most_suspects = 3;
constexpr std::size_t most_in_group = 4;

// The share of the passing vectors that a suspect must match. It is below 1 for ports with several
// mistakes: on some passing vectors another mistake of the port hides the one of the suspect.
constexpr double passing_part = 0.95;

// One fault over all vectors.
struct Record {
  std::size_t fault = 0;  // index in the catalogue
  std::size_t matched = 0, ticks = 0;
  std::size_t passes = 0;              // passing vectors that it matches
  std::size_t matched_passing = 0;     // ticks of all passing vectors that it matches
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

// Drops the faults that deviate where the port does not.
void drop_contradicted(std::size_t passing, std::vector<Record>& records) {
  const double enough = passing_part * static_cast<double>(passing);
  std::erase_if(records, [enough](const Record& record) {
    return static_cast<double>(record.passes) < enough;
  });
}

std::vector<std::size_t> failing(const std::vector<VectorSimilarity>& vectors) {
  std::vector<std::size_t> indices;
  for (std::size_t v = 0; v < vectors.size(); ++v) {
    if (vectors[v].deviates) indices.push_back(v);
  }
  return indices;
}

// The vectors of `left` that the record explains.
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

}  // namespace

std::optional<Diagnosis> diagnose(const std::vector<VectorSimilarity>& vectors) {
  Diagnosis diagnosis;
  std::vector<std::size_t> left = failing(vectors);  // not explained yet
  if (left.empty()) return std::nullopt;
  diagnosis.vectors = vectors.size();
  diagnosis.failing = left.size();

  std::vector<Record> records = records_of(vectors);
  const auto nearest =
      std::max_element(records.begin(), records.end(), [](const Record& a, const Record& b) {
        return std::tuple(a.jaccard_index(), a.matched) < std::tuple(b.jaccard_index(), b.matched);
      });
  diagnosis.nearest = faults::catalogue()[nearest->fault];
  diagnosis.jaccard_index = nearest->jaccard_index();
  diagnosis.stage = diagnosis.nearest->stage;

  drop_contradicted(vectors.size() - left.size(), records);
  while (!records.empty() && !left.empty() && diagnosis.suspects.size() < most_suspects) {
    const auto best = std::max_element(
        records.begin(), records.end(),
        [&](const Record& a, const Record& b) { return rank(a, left) < rank(b, left); });
    if (explains(*best, left) == 0) break;
    diagnosis.suspects.push_back(suspect_of(*best, records, left, diagnosis.failing));
    std::erase_if(left, [&](std::size_t vector) {
      const auto& explained = best->explained;
      return std::find(explained.begin(), explained.end(), vector) != explained.end();
    });
  }
  diagnosis.unexplained = left.size();
  if (!diagnosis.suspects.empty()) diagnosis.stage = diagnosis.suspects.front().fault->stage;
  return diagnosis;
}

bool wants_partner(const Diagnosis& diagnosis) {
  return !diagnosis.suspects.empty() && diagnosis.unexplained > 0;
}

void add_partner(const std::vector<VectorSimilarity>& vectors, Diagnosis& diagnosis) {
  const std::vector<std::size_t> all = failing(vectors);
  std::vector<Record> records = records_of(vectors);
  drop_contradicted(vectors.size() - all.size(), records);
  if (records.empty()) return;
  const auto best = std::max_element(
      records.begin(), records.end(),
      [&](const Record& a, const Record& b) { return rank(a, all) < rank(b, all); });
  if (best->explained.size() <= diagnosis.failing - diagnosis.unexplained) return;
  Suspect second = suspect_of(*best, records, all, diagnosis.failing);
  second.with = diagnosis.suspects.front().fault;
  diagnosis.suspects.resize(1);
  diagnosis.suspects.push_back(std::move(second));
  diagnosis.unexplained = all.size() - best->explained.size();
}

}  // namespace attest
