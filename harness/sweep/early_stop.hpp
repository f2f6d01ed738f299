// Ends a sweep when all its requirements are decided.
//
// The samples are counted in their order, so a sweep ends at the same sample with any number of
// jobs, and after a kill.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "harness/sweep/sample_table.hpp"
#include "harness/sweep/sweep_file.hpp"

namespace attest {

class EarlyStop {
 public:
  // REQUIRES: `sweep` and `columns` outlive this.
  EarlyStop(const SweepFile& sweep, const SampleColumns& columns);

  // The next sample. REQUIRES: a row of these columns.
  void add(const SampleRow& row);

  // False if the sweep has no `stop_when_decided`.
  bool is_decided() const;

 private:
  const SweepFile& sweep_;
  std::vector<std::size_t> metrics_;  // of each requirement
  std::vector<std::uint64_t> held_;
  std::uint64_t fewest_;  // samples, to compare the port with the reference
  std::uint64_t count_ = 0;
};

}  // namespace attest
