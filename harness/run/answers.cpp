#include "harness/run/answers.hpp"

#include <algorithm>
#include <memory>
#include <span>

#include "harness/port/builtin.hpp"
#include "harness/run/margins.hpp"
#include "harness/run/unit_driver.hpp"

namespace attest {
namespace {

// Not an attitude that all normalise alike, or a decision that rounding makes.
bool rounding_decides(const Margins& margins, int fraction_bits) {
  for (std::size_t i = 0; i < decision_count; ++i) {
    const auto decision = static_cast<Decision>(i);
    // Of an estimator the quaternion is as long as floats can make it.
    if (decision == Decision::quaternion_norm) continue;
    if (margins[decision].distance < least_margin(decision, fraction_bits)) return true;
  }
  return false;
}

}  // namespace

Comparison compare_answers(const Trace& flown, const std::string& profile,
                           const Tolerances& tolerances, std::optional<int> fraction_bits) {
  constexpr int bits_of_float = 32;  // so many that nothing is allowed for them
  const std::unique_ptr<Port> reference = open_builtin();
  const std::unique_ptr<Unit> unit = reference->create(profile);
  UnitDriver law(*unit);
  MarginMeter meter(profile);
  TickComparer comparer(flown.present, flown.present, tolerances);
  std::span<const ParameterChange> changes = flown.parameters;
  std::size_t tick = 0;
  for (; tick < flown.samples.size(); ++tick) {
    const Sample& got = flown.samples[tick];
    std::size_t now = 0;
    while (now < changes.size() && changes[now].tick == tick) ++now;
    const auto at_tick = changes.first(now);
    changes = changes.subspan(now);
    if (rounding_decides(meter.step(at_tick, got.in), fraction_bits.value_or(bits_of_float))) break;
    Sample want = got;
    if (law.step(tick, at_tick, want)) break;
    comparer.add(got, want, at_tick);
  }
  return comparer.finish(tick, tick);
}

}  // namespace attest
