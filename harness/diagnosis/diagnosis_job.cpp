#include "harness/diagnosis/diagnosis_job.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include <nlohmann/json.hpp>

#include "harness/casefile/stimulus.hpp"
#include "harness/compare/compare.hpp"
#include "harness/core/error_json.hpp"
#include "harness/golden/reference.hpp"
#include "harness/loop/open_loop.hpp"
#include "harness/verify/evaluate.hpp"
#include "harness/verify/fixed_step.hpp"
#include "harness/verify/judge.hpp"

namespace attest {
namespace {

// Enough to distinguish the faults of the catalogue, in a second or two.
constexpr std::size_t most_vectors = 48;

struct Vector {
  const Case* the_case;
  Rate rate;
};

double distance_from_250(const Rate& rate) { return std::abs(std::log(rate.period_s() * 250)); }

// One vector of each open-loop case that is not long: among its results that are `wanted`, the one
// nearest to 250 Hz.
template <typename Wanted>
std::vector<Vector> vectors_of(const std::vector<SelectedCase>& cases,
                               const std::vector<VectorResult>& results, Wanted wanted) {
  std::map<std::string, Rate> nearest;
  for (const VectorResult& result : results) {
    if (result.plant_configuration || !wanted(result)) continue;
    const auto [place, is_new] = nearest.try_emplace(result.case_id(), result.rate.motor_unit);
    if (!is_new && distance_from_250(result.rate.motor_unit) < distance_from_250(place->second)) {
      place->second = result.rate.motor_unit;
    }
  }
  std::vector<Vector> vectors;
  for (const SelectedCase& selected : cases) {
    const auto found = nearest.find(selected.the_case.id());
    if (found == nearest.end() || is_long(selected.the_case)) continue;
    vectors.push_back({&selected.the_case, found->second});
  }
  return vectors;
}

void add_spread(const std::vector<Vector>& vectors, const HostOptions& options,
                const faults::Fault* partner, Level level, Jobs<VectorDiagnosis>& jobs) {
  const std::size_t count = std::min(vectors.size(), most_vectors);
  for (std::size_t i = 0; i < count; ++i) {
    const auto& [the_case, rate] = vectors[i * vectors.size() / count];
    jobs.push_back(std::make_unique<DiagnosisJob>(*the_case, rate, partner, options, level));
  }
}

using nlohmann::json;

// The similarities are rows of numbers without keys, because there are hundreds of faults.
json to_json(const VectorDiagnosis& diagnosis) {
  if (!diagnosis) return nullptr;
  json rows = json::array();
  for (const Similarity& one : diagnosis->similarities) {
    rows.push_back({one.matched, one.intersection, one.union_size, one.deviates ? 1 : 0});
  }
  return {{"ticks", diagnosis->ticks},
          {"deviates", diagnosis->deviates},
          {"faults", rows},
          {"stages", diagnosis->stages.to_ulong()},
          {"case", diagnosis->case_id},
          {"library", diagnosis->library.with_set},
          {"single_calls", diagnosis->library.with_single}};
}

VectorDiagnosis diagnosis_from(const json& in) {
  if (in.is_null()) return std::nullopt;
  VectorSimilarity out;
  out.ticks = in.at("ticks").get<std::size_t>();
  out.deviates = in.at("deviates").get<bool>();
  for (const json& row : in.at("faults")) {
    const auto number = [&row](std::size_t i) { return row.at(i).get<std::size_t>(); };
    out.similarities.push_back({number(0), number(1), number(2), number(3) != 0});
  }
  out.stages = StageSet(in.at("stages").get<unsigned long>());
  out.case_id = in.at("case").get<std::string>();
  in.at("library").get_to(out.library.with_set);
  in.at("single_calls").get_to(out.library.with_single);
  return out;
}

}  // namespace

std::string Codec<VectorDiagnosis>::encode(const Result<VectorDiagnosis>& result) {
  return attest::encode(result.map([](const VectorDiagnosis& one) { return to_json(one); }));
}

Result<VectorDiagnosis> Codec<VectorDiagnosis>::decode(const std::string& text) {
  return attest::decode(text).map(diagnosis_from);
}

Result<VectorDiagnosis> DiagnosisJob::run(std::size_t) {
  const auto host = start_host(options_);
  if (!host) return tl::unexpected(host.error());
  const Declarations& port = (*host)->declarations();
  if (marks_declined(port, case_.group)) return std::nullopt;
  Trace got = inputs_for(port, case_, rate_);
  auto outputs = reference_outputs(subject_of(case_), got);
  if (!outputs) return std::nullopt;
  Trace law = *std::move(outputs);
  const ModuleUnderTest subject = subject_of(case_);
  if ((*host)->drive(subject, got)) return std::nullopt;
  const auto at = [&](Level level) {
    return tolerances_of(case_, level, port.fraction_bits, law.samples.size());
  };
  const bool is_exact = level_ == Level::exact && partner_ == nullptr;
  auto library = is_exact ? library_matches(got, port, case_, at(level_)) : LibraryMatches();
  if (!library) return tl::unexpected(library.error());
  fill_in(port.lacks.outputs, law, got);
  const Tolerances tolerances = at(Level::numeric);
  VectorSimilarity found =
      similarity(outputs_of(got), outputs_of(law), answers_of_faults(law, subject, partner_),
                 subject.module, tolerances);
  Comparison comparison = compare(got, law, tolerances);
  if (is_exact && !comparison.first) comparison = compare(got, law, at(level_));
  if (comparison.first) found.stages = stages_of(*comparison.first);
  found.case_id = case_.id();
  found.library = *std::move(library);
  return found;
}

Jobs<VectorDiagnosis> diagnosis_jobs(const std::vector<SelectedCase>& cases,
                                     const std::vector<VectorResult>& results,
                                     const HostOptions& options, const faults::Fault* partner,
                                     Level level) {
  const auto failed = [](const VectorResult& result) {
    return result.first && fails_a_run(result.verdict);
  };
  const auto passed = [](const VectorResult& result) { return result.verdict == Verdict::pass; };
  Jobs<VectorDiagnosis> jobs;
  const auto failing = vectors_of(cases, results, failed);
  if (failing.empty()) return jobs;
  add_spread(failing, options, partner, level, jobs);
  add_spread(vectors_of(cases, results, passed), options, partner, level, jobs);
  return jobs;
}

}  // namespace attest
