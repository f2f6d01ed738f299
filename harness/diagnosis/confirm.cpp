// Whether the suspects of a search belong together: all of them act at once, and all but each one.
#include <algorithm>

#include "harness/diagnosis/search.hpp"

namespace attest {
namespace {

// The share of the places where a suspect acts at which all suspects together must have the port's
// values. Otherwise it may be a mistake that is like the fault under some conditions only.
constexpr double least_confirmed = 0.5;

// A suspect that explains so many vectors may have more places that hold a second mistake, too.
constexpr double enough_needed = 3, least_confirmed_often = 0.15;

// The share of the vectors where a suspect acts in which the others may be nearer to the port
// without it. At first it is larger, because other mistakes are not found yet.
constexpr double most_farther = 0.15, most_farther_at_first = 0.5;

// So many times as many vectors may be wrong as right where the suspect first acts: another mistake
// may act at the same step.
constexpr double most_wrong_at_first = 3;

// Vectors in which the suspect is right where it first acts. So many confirm it although later
// places hold a second mistake, if it is wrong in at most half as many.
constexpr double enough_right_at_first = 2;

// How all suspects together agree with the port where one of them acts. Places are outputs of
// vectors, as in Score.
struct Confirmation {
  // Places where it acts, and those of them that have the port's values.
  double acting = 0, confirmed = 0;
  // Places that have the port's values only with it.
  double needed = 0;
  // Vectors that are nearer to the port with it, or without it.
  double nearer = 0, farther = 0;
  // Vectors with the port's values up to the tick at which it first acts: those with the port's
  // values at this tick, too, and those without. What comes later may be of other mistakes.
  double right_at_first = 0, wrong_at_first = 0;

  // `alone`: the suspect; `all`: all suspects; `without`: all but this one.
  void add(const VectorSimilarity& vector, const Similarity& alone, const Similarity& all,
           const Similarity& without) {
    // A fault that takes the place of another one can act where it does not act alone.
    nearer += all.misfit < without.misfit ? 1 : 0;
    farther += all.misfit > without.misfit ? 1 : 0;
    const OutputMask places = alone.deviating;
    if (places == 0) return;
    acting += weight(places, vector);
    confirmed += weight(places & ~all.parted, vector);
    needed += weight(~all.parted & without.parted & vector.deviating, vector);
    right_at_first += all.parts > alone.acts ? 1 : 0;
    wrong_at_first += all.parts == alone.acts && (places & all.parted) != 0 ? 1 : 0;
  }

  double share() const { return acting == 0 ? 0 : confirmed / acting; }

  bool is_refuted(bool at_last) const {
    const double most = at_last ? most_farther : most_farther_at_first;
    if (needed == 0 || farther > most * (nearer + farther)) return true;
    const double least = needed < enough_needed ? least_confirmed : least_confirmed_often;
    const bool is_confirmed = share() >= least || is_right_at_first();
    return at_last && (!is_confirmed || wrong_at_first > most_wrong_at_first * right_at_first);
  }

  bool is_right_at_first() const {
    return right_at_first >= enough_right_at_first && 2 * wrong_at_first <= right_at_first;
  }

  double refutation() const { return 1 - share() + 2 * farther / std::max(1.0, nearer + farther); }
};

}  // namespace

// Of similarities of all suspects, and then of all but each one: the suspect that the others refute
// most; empty if they refute none.
std::optional<std::size_t> Search::worst_suspect(const std::vector<VectorSimilarity>& together,
                                                 bool at_last) const {
  std::optional<std::size_t> worst;
  double largest = 0;
  for (std::size_t i = 0; i < suspects_.size(); ++i) {
    const std::size_t fault = index_in_catalogue(*suspects_[i].fault);
    Confirmation confirmation;
    for (std::size_t v = 0; v < together.size(); ++v) {
      const auto& of_vector = together[v].similarities;
      confirmation.add(together[v], alone_[v].similarities[fault], of_vector.front(),
                       of_vector[i + 1]);
    }
    if (!confirmation.is_refuted(at_last) || confirmation.refutation() < largest) continue;
    largest = confirmation.refutation();
    worst = i;
  }
  return worst;
}

// Lets all suspects act together, and drops those that the others refute, one at a time. Returns
// false if they cannot act together.
bool Search::confirm(bool at_last) {
  while (!suspects_.empty()) {
    std::vector<Hypothesis> hypotheses{all_suspects()};
    for (std::size_t i = 0; i < suspects_.size(); ++i) {
      hypotheses.push_back(all_suspects());
      hypotheses.back().erase(hypotheses.back().begin() + static_cast<std::ptrdiff_t>(i));
    }
    const auto together = evidence_.compare(failing_, hypotheses);
    if (together.size() != failing_.size()) return false;
    for (std::size_t v = 0; v < together.size(); ++v) {
      const Similarity& one = together[v].similarities.front();
      left_[v] = (together[v].deviating | one.deviating) & one.parted;
    }
    const auto worst = worst_suspect(together, at_last);
    if (!worst) {
      find_explained(together);
      return true;
    }
    const auto place = suspects_.begin() + static_cast<std::ptrdiff_t>(*worst);
    refuted_[index_in_catalogue(*place->fault)] = true;
    suspects_.erase(place);
  }
  for (std::size_t v = 0; v < left_.size(); ++v) left_[v] = alone_[v].deviating;
  return true;
}

// Finds the vectors of which each suspect explains a part.
void Search::find_explained(const std::vector<VectorSimilarity>& together) {
  for (std::size_t i = 0; i < suspects_.size(); ++i) {
    suspects_[i].cases.clear();
    for (const VectorSimilarity& vector : together) {
      const OutputMask needed = ~vector.similarities.front().parted &
                                vector.similarities[i + 1].parted & vector.deviating;
      if (needed != 0) suspects_[i].cases.push_back(vector.case_id);
    }
    suspects_[i].explained = suspects_[i].cases.size();
  }
}

}  // namespace attest
