#include "harness/diagnosis/diagnose_run.hpp"

#include <algorithm>
#include <iterator>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "harness/casefile/stimulus.hpp"
#include "harness/diagnosis/diagnosis_job.hpp"
#include "harness/diagnosis/remarks.hpp"
#include "harness/verify/declared_lacks.hpp"

namespace attest {
namespace {

// The vectors of a diagnosis, and the jobs that compare them.
class Laboratory {
 public:
  Laboratory(const HostOptions& host, const DiagnosisOptions& options, const RunResult& run)
      : host_(host),
        options_(options),
        level_(run.level),
        share_(share_of_tolerances(run.results, run.level)) {}

  // Runs the port on the vectors that failed; at the levels exact and events also on those that
  // passed, because their outputs need not agree with the law's at the level numeric.
  void run_port(const std::vector<DiagnosisVector>& vectors);
  // The results are in the order of `vectors`. Empty after an error.
  std::vector<VectorComparison> compare(const std::vector<std::size_t>& vectors,
                                        const std::vector<Hypothesis>& hypotheses, bool observes);
  Evidence evidence();
  // From now on compares within about the bounds of the level events.
  void compare_grossly() { is_gross_ = true; }

 private:
  template <typename R>
  std::vector<R> results_of(const Jobs<R>& jobs, bool in_process);

  const HostOptions& host_;
  const DiagnosisOptions& options_;
  Level level_;
  std::vector<AnsweredVector> vectors_;
  std::vector<LibraryMatches> library_;  // of each vector, at the level exact
  std::size_t failing_ = 0;
  bool is_gross_ = false;
  double share_;  // of the tolerances
};

template <typename R>
std::vector<R> Laboratory::results_of(const Jobs<R>& jobs, bool in_process) {
  JobOptions<R> options;
  options.processes = options_.processes;
  options.in_process = in_process;
  options.stop = options_.stop;
  auto outcome = run_jobs(jobs, options);
  if (!outcome.errors.empty()) options_.on_error(outcome.errors.front());
  return std::move(outcome.results);
}

void Laboratory::run_port(const std::vector<DiagnosisVector>& vectors) {
  // A program may need seconds to start. A library runs each vector alone.
  const std::size_t most_together = kind_of(host_.port).is_program ? 48 : 1;
  Jobs<VectorAnswer> jobs;
  std::vector<DiagnosisVector> asked;
  for (const DiagnosisVector& vector : vectors) {
    if (vector.failed || level_ != Level::numeric) asked.push_back(vector);
  }
  for (auto begin = asked.begin(); begin != asked.end();) {
    const auto left = static_cast<std::size_t>(asked.end() - begin);
    const auto end = begin + static_cast<std::ptrdiff_t>(std::min(left, most_together));
    jobs.push_back(std::make_unique<PortAnswerJob>(std::vector(begin, end), host_, level_));
    begin = end;
  }
  const auto answers = results_of(jobs, host_.in_process);
  if (answers.size() != asked.size()) return;
  for (std::size_t i = 0; i < asked.size(); ++i) {
    if (!answers[i]) continue;
    vectors_.push_back({asked[i], std::make_shared<const Outputs>(answers[i]->outputs),
                        answers[i]->fraction_bits, answers[i]->fixed_step});
    library_.push_back(answers[i]->library);
    failing_ += asked[i].failed ? 1 : 0;
  }
  if (vectors_.empty() || level_ != Level::numeric) return;
  for (const DiagnosisVector& vector : vectors) {
    if (vector.failed) continue;
    vectors_.push_back(
        {vector, nullptr, vectors_.front().fraction_bits, vectors_.front().fixed_step});
  }
}

std::vector<VectorComparison> Laboratory::compare(const std::vector<std::size_t>& vectors,
                                                  const std::vector<Hypothesis>& hypotheses,
                                                  bool observes) {
  Jobs<VectorComparison> jobs;
  for (const std::size_t index : vectors) {
    jobs.push_back(
        std::make_unique<ComparisonJob>(vectors_[index], hypotheses, observes, is_gross_, share_));
  }
  auto results = results_of(jobs, host_.in_process);
  if (results.size() != vectors.size()) results.clear();
  return results;
}

Evidence Laboratory::evidence() {
  Evidence evidence;
  evidence.failing = failing_;
  evidence.passing = vectors_.size() - failing_;
  evidence.compare = [this](const auto& vectors, const auto& hypotheses) {
    std::vector<VectorSimilarity> similarities;
    for (VectorComparison& one : compare(vectors, hypotheses, false)) {
      similarities.push_back(std::move(one.similarity));
    }
    return similarities;
  };
  evidence.observe = [this](const auto& vectors, const Hypothesis& hypothesis) {
    std::vector<ObservedVector> observed;
    auto results = compare(vectors, {hypothesis}, true);
    for (std::size_t i = 0; i < results.size(); ++i) {
      observed.push_back({vectors_[vectors[i]].vector.the_case->group,
                          std::move(results[i].observation), results[i].first});
    }
    return observed;
  };
  if (level_ != Level::exact) return evidence;
  std::vector<std::size_t> all;
  for (std::size_t i = 0; i < vectors_.size(); ++i) all.push_back(i);
  const auto numeric = compare(all, {Hypothesis{}}, false);
  for (std::size_t i = 0; i < numeric.size(); ++i) {
    const VectorSimilarity& one = numeric[i].similarity;
    evidence.exact.push_back({one.ticks, one.deviating != 0, library_[i], one.stage});
  }
  return evidence;
}

// The parameters with which the run judged the vector.
std::vector<ParameterChange> parameters_of(const RunResult& run, const DiagnosisVector& vector) {
  std::vector<ParameterChange> parameters = run.parameters;
  if (run.lacks.constants.empty()) return parameters;
  VectorResult ignored;
  const Trace inputs = stimulate(*vector.the_case, vector.rate);
  adds_constants(run.lacks, subject_of(*vector.the_case), inputs, parameters, ignored);
  return parameters;
}

// At the level events a port may be coarse: then no fault has its values. If the faults leave most
// failing vectors unexplained, those that have its values within the bounds of the level are
// searched, too.
std::optional<Diagnosis> diagnose_grossly(Laboratory& laboratory, std::optional<Diagnosis> found) {
  if (!found || 2 * found->unexplained <= found->failing) return found;
  laboratory.compare_grossly();
  auto gross = diagnose(laboratory.evidence());
  if (!gross || gross->suspects.empty() || 2 * gross->unexplained > gross->failing) return found;
  gross->remarks.emplace_back(
      "a listed fault has the port's values within about the bounds of the level events only");
  return gross;
}

}  // namespace

double share_of_tolerances(const std::vector<VectorResult>& results, Level level) {
  // In the ports of tests/ports/several, right faults are within 0.03, and near misses beyond 0.7.
  constexpr double least = 0.1;
  std::vector<double> deviations;  // as shares of the tolerance
  for (const VectorResult& result : results) {
    if (result.verdict != Verdict::pass || !result.compared) continue;
    deviations.push_back(result.tightest ? 1 / result.tightest->ratio : 0);
  }
  if (deviations.empty() || level != Level::numeric) return 1;
  const auto rounding =
      deviations.begin() + static_cast<std::ptrdiff_t>(deviations.size() * 9 / 10);
  std::ranges::nth_element(deviations, rounding);
  return std::clamp(10 * *rounding, least, 1.0);
}

std::optional<Diagnosis> diagnose_run(const RunResult& run, const std::vector<SelectedCase>& cases,
                                      const HostOptions& host, const DiagnosisOptions& options) {
  Laboratory laboratory(host, options, run);
  auto vectors = diagnosis_vectors(cases, run.results);
  for (DiagnosisVector& vector : vectors) vector.parameters = parameters_of(run, vector);
  laboratory.run_port(vectors);
  std::optional<Diagnosis> diagnosis = diagnose(laboratory.evidence());
  if (run.level == Level::events) diagnosis = diagnose_grossly(laboratory, std::move(diagnosis));
  std::vector<std::string> remarks = remarks_on(run.results);
  const auto failed = std::ranges::count_if(
      run.results, [](const VectorResult& result) { return fails_a_run(result.verdict); });
  if (diagnosis && diagnosis->failing < static_cast<std::size_t>(failed)) {
    remarks.push_back(
        fmt::format("{} of the {} failing vectors were examined", diagnosis->failing, failed));
  }
  if (!diagnosis && remarks.empty()) return std::nullopt;
  if (!diagnosis) diagnosis.emplace();
  std::ranges::move(remarks, std::back_inserter(diagnosis->remarks));
  for (const SelectedCase& one : cases) {
    if (one.the_case.id() == diagnosis->specific_case) diagnosis->why = one.the_case.why;
  }
  return diagnosis;
}

}  // namespace attest
