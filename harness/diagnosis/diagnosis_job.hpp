// Runs a port, and every fault of the catalogue, on some vectors of the suite.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "harness/casefile/select.hpp"
#include "harness/diagnosis/similarity.hpp"
#include "harness/host/port_process.hpp"
#include "harness/verify/port_job.hpp"
#include "harness/verify/verdict.hpp"

namespace attest {

// Empty when the port declares the case's group as unsupported, or has a fault.
using VectorDiagnosis = std::optional<VectorSimilarity>;

template <>
struct Codec<VectorDiagnosis> {
  static std::string encode(const Result<VectorDiagnosis>& result);
  static Result<VectorDiagnosis> decode(const std::string& text);
};

// Runs port and faults on one vector.
class DiagnosisJob final : public PortJob<VectorDiagnosis> {
 public:
  // With a `partner`, each fault is combined with it. `level`: of the verdict. REQUIRES: an
  // open-loop case, which outlives this.
  DiagnosisJob(const Case& the_case, const Rate& rate, const faults::Fault* partner,
               HostOptions options, Level level = Level::numeric)
      : PortJob(std::move(options)),
        case_(the_case),
        rate_(rate),
        partner_(partner),
        level_(level) {}

  std::size_t size() const override { return 1; }
  Result<VectorDiagnosis> run(std::size_t task) override;

 private:
  const Case& case_;
  Rate rate_;
  const faults::Fault* partner_;
  Level level_;
};

// Jobs for up to 48 vectors that failed with a deviation, and for up to 48 vectors that passed.
// Takes one failed and one passed vector per case, at the rate nearest to 250 Hz, spread over the
// suite. Leaves out flights and long cases. No jobs if no vector failed. REQUIRES: `cases` are
// those that were run, and outlive the jobs.
Jobs<VectorDiagnosis> diagnosis_jobs(const std::vector<SelectedCase>& cases,
                                     const std::vector<VectorResult>& results,
                                     const HostOptions& options,
                                     const faults::Fault* partner = nullptr,
                                     Level level = Level::numeric);

}  // namespace attest
