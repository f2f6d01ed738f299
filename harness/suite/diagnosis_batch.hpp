// Runs a port on some vectors of the corpus, and beside it every wrong controller of the catalogue.
#pragma once

#include <memory>
#include <vector>

#include "harness/suite/batch.hpp"

namespace attest {

// One vector.
class DiagnosisBatch final : public Batch {
 public:
  // Open loop. The case must outlive this. With a `partner` each fault is tried together with it.
  DiagnosisBatch(const Case& the_case, const Rate& rate, const faults::Fault* partner)
      : case_(the_case), rate_(rate), partner_(partner) {}

  std::size_t size() const override { return 1; }
  CaseResult identity(std::size_t i) const override;

  // The likeness of the result is set unless the port went wrong.
  Result<CaseResult> evaluate(std::size_t i, Port& port) override;

 private:
  const Case& case_;
  Rate rate_;
  const faults::Fault* partner_;
};

// For the vectors that failed with a value, and as many that passed: one rate a case, the one
// nearest to 250 Hz, spread over the corpus. `cases` are those that were run, and must outlive the
// batches.
std::vector<std::unique_ptr<Batch>> diagnosis_batches(const std::vector<SelectedCase>& cases,
                                                      const std::vector<CaseResult>& results,
                                                      const faults::Fault* partner = nullptr);

}  // namespace attest
