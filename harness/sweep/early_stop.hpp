// Finds the sample after which a sweep may end: all its requirements are decided, and with a port
// there are enough samples for the sign tests.
//
// The samples are counted in the order of their indices, so a sweep ends at the same sample with
// any number of jobs, and after a kill.
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

  // Adds the next sample. REQUIRES: a row of these columns.
  void add(const SampleRow& row);

  // False if the sweep has no `stop_when_decided`.
  bool is_decided() const;

 private:
  const SweepFile& sweep_;
  std::vector<std::size_t> metrics_;  // of each requirement: the index of its metric
  std::vector<std::uint64_t> held_;   // of each requirement: the flights that hold it
  std::uint64_t fewest_;              // samples that a comparison with the reference needs
  std::uint64_t count_ = 0;
};

}  // namespace attest
