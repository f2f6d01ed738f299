// The values of parameters, tick by tick, as the columns of a trace file have them.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "harness/trace/trace.hpp"

namespace attest {

class ParameterValues {
 public:
  // REQUIRES: both outlive this.
  ParameterValues(const Trace& trace, const std::vector<std::string>& names)
      : names_(names), pending_(trace.parameters), values_(names.size()) {}

  // The values at `tick` in the order of the names; 0 if not set yet. REQUIRES: `tick` does not
  // decrease from call to call.
  const std::vector<float>& at(std::size_t tick) {
    for (const ParameterChange& change : pending_.take_until(tick)) {
      const auto name = std::find(names_.begin(), names_.end(), change.name);
      if (name == names_.end()) continue;
      values_[static_cast<std::size_t>(name - names_.begin())] = change.value;
    }
    return values_;
  }

 private:
  const std::vector<std::string>& names_;
  PendingChanges pending_;
  std::vector<float> values_;
};

}  // namespace attest
