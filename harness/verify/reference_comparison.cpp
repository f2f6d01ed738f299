#include "harness/verify/reference_comparison.hpp"

#include <memory>
#include <span>

#include <fmt/format.h>

#include "harness/loop/unit_driver.hpp"
#include "harness/port/builtin.hpp"

namespace attest {
namespace {

// The first decision that is nearer than its least margin, so that rounding can make it. Leaves out
// Decision::quaternion_norm, for which an estimator's quaternions are always safe.
std::optional<Decision> made_by_rounding(const Margins& margins, std::optional<int> fraction_bits) {
  for (std::size_t i = 0; i < decision_count; ++i) {
    const auto decision = static_cast<Decision>(i);
    if (decision == Decision::quaternion_norm) continue;
    if (margins[decision].distance < least_margin(decision, fraction_bits)) return decision;
  }
  return std::nullopt;
}

// Compares all ticks, and separately the ticks before the first decision by rounding.
class Answering {
 public:
  Answering(const Trace& flown, const Tolerances& tolerances)
      : comparer_(flown.present, flown.present, tolerances) {}

  void decided_by_rounding(Decision decision, std::size_t tick) {
    if (before_) return;
    before_ = comparer_.finish(tick, tick);
    near_ = {decision, tick, 0};
  }
  void add(const Sample& got, const Sample& want, std::span<const ParameterChange> changes) {
    comparer_.add(got, want, changes);
  }

  ReferenceComparison finish(std::size_t ticks) {
    ReferenceComparison answers{comparer_.finish(ticks, ticks), std::nullopt};
    Comparison& all = answers.comparison;
    if (!before_) return answers;
    if (all.agrees()) {
      all.tightest = before_->tightest;  // after the decision a correct port may deviate more
    } else if (before_->agrees() && all.first && !all.got_non_finite) {
      near_.deviating_tick = all.first->tick;
      answers.undecided = near_;
      all = *before_;
    }
    return answers;
  }

 private:
  TickComparer comparer_;
  std::optional<Comparison> before_;
  ReferenceComparison::Undecided near_{};
};

}  // namespace

Result<ReferenceComparison> compare_with_reference(const Trace& flown, const std::string& profile,
                                                   const Tolerances& tolerances,
                                                   std::optional<int> fraction_bits) {
  const std::unique_ptr<Port> reference = open_builtin();
  const Module module = module_of(flown.present);
  const std::unique_ptr<Unit> unit = reference->create_unit(module, profile, "");
  if (!unit) return fail(fmt::format("the reference has no profile `{}`", profile));
  UnitDriver law(*unit, module);
  const auto meter = margin_meter({profile, module});
  Answering answering(flown, tolerances);
  PendingChanges changes(flown.parameters);
  for (std::size_t tick = 0; tick < flown.samples.size(); ++tick) {
    const Sample& got = flown.samples[tick];
    const auto at_tick = changes.take_until(tick);
    const auto decision =
        meter ? made_by_rounding(meter->step(at_tick, got), fraction_bits) : std::nullopt;
    if (decision) answering.decided_by_rounding(*decision, tick);
    Sample want = got;
    if (const auto fault = law.step(tick, at_tick, want)) {
      return fail(fmt::format("the reference, at tick {}: {}", tick, fault->what));
    }
    answering.add(got, want, at_tick);
  }
  return answering.finish(flown.samples.size());
}

}  // namespace attest
