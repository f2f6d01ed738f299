#include "harness/suite/diagnose_catalogue.hpp"

#include <algorithm>

#include "harness/casefile/stimulus.hpp"
#include "harness/port/builtin.hpp"
#include "harness/run/open_loop.hpp"

namespace attest {
namespace {

// A vector, and what everybody answers to it.
struct Answers {
  Outputs law;
  std::vector<Outputs> faults;
};

Rate rate_for(const SelectedCase& selected) {
  for (const Setup& setup : selected.setups) {
    if (setup.rate == Rate::hz(250)) return setup.rate;
  }
  return selected.setups.front().rate;
}

Answers answers_to(const SelectedCase& selected) {
  Trace law = stimulate(selected.the_case, rate_for(selected));
  const auto reference = open_builtin();
  const Subject subject = subject_of(selected.the_case);
  drive(*reference, subject, law);
  return {outputs_of(law), answers_of_faults(law, subject)};
}

}  // namespace

bool SelfDiagnosis::is_named() const {
  if (!diagnosis || diagnosis->suspects.empty()) return false;
  const Suspect& first = diagnosis->suspects.front();
  return first.fault == fault ||
         std::find(first.or_else.begin(), first.or_else.end(), fault) != first.or_else.end();
}

bool SelfDiagnosis::is_stage_named() const { return diagnosis && diagnosis->stage == fault->stage; }

std::vector<SelfDiagnosis> diagnose_catalogue(const std::vector<SelectedCase>& cases) {
  const auto catalogue = faults::catalogue();
  std::vector<std::vector<VectorLikeness>> vectors(catalogue.size());
  for (const SelectedCase& selected : cases) {
    const Answers answers = answers_to(selected);
    for (std::size_t i = 0; i < catalogue.size(); ++i) {
      vectors[i].push_back(likeness(answers.faults[i], answers.law, answers.faults));
    }
  }
  std::vector<SelfDiagnosis> results;
  for (std::size_t i = 0; i < catalogue.size(); ++i) {
    if (catalogue[i]->is_killable()) results.push_back({catalogue[i], diagnose(vectors[i])});
  }
  return results;
}

}  // namespace attest
