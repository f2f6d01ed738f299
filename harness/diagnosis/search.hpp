// Searches the faults that together give a port's values (diagnose.hpp).
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "harness/diagnosis/diagnose.hpp"

namespace attest {

// The number of faults that Suspect::ambiguity_group has at most.
inline constexpr std::size_t most_in_group = 4;

// How well a fault agrees with the port. Places are outputs of failing vectors; those of a vector
// weigh 1 together.
struct Score {
  double gained = 0;        // places that it explains, and the suspects so far do not
  double nearer = 0;        // the share of the misfit that it removes, summed up over the vectors
  double acting = 0;        // vectors in which it deviates
  double contradicted = 0;  // of these, those in which the port is right where it deviates

  bool is_contradicted() const;
  bool is_useful() const;
};

class Search {
 public:
  // REQUIRES: `evidence` outlives this.
  explicit Search(const Evidence& evidence);

  // Returns false if no vector deviates.
  bool run();

  // After run(). The suspect that explains the most comes first.
  std::vector<Suspect> suspects() const;
  Hypothesis all_suspects() const;
  std::vector<std::string> unexplained_cases() const;
  // The failing vectors that deviate, with the similarities of each fault.
  const std::vector<VectorSimilarity>& failing() const { return alone_; }
  // The indices in the evidence of these vectors, and of those that passed.
  std::vector<std::size_t> vectors() const;

 private:
  using Indices = std::vector<std::size_t>;
  struct Candidate {
    std::size_t fault = 0;  // index in the catalogue
    Score score;
  };

  bool compare_each();
  bool compare_with_suspects(std::size_t most);
  bool search_round();
  bool search_combination();
  double extend(Indices& combination);
  std::vector<Candidate> seeds();
  std::vector<Candidate> candidates() const;
  Score score_of(std::size_t fault) const;
  std::vector<OutputMask> gains_of(std::size_t fault) const;
  void refute(std::vector<Candidate>& candidates) const;
  void take(const Candidate& best, const std::vector<Candidate>& candidates);
  Indices unexplained() const;

  // confirm.cpp
  bool confirm(bool at_last);
  std::optional<std::size_t> worst_suspect(const std::vector<VectorSimilarity>& together,
                                           bool at_last) const;
  void find_explained(const std::vector<VectorSimilarity>& together);

  const Evidence& evidence_;
  Indices failing_, passing_;
  std::vector<Suspect> suspects_;
  // Of each fault alone, on all failing vectors; last of the law.
  std::vector<VectorSimilarity> alone_;
  // Of each fault together with the suspects, on the vectors `compared_`; last of the suspects.
  std::vector<VectorSimilarity> together_;
  Indices compared_;  // indices into alone_
  // For each failing vector, the outputs that are not yet explained.
  std::vector<OutputMask> left_;
  std::vector<bool> refuted_;  // of each fault
};

// The share of the outputs in which the vector deviates.
double weight(OutputMask outputs, const VectorSimilarity& vector);

}  // namespace attest
