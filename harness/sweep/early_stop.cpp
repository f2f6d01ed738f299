#include "harness/sweep/early_stop.hpp"

#include <algorithm>

#include "harness/sweep/compare_pilots.hpp"
#include "harness/sweep/sequential.hpp"

namespace attest {

EarlyStop::EarlyStop(const SweepFile& sweep, const SampleColumns& columns)
    : sweep_(sweep),
      fewest_(columns.with_port ? pairs_to_compare(sweep, columns.metrics.size()) : 0) {
  for (const Requirement& requirement : sweep.requirements) {
    metrics_.push_back(columns.place_of(requirement.metric));
  }
  held_.resize(metrics_.size());
}

void EarlyStop::add(const SampleRow& row) {
  ++count_;
  for (std::size_t i = 0; i < metrics_.size(); ++i) {
    const double value = row.flights.back().metrics[metrics_[i]];
    if (sweep_.requirements[i].holds(value)) ++held_[i];
  }
}

bool EarlyStop::is_decided() const {
  if (!sweep_.stop_when_decided || count_ < fewest_) return false;
  for (std::size_t i = 0; i < held_.size(); ++i) {
    const double probability = sweep_.requirements[i].probability;
    if (!excludes(held_[i], count_, probability, sweep_.confidence)) return false;
  }
  return true;
}

}  // namespace attest
