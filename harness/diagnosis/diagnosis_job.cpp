#include "harness/diagnosis/diagnosis_job.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include <nlohmann/json.hpp>

#include "harness/casefile/stimulus.hpp"
#include "harness/compare/compare.hpp"
#include "harness/compare/gross.hpp"
#include "harness/core/error_json.hpp"
#include "harness/diagnosis/remarks.hpp"
#include "harness/golden/reference.hpp"
#include "harness/loop/open_loop.hpp"
#include "harness/verify/evaluate.hpp"
#include "harness/verify/fixed_step.hpp"
#include "harness/verify/judge.hpp"

namespace attest {
namespace {

// All failing cases of a suite of one law, so that each of several mistakes has vectors of its own.
constexpr std::size_t most_failing = 240;
// Enough to refute a fault that deviates where the port does not.
constexpr std::size_t most_passing = 120;

double distance_from_250(const Rate& rate) { return distance_of(rate, 250); }

// One vector of each open-loop case that is not long: among its results that are `wanted`, the one
// nearest to 250 Hz.
template <typename Wanted>
std::vector<DiagnosisVector> vectors_of(const std::vector<SelectedCase>& cases,
                                        const std::vector<VectorResult>& results, Wanted wanted) {
  std::map<std::string, Rate> nearest;
  for (const VectorResult& result : results) {
    if (result.plant_configuration || !wanted(result)) continue;
    const auto [place, is_new] = nearest.try_emplace(result.case_id(), result.rate.motor_unit);
    if (!is_new && distance_from_250(result.rate.motor_unit) < distance_from_250(place->second)) {
      place->second = result.rate.motor_unit;
    }
  }
  std::vector<DiagnosisVector> vectors;
  for (const SelectedCase& selected : cases) {
    const auto found = nearest.find(selected.the_case.id());
    if (found == nearest.end() || is_long(selected.the_case)) continue;
    vectors.push_back({&selected.the_case, found->second});
  }
  return vectors;
}

// The case without its profile: the same file serves several profiles.
using CaseName = std::tuple<Module, std::string, std::string>;
CaseName name_of(const DiagnosisVector& vector) {
  const Case& the_case = *vector.the_case;
  return {subject_of(the_case).module, the_case.group, the_case.name};
}

// Adds up to `most` vectors of cases whose name is not yet in `names`.
void add_spread(const std::vector<DiagnosisVector>& vectors, std::size_t most, bool failed,
                std::set<CaseName>& names, std::vector<DiagnosisVector>& result) {
  std::vector<DiagnosisVector> fresh;
  for (auto vector = vectors.rbegin(); vector != vectors.rend(); ++vector) {
    if (names.insert(name_of(*vector)).second) fresh.push_back(*vector);
  }
  std::reverse(fresh.begin(), fresh.end());
  const std::size_t count = std::min(fresh.size(), most);
  for (std::size_t i = 0; i < count; ++i) {
    result.push_back(fresh[i * fresh.size() / count]);
    result.back().failed = failed;
  }
}

using nlohmann::json;

json to_json(const std::optional<Stage>& stage) {
  return stage ? json(static_cast<int>(*stage)) : json();
}

std::optional<Stage> stage_from(const json& in) {
  if (in.is_null()) return std::nullopt;
  return static_cast<Stage>(in.get<int>());
}

// The similarities are rows of numbers without keys, because there are hundreds of faults.
json to_json(const VectorComparison& comparison) {
  const VectorSimilarity& similarity = comparison.similarity;
  json rows = json::array();
  for (const Similarity& one : similarity.similarities) {
    rows.push_back({one.matched, one.same, one.other, one.deviating, one.parted, one.misfit,
                    one.acts, one.parts});
  }
  return {{"ticks", similarity.ticks},
          {"deviating", similarity.deviating},
          {"misfit", similarity.misfit},
          {"faults", rows},
          {"stage", to_json(similarity.stage)},
          {"case", similarity.case_id},
          {"observation", attest::to_json(comparison.observation)},
          {"counted", comparison.first ? to_json(comparison.first->counted) : json()},
          {"written", comparison.first ? to_json(comparison.first->written) : json()}};
}

VectorComparison comparison_from(const json& in) {
  VectorComparison comparison;
  VectorSimilarity& out = comparison.similarity;
  out.ticks = in.at("ticks").get<std::size_t>();
  out.deviating = in.at("deviating").get<OutputMask>();
  out.misfit = in.at("misfit").get<double>();
  for (const json& row : in.at("faults")) {
    const auto number = [&row](std::size_t i) { return row.at(i).get<std::size_t>(); };
    out.similarities.push_back({number(0), number(1), number(2), row.at(3).get<OutputMask>(),
                                row.at(4).get<OutputMask>(), row.at(5).get<double>(), number(6),
                                number(7)});
  }
  out.stage = stage_from(in.at("stage"));
  out.case_id = in.at("case").get<std::string>();
  comparison.observation = observation_from(in.at("observation"));
  if (const auto counted = stage_from(in.at("counted"))) {
    comparison.first = FirstStage{*counted, *stage_from(in.at("written"))};
  }
  return comparison;
}

std::optional<Stage> stage_in(const Trace& law, const Trace& got, const Tolerances& tolerances) {
  auto first = compare(got, law, tolerances).first;
  if (!first) first = compare(got, law, Tolerances(Level::exact)).first;
  return first ? std::optional(stage_of(*first)) : std::nullopt;
}

std::optional<FirstStage> first_stage(const Trace& got, const Trace& want,
                                      const Tolerances& tolerances) {
  const auto first = compare(got, want, tolerances).first;
  if (!first) return std::nullopt;
  return FirstStage{stage_of(*first), channels()[first->channel].stage};
}

json to_json(const VectorAnswer& answer) {
  if (!answer) return nullptr;
  json out = {{"outputs", hex_of(answer->outputs)},
              {"library", answer->library.with_set},
              {"single_calls", answer->library.with_single}};
  if (answer->fraction_bits) out["fraction_bits"] = *answer->fraction_bits;
  if (answer->fixed_step) out["fixed_step"] = answer->fixed_step->to_string();
  return out;
}

VectorAnswer answer_from(const json& in) {
  if (in.is_null()) return std::nullopt;
  PortAnswer answer{outputs_from(in.at("outputs").get<std::string>())};
  in.at("library").get_to(answer.library.with_set);
  in.at("single_calls").get_to(answer.library.with_single);
  if (in.contains("fraction_bits")) answer.fraction_bits = in.at("fraction_bits").get<int>();
  if (in.contains("fixed_step")) {
    answer.fixed_step = *Rate::parse(in.at("fixed_step").get<std::string>());
  }
  return answer;
}

}  // namespace

std::string Codec<VectorAnswer>::encode(const Result<VectorAnswer>& result) {
  return attest::encode(result.map([](const VectorAnswer& one) { return to_json(one); }));
}

Result<VectorAnswer> Codec<VectorAnswer>::decode(const std::string& text) {
  return attest::decode(text).map(answer_from);
}

std::string Codec<VectorComparison>::encode(const Result<VectorComparison>& result) {
  return attest::encode(result.map([](const VectorComparison& one) { return to_json(one); }));
}

Result<VectorComparison> Codec<VectorComparison>::decode(const std::string& text) {
  return attest::decode(text).map(comparison_from);
}

Result<void> PortAnswerJob::open() {
  host_.reset();  // one process of the port at a time
  has_failed_ = false;
  auto host = start_host(options_);
  if (!host) return tl::unexpected(host.error());
  host_ = *std::move(host);
  return {};
}

Result<VectorAnswer> PortAnswerJob::run(std::size_t task) {
  const DiagnosisVector& vector = vectors_[task];
  const Case& the_case = *vector.the_case;
  const Declarations& port = host_->declarations();
  if (marks_declined(port, the_case.group)) return std::nullopt;
  Trace got = inputs_for(port, the_case, vector.rate, vector.parameters);
  const ModuleUnderTest subject = subject_of(the_case);
  const auto law = reference_outputs(subject, got);
  if (!law) return std::nullopt;
  has_failed_ = host_->drive(subject, got).has_value();
  if (has_failed_) return std::nullopt;
  PortAnswer answer;
  if (level_ == Level::exact) {
    const Tolerances exact =
        tolerances_of(the_case, level_, port.fraction_bits, got.samples.size());
    auto library = library_matches(got, port, the_case, exact);
    if (!library) return tl::unexpected(library.error());
    answer.library = *std::move(library);
  }
  fill_in(port.lacks.outputs, *law, got);
  answer.outputs = outputs_of(got);
  answer.fraction_bits = port.fraction_bits;
  answer.fixed_step = port.fixed_step;
  return answer;
}

Result<VectorComparison> ComparisonJob::run(std::size_t) {
  const Case& the_case = *vector_.vector.the_case;
  Declarations port;
  port.fraction_bits = vector_.fraction_bits;
  port.fixed_step = vector_.fixed_step;
  const ModuleUnderTest subject = subject_of(the_case);
  const auto law = reference_outputs(
      subject, inputs_for(port, the_case, vector_.vector.rate, vector_.vector.parameters));
  if (!law) return tl::unexpected(law.error());
  const Tolerances tolerances =
      is_gross_ && has_events(subject.module)
          ? gross_tolerances()
          : tolerances_of(the_case, Level::numeric, port.fraction_bits, law->samples.size());
  const Outputs right = outputs_of(*law);
  const Outputs& got = vector_.outputs ? *vector_.outputs : right;
  const FaultAnswers answers = answers_of(hypotheses_, *law, subject);
  VectorComparison found;
  found.similarity = similarity(got, right, answers, subject.module, tolerances.scaled(share_));
  found.similarity.case_id = the_case.id();
  if (vector_.outputs) {
    found.similarity.stage = stage_in(*law, with_outputs(*law, got), tolerances);
  }
  if (observes_) {
    const Outputs& expected = answers.distinct[answers.of_fault.front()];
    found.observation = observe(*law, got, expected, subject, tolerances);
    found.first = first_stage(with_outputs(*law, got), with_outputs(*law, expected), tolerances);
  }
  return found;
}

std::vector<DiagnosisVector> diagnosis_vectors(const std::vector<SelectedCase>& cases,
                                               const std::vector<VectorResult>& results) {
  // With state that outlives an instance, the later instances of a case deviate by that state. A
  // fault can have such values by chance.
  const bool shares_state = std::ranges::any_of(results, passes_alone);
  const auto failed = [shares_state](const VectorResult& result) {
    const bool is_of_state = shares_state && result.group == "instances";
    return result.first && fails_a_run(result.verdict) && !is_of_state;
  };
  const auto passed = [](const VectorResult& result) { return result.verdict == Verdict::pass; };
  std::vector<DiagnosisVector> result;
  std::set<CaseName> failing_names, passing_names;
  add_spread(vectors_of(cases, results, failed), most_failing, true, failing_names, result);
  if (result.empty()) return result;
  add_spread(vectors_of(cases, results, passed), most_passing, false, passing_names, result);
  return result;
}

}  // namespace attest
