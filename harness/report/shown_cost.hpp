// How the report of `attest time` shows the cost of a step.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "harness/report/document.hpp"
#include "harness/report/time_document.hpp"

namespace attest {

// How costs are shown: as times, or as counts of cycles or instructions.
class Shown {
 public:
  explicit Shown(const std::optional<CostCounter>& counter)
      : are_counts_(counter && counter->unit != CostUnit::nanoseconds),
        unit_(are_counts_ ? name_of(counter->unit) : "us"),
        cost_ns_(cost_ns(counter)) {}

  std::string_view unit() const { return unit_; }  // of cell() and number()
  std::string_view what() const { return are_counts_ ? "cost" : "time"; }
  // Cost(1), if it is the unit.
  Cost scale() const { return are_counts_ ? Cost(1) : Cost(1000); }

  Cell cell(Cost cost, std::optional<Verdict> verdict = {}) const {
    return are_counts_ ? Cell(count_text(cost.count()), verdict) : Cell(cost, verdict);
  }
  double number(Cost cost) const {
    return static_cast<double>(cost.count()) / static_cast<double>(scale().count());
  }
  // Empty if costs have no duration.
  std::optional<double> in_ns(Cost cost) const {
    if (!cost_ns_) return std::nullopt;
    return static_cast<double>(cost.count()) * *cost_ns_;
  }
  // The inverse, in unit(). REQUIRES: costs have a duration.
  double number_of_us(double us) const {
    return us * 1000 / *cost_ns_ / static_cast<double>(scale().count());
  }

 private:
  bool are_counts_;
  std::string_view unit_;
  std::optional<double> cost_ns_;
};

std::string in_unit(std::string_view name, const Shown& shown);  // "max [cycles]"

// The slowest step of a module at a rate.
struct Period {
  Module module;
  const VectorTimes* slowest;
  double share;  // of the period
};

// In the order of modules and rates. Empty if costs have no duration.
std::vector<Period> periods_of(const TimeRun& run);

}  // namespace attest
