#include "harness/trace/trace_parts.hpp"

#include <algorithm>

namespace attest {

std::vector<ParameterChange> changes_in(const std::vector<ParameterChange>& all,
                                        std::size_t first_tick, std::size_t ticks) {
  std::vector<ParameterChange> changes;
  for (const ParameterChange& change : all) {
    if (change.tick < first_tick || change.tick >= first_tick + ticks) continue;
    changes.push_back({change.tick - first_tick, change.name, change.value});
  }
  return changes;
}

Result<void> PartsOfTrace::next_part(std::size_t most, Trace& part) {
  const auto begin = whole_.samples.begin() + static_cast<std::ptrdiff_t>(next_);
  const std::size_t ticks = std::min(most, whole_.samples.size() - next_);
  part.source = whole_.source;
  part.present = whole_.present;
  part.samples.assign(begin, begin + static_cast<std::ptrdiff_t>(ticks));
  part.parameters = changes_in(whole_.parameters, next_, ticks);
  next_ += ticks;
  return {};
}

}  // namespace attest
