#include "harness/diagnosis/search.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <utility>

namespace attest {
namespace {

constexpr std::size_t most_suspects = 12;
constexpr std::size_t most_rounds = 8;
// Candidates of a round that are compared with the port on passing vectors.
constexpr std::size_t most_candidates = 40;
// Unexplained vectors that a later round compares.
constexpr std::size_t most_compared = 64;
// Of a search for faults that only explain together: the faults from which it starts, its vectors,
// and the faults that it adds.
constexpr std::size_t most_seeds = 5, most_in_combination = 14, most_added = 3;

// The share of the vectors where a fault acts at which the port may be right, and their number that
// is allowed in any case. Above 0, because another mistake may hide that of the fault, and because
// a mistake may be that of the fault but for a special case.
constexpr double most_contradicted = 0.05, always_allowed = 1;

}  // namespace

double weight(OutputMask outputs, const VectorSimilarity& vector) {
  return static_cast<double>(std::popcount(outputs)) /
         static_cast<double>(std::popcount(vector.deviating));
}

bool Score::is_contradicted() const {
  return contradicted > std::max(always_allowed, most_contradicted * acting);
}

bool Score::is_useful() const { return gained > 0 && nearer > 0 && !is_contradicted(); }

Search::Search(const Evidence& evidence)
    : evidence_(evidence), refuted_(faults::catalogue().size(), false) {
  failing_.resize(evidence.failing);
  std::iota(failing_.begin(), failing_.end(), 0);
  passing_.resize(evidence.passing);
  std::iota(passing_.begin(), passing_.end(), evidence.failing);
}

bool Search::run() {
  if (!compare_each()) return false;
  for (std::size_t round = 0; round < most_rounds; ++round) {
    if (!search_round() && !search_combination()) break;
    if (!confirm(false) || !compare_with_suspects(most_compared)) break;
  }
  confirm(true);
  return true;
}

bool Search::compare_each() {
  std::vector<Hypothesis> hypotheses = each_fault();
  hypotheses.emplace_back();
  alone_ = evidence_.compare(failing_, hypotheses);
  if (alone_.size() != failing_.size()) return false;
  // A vector that fails only after others, or only at the level exact, does not deviate here.
  Indices deviating;
  std::vector<VectorSimilarity> kept;
  for (std::size_t i = 0; i < alone_.size(); ++i) {
    if (alone_[i].deviating == 0) continue;
    deviating.push_back(failing_[i]);
    kept.push_back(std::move(alone_[i]));
  }
  failing_ = std::move(deviating);
  alone_ = std::move(kept);
  for (const VectorSimilarity& vector : alone_) left_.push_back(vector.deviating);
  for (std::size_t i = 0; i < refuted_.size(); ++i) {
    refuted_[i] = !faults::catalogue()[i]->equivalent.empty();
  }
  together_ = alone_;
  compared_.resize(failing_.size());
  std::iota(compared_.begin(), compared_.end(), 0);
  return !failing_.empty();
}

// Returns false if all vectors are explained.
bool Search::compare_with_suspects(std::size_t most) {
  const Indices open = unexplained();
  const std::size_t count = std::min(open.size(), most);
  Indices vectors;
  compared_.clear();
  for (std::size_t i = 0; i < count; ++i) {
    compared_.push_back(open[i * open.size() / count]);
    vectors.push_back(failing_[compared_.back()]);
  }
  std::vector<Hypothesis> hypotheses = each_fault(all_suspects());
  hypotheses.push_back(all_suspects());
  together_ = evidence_.compare(vectors, hypotheses);
  return count > 0 && together_.size() == count;
}

// For each vector of `compared_`, the outputs that the fault explains and the suspects do not.
std::vector<OutputMask> Search::gains_of(std::size_t fault) const {
  std::vector<OutputMask> masks;
  for (std::size_t i = 0; i < compared_.size(); ++i) {
    const VectorSimilarity& vector = together_[i];
    masks.push_back(vector.explained(vector.similarities[fault]) & left_[compared_[i]]);
  }
  return masks;
}

// Of a fault together with the suspects so far.
Score Search::score_of(std::size_t fault) const {
  Score score;
  for (std::size_t i = 0; i < compared_.size(); ++i) {
    const VectorSimilarity& vector = together_[i];
    const Similarity& one = vector.similarities[fault];
    const Similarity& without = vector.similarities.back();
    const OutputMask left = left_[compared_[i]];
    if (left == 0 || (one.misfit == without.misfit && one.parted == without.parted)) continue;
    score.acting += 1;
    score.gained += weight(vector.explained(one) & left, vector);
    score.nearer += std::max(-1.0, (without.misfit - one.misfit) / without.misfit);
    // Together with it, the suspects no longer have the port's values.
    const OutputMask lost = (vector.deviating & ~left & one.parted) |
                            (one.deviating & ~vector.deviating & ~without.deviating);
    score.contradicted += std::min(1.0, weight(lost, vector));
  }
  return score;
}

std::vector<Search::Candidate> Search::candidates() const {
  std::vector<Candidate> found;
  for (std::size_t fault = 0; fault < refuted_.size(); ++fault) {
    if (refuted_[fault]) continue;
    const Score score = score_of(fault);
    if (score.is_useful()) found.push_back({fault, score});
  }
  std::stable_sort(found.begin(), found.end(), [](const Candidate& a, const Candidate& b) {
    return a.score.nearer > b.score.nearer;
  });
  if (found.size() > most_candidates) found.resize(most_candidates);
  return found;
}

// Drops candidates that deviate on vectors that passed, in outputs in which the port does not. At
// the level events, a port that passed may deviate in them, too.
void Search::refute(std::vector<Candidate>& candidates) const {
  std::vector<Hypothesis> hypotheses;
  for (const Candidate& one : candidates) hypotheses.push_back({faults::catalogue()[one.fault]});
  if (passing_.empty() || hypotheses.empty()) return;
  for (const VectorSimilarity& vector : evidence_.compare(passing_, hypotheses)) {
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      const Similarity& one = vector.similarities[i];
      candidates[i].score.contradicted += vector.contradicted(one) != 0 ? 1 : 0;
      candidates[i].score.acting += one.deviating != 0 ? 1 : 0;
    }
  }
  std::erase_if(candidates, [](const Candidate& one) { return one.score.is_contradicted(); });
}

void Search::take(const Candidate& best, const std::vector<Candidate>& candidates) {
  const auto all = faults::catalogue();
  Suspect suspect{all[best.fault], 0, failing_.size(), {}, 0};
  const std::vector<OutputMask> gained = gains_of(best.fault);
  for (const Candidate& other : candidates) {
    const bool explains_it = other.fault != best.fault && gains_of(other.fault) == gained;
    suspect.others += explains_it ? 1 : 0;
    const bool as_good = explains_it && std::abs(other.score.nearer - best.score.nearer) < 1e-9 &&
                         other.score.contradicted <= best.score.contradicted;
    if (as_good && suspect.ambiguity_group.size() < most_in_group) {
      suspect.ambiguity_group.push_back(all[other.fault]);
    }
  }
  for (std::size_t i = 0; i < compared_.size(); ++i) left_[compared_[i]] &= ~gained[i];
  suspects_.push_back(std::move(suspect));
}

// Adds suspects that explain what is left. Returns false if there are none.
bool Search::search_round() {
  std::vector<Candidate> found = candidates();
  refute(found);
  const std::size_t before = suspects_.size();
  while (!found.empty() && suspects_.size() < most_suspects) {
    const auto best = std::max_element(
        found.begin(), found.end(),
        [](const Candidate& a, const Candidate& b) { return a.score.nearer < b.score.nearer; });
    take(Candidate(*best), found);
    for (Candidate& one : found) {
      const Score score = score_of(one.fault);
      one.score.gained = score.gained;
      one.score.nearer = score.nearer;
    }
    std::erase_if(found, [](const Candidate& one) { return !one.score.is_useful(); });
  }
  return suspects_.size() > before;
}

// Adds faults until one explains a part of what is left, each time the one that brings the law
// nearest to the port. Returns how near; 0 if there is no such fault.
double Search::extend(Indices& combination) {
  double nearer = 0;
  while (combination.size() <= most_added) {
    Hypothesis base = all_suspects();
    for (const std::size_t fault : combination) base.push_back(faults::catalogue()[fault]);
    std::vector<Hypothesis> hypotheses = each_fault(base);
    hypotheses.push_back(base);
    Indices vectors;
    for (const std::size_t v : compared_) vectors.push_back(failing_[v]);
    together_ = evidence_.compare(vectors, hypotheses);
    if (together_.size() != vectors.size()) return 0;
    std::optional<Candidate> best;
    for (std::size_t fault = 0; fault < refuted_.size(); ++fault) {
      const Score score = score_of(fault);
      if (refuted_[fault] || score.nearer <= 0 || score.is_contradicted()) continue;
      if (!best || score.nearer > best->score.nearer) best = {fault, score};
    }
    if (!best) return 0;
    combination.push_back(best->fault);
    nearer += best->score.nearer;
    if (best->score.gained > 0) return nearer;
  }
  return 0;
}

// The faults from which a search for a combination starts, the best first.
std::vector<Search::Candidate> Search::seeds() {
  std::vector<Candidate> found;
  for (std::size_t fault = 0; fault < refuted_.size(); ++fault) {
    const Score score = score_of(fault);
    if (!refuted_[fault] && score.nearer > 0 && !score.is_contradicted()) {
      found.push_back({fault, score});
    }
  }
  std::stable_sort(found.begin(), found.end(), [](const Candidate& a, const Candidate& b) {
    return a.score.nearer > b.score.nearer;
  });
  if (found.size() > most_candidates) found.resize(most_candidates);
  refute(found);
  if (found.size() > most_seeds) found.resize(most_seeds);
  return found;
}

// Searches faults of which none explains anything without the others.
bool Search::search_combination() {
  if (suspects_.size() >= most_suspects || unexplained().empty()) return false;
  if (!compare_with_suspects(most_in_combination)) return false;
  Indices best;
  double nearest = 0;
  for (const Candidate& seed : seeds()) {
    Indices combination{seed.fault};
    const double nearer = seed.score.nearer + extend(combination);
    if (combination.size() < 2 || nearer <= nearest + seed.score.nearer) continue;
    nearest = nearer;
    best = std::move(combination);
  }
  for (const std::size_t fault : best) {
    suspects_.push_back({faults::catalogue()[fault], 0, failing_.size(), {}, 0});
  }
  return !best.empty();
}

Hypothesis Search::all_suspects() const {
  Hypothesis hypothesis;
  for (const Suspect& suspect : suspects_) hypothesis.push_back(suspect.fault);
  return hypothesis;
}

std::vector<Suspect> Search::suspects() const {
  std::vector<Suspect> sorted = suspects_;
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const Suspect& a, const Suspect& b) { return a.explained > b.explained; });
  return sorted;
}

std::vector<std::size_t> Search::vectors() const {
  Indices all = failing_;
  all.insert(all.end(), passing_.begin(), passing_.end());
  return all;
}

std::vector<std::string> Search::unexplained_cases() const {
  std::vector<std::string> cases;
  for (const std::size_t v : unexplained()) cases.push_back(alone_[v].case_id);
  return cases;
}

Search::Indices Search::unexplained() const {
  Indices indices;
  for (std::size_t v = 0; v < left_.size(); ++v) {
    if (left_[v] != 0) indices.push_back(v);
  }
  return indices;
}

}  // namespace attest
