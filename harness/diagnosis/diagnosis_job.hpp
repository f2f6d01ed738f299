// The vectors of a run on which a diagnosis compares the port with faults, and the jobs for it: one
// runs the port on a vector, the other compares its outputs with those of faults.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "harness/casefile/select.hpp"
#include "harness/diagnosis/observation.hpp"
#include "harness/diagnosis/similarity.hpp"
#include "harness/host/port_process.hpp"
#include "harness/verify/port_job.hpp"
#include "harness/verify/verdict.hpp"

namespace attest {

// What a port answered to a vector.
struct PortAnswer {
  Outputs outputs;              // those that a recording lacks are the law's
  LibraryMatches library = {};  // at the level exact
  // Declared by the port.
  std::optional<int> fraction_bits = {};
  std::optional<Rate> fixed_step = {};
};

// Empty when the port declares the case's group as unsupported, or has a fault.
using VectorAnswer = std::optional<PortAnswer>;

template <>
struct Codec<VectorAnswer> {
  static std::string encode(const Result<VectorAnswer>& result);
  static Result<VectorAnswer> decode(const std::string& text);
};

// A vector of the diagnosis. An open-loop case.
struct DiagnosisVector {
  const Case* the_case = nullptr;
  Rate rate;
  bool failed = false;                           // in the run
  std::vector<ParameterChange> parameters = {};  // replace those of the case
};

// Up to 240 vectors that failed with a deviation, then up to 120 that passed, spread over the
// suite. One vector of each case, at the rate nearest to 250 Hz; of the same case in several
// profiles, one that failed. Leaves out flights and long cases, and those with several instances if
// the instances share state: another vector fails only after others. Empty if no vector failed.
// REQUIRES: `cases` are those that were run, and outlive the result.
std::vector<DiagnosisVector> diagnosis_vectors(const std::vector<SelectedCase>& cases,
                                               const std::vector<VectorResult>& results);

// Runs the port on vectors, in one process unless it fails. `level`: of the verdict. REQUIRES: the
// cases of the vectors outlive this.
class PortAnswerJob final : public PortJob<VectorAnswer> {
 public:
  PortAnswerJob(std::vector<DiagnosisVector> vectors, HostOptions options,
                Level level = Level::numeric)
      : PortJob(std::move(options)), vectors_(std::move(vectors)), level_(level) {}

  std::size_t size() const override { return vectors_.size(); }
  Result<void> open() override;
  Result<VectorAnswer> run(std::size_t task) override;
  bool is_spent() const override { return !host_ || has_failed_; }
  void close() override { host_.reset(); }

 private:
  std::vector<DiagnosisVector> vectors_;
  Level level_;
  std::unique_ptr<PortHost> host_;
  bool has_failed_ = false;
};

// A vector, and what the port answered. The outputs are null if they are the law's.
struct AnsweredVector {
  DiagnosisVector vector;
  std::shared_ptr<const Outputs> outputs = nullptr;
  std::optional<int> fraction_bits = {};
  std::optional<Rate> fixed_step = {};
};

// The similarities of the hypotheses, and how the port deviates from the first of them.
struct VectorComparison {
  VectorSimilarity similarity;
  // Only if requested.
  Observation observation;
  std::optional<FirstStage> first;
};

template <>
struct Codec<VectorComparison> {
  static std::string encode(const Result<VectorComparison>& result);
  static Result<VectorComparison> decode(const std::string& text);
};

class ComparisonJob final : public Job<VectorComparison> {
 public:
  // `is_gross`: compares units that have events by gross_tolerances(). `share`: of the tolerances,
  // within which values are the same. REQUIRES: the arguments outlive this.
  ComparisonJob(const AnsweredVector& vector, const std::vector<Hypothesis>& hypotheses,
                bool observes, bool is_gross = false, double share = 1)
      : vector_(vector),
        hypotheses_(hypotheses),
        observes_(observes),
        is_gross_(is_gross),
        share_(share) {}

  std::size_t size() const override { return 1; }
  Result<VectorComparison> run(std::size_t task) override;

 private:
  const AnsweredVector& vector_;
  const std::vector<Hypothesis>& hypotheses_;
  bool observes_, is_gross_;
  double share_;
};

}  // namespace attest
