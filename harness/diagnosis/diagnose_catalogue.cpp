#include "harness/diagnosis/diagnose_catalogue.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "harness/casefile/stimulus.hpp"
#include "harness/compare/compare.hpp"
#include "harness/golden/golden.hpp"
#include "harness/golden/reference.hpp"
#include "harness/loop/open_loop.hpp"

namespace attest {
namespace {

// The outputs of all faults on one vector, and for each distinct one as a port its similarity to
// all distinct ones, and the stages of its first deviation.
struct Answered {
  FaultAnswers faults;
  std::vector<VectorSimilarity> of_distinct;
  std::vector<StageSet> stages;
};

Rate rate_for(const SelectedCase& selected) {
  for (const RunConfiguration& configuration : selected.configurations) {
    if (configuration.rate == Rate::hz(250)) return configuration.rate.motor_unit;
  }
  return selected.configurations.front().rate.motor_unit;
}

StageSet first_stages(const Outputs& outputs, const Trace& law) {
  if (outputs.empty()) return {};
  const Comparison comparison = compare(with_outputs(law, outputs), law, Tolerances());
  return comparison.first ? stages_of(*comparison.first) : StageSet();
}

// The stages with outputs of their own that contain a stage of the catalogue; empty if there are
// none. Examples are the input, the mode, the parameters and the time step, which several stages
// use.
StageSet visible_stages(faults::Stage stage) {
  using In = faults::Stage;
  switch (stage) {
    case In::tilt:
    case In::yaw:
    case In::blend:
    case In::limit:
    case In::feed_forward:
    case In::recovery:
    case In::reference_model:
    case In::autotune:
      return only(Stage::attitude_law);
    case In::weathervane:  // resets the yaw integral, too
      return only(Stage::attitude_law) | only(Stage::integrator);
    case In::p:  // of both laws
      return only(Stage::attitude_law) | only(Stage::rate_law);
    case In::tpa:
    case In::d:
    case In::ff:
    case In::yaw_filter:
      return only(Stage::rate_law);
    case In::i:  // the term of the control, and the integral itself
      return only(Stage::rate_law) | only(Stage::integrator);
    case In::gate:
    case In::saturation:
      return only(Stage::integrator);
    case In::scaling:
      return only(Stage::actuators);
    case In::sticks:
    case In::yaw_lock:
    case In::throttle:
      return only(Stage::sticks);
    case In::estimator_reset:  // of the setpoint in the attitude law, and of the yaw of the sticks
      return only(Stage::sticks) | only(Stage::attitude_law);
    case In::mixer_scaling:
    case In::mixer_fit:
    case In::mixer_yaw:
    case In::mixer_output:
      return only(Stage::mixer);
    case In::battery_status:
      return only(Stage::battery_status);
    case In::input:
    case In::guard:
    case In::mode:
    case In::arming:
    case In::parameters:
    case In::timing:
    case In::output:
    case In::latching:
    case In::functions:
      return {};
  }
  return {};
}

Answered answered(const SelectedCase& selected) {
  const ModuleUnderTest subject = subject_of(selected.the_case);
  // A case of the suite, for which the reference has no fault.
  const Trace law =
      reference_outputs(subject, stimulate(selected.the_case, rate_for(selected))).value();
  Answered vector{answers_of(each_fault(), law, subject), {}, {}};
  const Outputs right = outputs_of(law);
  for (const Outputs& outputs : vector.faults.distinct) {
    vector.of_distinct.push_back(
        distinct_similarity(outputs, right, vector.faults.distinct, subject.module));
    vector.stages.push_back(first_stages(outputs, law));
    vector.of_distinct.back().case_id = selected.the_case.id();
  }
  vector.faults.distinct.clear();  // some hundred megabytes in all
  return vector;
}

// Of one fault, or of the law.
Similarity similarity_in(const VectorSimilarity& vector, const Hypothesis& hypothesis) {
  if (!hypothesis.empty()) {
    return vector.similarities[index_in_catalogue(*hypothesis.front())];
  }
  Similarity law;
  law.parted = vector.deviating;
  law.misfit = vector.misfit;
  return law;
}

// One fault is the port, so it explains all, and no faults need to act together.
Evidence evidence_of(const std::vector<VectorSimilarity>& vectors, std::size_t failing) {
  Evidence evidence;
  evidence.failing = failing;
  evidence.passing = vectors.size() - failing;
  evidence.compare = [&vectors](const auto& indices, const std::vector<Hypothesis>& hypotheses) {
    std::vector<VectorSimilarity> found;
    for (const std::size_t index : indices) {
      found.push_back(vectors[index]);
      found.back().similarities.clear();
      for (const Hypothesis& hypothesis : hypotheses) {
        if (hypothesis.size() > 1) return std::vector<VectorSimilarity>();
        found.back().similarities.push_back(similarity_in(vectors[index], hypothesis));
      }
    }
    return found;
  };
  return evidence;
}

}  // namespace

bool SelfDiagnosis::is_named() const {
  if (!diagnosis || diagnosis->suspects.empty()) return false;
  const Suspect& first = diagnosis->suspects.front();
  return first.fault == fault ||
         std::find(first.ambiguity_group.begin(), first.ambiguity_group.end(), fault) !=
             first.ambiguity_group.end();
}

StageLine stage_line(faults::Stage stage, const StageSet& reported) {
  const StageSet visible = visible_stages(stage);
  if (visible.none()) return StageLine::later;
  return (visible & reported).any() ? StageLine::own : StageLine::wrong;
}

StageLine SelfDiagnosis::usual_stage_line() const {
  for (const StageLine line : {StageLine::own, StageLine::later}) {
    const auto count = std::count(stage_lines.begin(), stage_lines.end(), line);
    if (2 * static_cast<std::size_t>(count) > stage_lines.size()) return line;
  }
  return StageLine::wrong;
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
    std::vector<VectorSimilarity> of_fault, passing;
    std::vector<StageLine> lines;
    for (const Answered& vector : vectors) {
      const std::size_t distinct = vector.faults.of_fault[i];
      VectorSimilarity one = of_each_fault(vector.of_distinct[distinct], vector.faults);
      const StageSet& stages = vector.stages[distinct];
      if (stages.any()) lines.push_back(stage_line(catalogue[i]->stage, stages));
      (one.deviating != 0 ? of_fault : passing).push_back(std::move(one));
    }
    const std::size_t failing = of_fault.size();
    std::move(passing.begin(), passing.end(), std::back_inserter(of_fault));
    results.push_back({catalogue[i], diagnose(evidence_of(of_fault, failing)), std::move(lines)});
  }
  return results;
}

}  // namespace attest
