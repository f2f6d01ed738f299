#include "harness/run/open_loop.hpp"

#include <span>

namespace attest {

std::optional<PortFault> drive(Unit& unit, Trace& trace) {
  UnitDriver driver(unit);
  std::span<const ParameterChange> changes = trace.parameters;
  for (std::size_t tick = 0; tick < trace.samples.size(); ++tick) {
    std::size_t now = 0;
    while (now < changes.size() && changes[now].tick == tick) ++now;
    if (auto fault = driver.step(tick, changes.first(now), trace.samples[tick])) return fault;
    changes = changes.subspan(now);
  }
  return std::nullopt;
}

}  // namespace attest
