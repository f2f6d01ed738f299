#include "harness/diagnosis/diagnose.hpp"

#include <algorithm>
#include <map>

#include "harness/diagnosis/library_suspect.hpp"
#include "harness/diagnosis/search.hpp"

namespace attest {
namespace {

void find_first_stage(const std::vector<std::optional<Stage>>& vectors, Diagnosis& diagnosis) {
  std::map<Stage, std::size_t> counts;
  for (const auto& stage : vectors) {
    if (stage) ++counts[*stage];
  }
  for (const auto& [stage, count] : counts) {
    if (count <= diagnosis.in_first_stage) continue;
    diagnosis.first_stage = stage;
    diagnosis.in_first_stage = count;
  }
}

void find_specific_case(const std::vector<VectorSimilarity>& failing, Diagnosis& diagnosis) {
  const auto shown_in = [](const VectorSimilarity& vector) {
    return static_cast<std::size_t>(
        std::count_if(vector.similarities.begin(), vector.similarities.end(),
                      [](const Similarity& one) { return one.deviating != 0; }));
  };
  const auto best =
      std::min_element(failing.begin(), failing.end(),
                       [&](const auto& a, const auto& b) { return shown_in(a) < shown_in(b); });
  diagnosis.specific_case = best->case_id;
  diagnosis.shown_by_it = shown_in(*best);
}

std::optional<Diagnosis> diagnose_library_calls(const std::vector<ExactVector>& vectors) {
  const auto lacks_library = [](const auto& one) { return one.library.with_set.empty(); };
  if (vectors.empty() || std::any_of(vectors.begin(), vectors.end(), lacks_library)) {
    return std::nullopt;
  }
  const auto suspect = find_library_calls(vectors);
  if (!suspect) return std::nullopt;
  Diagnosis diagnosis;
  diagnosis.vectors = vectors.size();
  diagnosis.failing = suspect->failing;
  diagnosis.unexplained = suspect->failing - suspect->explained;
  diagnosis.stage = suspect->fault->stage;
  diagnosis.suspects = {*suspect};
  std::vector<std::optional<Stage>> stages;
  for (const ExactVector& vector : vectors) {
    if (!passes(vector)) stages.push_back(vector.stage);
  }
  find_first_stage(stages, diagnosis);
  return diagnosis;
}

std::optional<Diagnosis> diagnose_values(const Evidence& evidence) {
  Search search(evidence);
  if (!search.run()) return std::nullopt;
  Diagnosis diagnosis;
  diagnosis.vectors = search.vectors().size();
  diagnosis.failing = search.failing().size();
  diagnosis.suspects = search.suspects();
  diagnosis.unexplained_cases = search.unexplained_cases();
  diagnosis.unexplained = diagnosis.unexplained_cases.size();
  if (!diagnosis.suspects.empty()) diagnosis.stage = diagnosis.suspects.front().fault->stage;
  std::vector<std::optional<Stage>> stages;
  for (const VectorSimilarity& vector : search.failing()) stages.push_back(vector.stage);
  find_first_stage(stages, diagnosis);
  find_specific_case(search.failing(), diagnosis);
  if (evidence.observe && diagnosis.unexplained > 0) {
    diagnosis.patterns = patterns_of(evidence.observe(search.vectors(), search.all_suspects()));
  }
  return diagnosis;
}

}  // namespace

std::optional<Diagnosis> diagnose(const Evidence& evidence) {
  if (auto found = diagnose_library_calls(evidence.exact)) return found;
  return diagnose_values(evidence);
}

}  // namespace attest
