// Where a vehicle stops holding: the lowest loop rate and the largest delay with which a port still
// flies a case within the bounds of its metrics.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "harness/suite/batch.hpp"

namespace attest {

inline constexpr const char* lowest_rate_figure = "lowest_rate_hz";
// Of the motor commands, beyond the case's own, at the result's rate; below 0: not even without.
inline constexpr const char* largest_delay_figure = "largest_delay_ms";

// One vehicle on one plant. Task 0 looks for the lowest rate, task i for the largest delay at rate
// i - 1. Both are searched by steps and then by halves: what is found is next to one that does not
// hold, and nothing is said of what lies beyond that.
class SweepBatch final : public Batch {
 public:
  SweepBatch(Case the_case, Flyer flyer, std::vector<Rate> rates,
             std::shared_ptr<const Airframe> airframe)
      : case_(std::move(the_case)),
        flyer_(std::move(flyer)),
        rates_(std::move(rates)),
        airframe_(std::move(airframe)) {}

  std::size_t size() const override { return rates_.size() + 1; }
  CaseResult identity(std::size_t i) const override;
  std::size_t most_parts() const override;  // flights that a search takes

  // A verdict other than pass where the port went wrong, and else one of the figures above.
  Result<CaseResult> evaluate(std::size_t i, Port& port) override;

 private:
  Case case_;
  Flyer flyer_;
  std::vector<Rate> rates_;
  std::shared_ptr<const Airframe> airframe_;
};

}  // namespace attest
