#include "harness/diagnosis/diagnose_catalogue.hpp"

#include <algorithm>

#include "harness/casefile/stimulus.hpp"
#include "harness/golden/golden.hpp"
#include "harness/loop/open_loop.hpp"
#include "harness/port/builtin.hpp"

namespace attest {
namespace {

// The outputs of all faults on one vector, and for each distinct one as a port its similarity to
// all distinct ones.
struct Answered {
  FaultAnswers faults;
  std::vector<VectorSimilarity> of_distinct;
};

Rate rate_for(const SelectedCase& selected) {
  for (const RunConfiguration& configuration : selected.configurations) {
    if (configuration.rate == Rate::hz(250)) return configuration.rate.unit;
  }
  return selected.configurations.front().rate.unit;
}

Answered answered(const SelectedCase& selected) {
  Trace law = stimulate(selected.the_case, rate_for(selected));
  const auto reference = open_builtin();
  const Subject subject = subject_of(selected.the_case);
  drive(*reference, subject, law);
  Answered vector{answers_of_faults(law, subject), {}};
  const Outputs right = outputs_of(law);
  for (const Outputs& outputs : vector.faults.distinct) {
    vector.of_distinct.push_back(
        distinct_similarity(outputs, right, vector.faults.distinct, subject.module));
  }
  vector.faults.distinct.clear();  // some hundred megabytes in all
  return vector;
}

}  // namespace

bool SelfDiagnosis::is_named() const {
  if (!diagnosis || diagnosis->suspects.empty()) return false;
  const Suspect& first = diagnosis->suspects.front();
  return first.fault == fault ||
         std::find(first.ambiguity_group.begin(), first.ambiguity_group.end(), fault) !=
             first.ambiguity_group.end();
}

bool SelfDiagnosis::is_stage_named() const { return diagnosis && diagnosis->stage == fault->stage; }

std::vector<SelfDiagnosis> diagnose_catalogue(const std::vector<SelectedCase>& cases,
                                              const std::string& profile) {
  const auto catalogue = faults::catalogue();
  std::vector<Answered> vectors;
  for (const SelectedCase& selected : cases) {
    if (!is_long(selected.the_case)) vectors.push_back(answered(selected));
  }
  std::vector<SelfDiagnosis> results;
  for (std::size_t i = 0; i < catalogue.size(); ++i) {
    if (!catalogue[i]->is_detectable(profile)) continue;
    std::vector<VectorSimilarity> of_fault;
    for (const Answered& vector : vectors) {
      const std::size_t index = vector.faults.of_fault[i];
      of_fault.push_back(of_each_fault(vector.of_distinct[index], vector.faults));
    }
    results.push_back({catalogue[i], diagnose(of_fault)});
  }
  return results;
}

}  // namespace attest
