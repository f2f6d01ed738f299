// One wrong controller of the catalogue against the corpus, until something catches it: how good
// the suite is, not how good a port is.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "controller/faults/fault.hpp"
#include "harness/suite/batch.hpp"

namespace attest {

class FaultBatch final : public Batch {
 public:
  // `cases` are open loop, all of `profile`, and outlive this.
  FaultBatch(const faults::Fault& fault, faults::Profile profile,
             const std::vector<SelectedCase>& cases, std::filesystem::path golden_root,
             std::optional<int> fraction_bits)
      : fault_(fault),
        profile_(profile),
        cases_(cases),
        golden_root_(std::move(golden_root)),
        fraction_bits_(fraction_bits) {}

  std::size_t size() const override { return 1; }

  std::size_t most_parts() const override;

  // Profile, and the fault's group and name.
  CaseResult identity(std::size_t i) const override;

  // Cases of the fault's own group come first, and of each group 250 Hz. The verdict is what the
  // first case gave that caught it, `reason` the id of that case; pass when it survived all. Cases
  // on a threshold are judged at the exact level, the others at the numeric one. The port is not
  // used: the fault is one.
  Result<CaseResult> evaluate(std::size_t i, Port& port) override;

 private:
  const faults::Fault& fault_;
  faults::Profile profile_;
  const std::vector<SelectedCase>& cases_;
  std::filesystem::path golden_root_;
  std::optional<int> fraction_bits_;  // judged as a port with so many would be
};

}  // namespace attest
