#include "harness/verify/reference_comparison.hpp"

#include <span>

#include "harness/golden/reference.hpp"

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
  const ModuleUnderTest subject{profile, module_of(flown.present)};
  const bool is_exact = tolerances.level() == Level::exact;
  const auto meter = is_exact ? nullptr : margin_meter(subject);
  Answering answering(flown, tolerances);
  const auto compared = for_each_reference_output(
      subject, flown,
      [&](std::size_t tick, std::span<const ParameterChange> changes, const Sample& got,
          const Sample& want) {
        const auto decision =
            meter ? made_by_rounding(meter->step(changes, got), fraction_bits) : std::nullopt;
        if (decision) answering.decided_by_rounding(*decision, tick);
        answering.add(got, want, changes);
      });
  if (!compared) return tl::unexpected(compared.error());
  return answering.finish(flown.samples.size());
}

std::optional<NearDecision> first_near_decision(const ModuleUnderTest& subject, const Trace& given,
                                                std::optional<int> fraction_bits,
                                                std::size_t last_tick) {
  const auto meter = margin_meter(subject);
  if (!meter) return std::nullopt;
  PendingChanges changes(given.parameters);
  for (std::size_t tick = 0; tick <= last_tick && tick < given.samples.size(); ++tick) {
    const Margins& margins = meter->step(changes.take_until(tick), given.samples[tick]);
    if (const auto decision = made_by_rounding(margins, fraction_bits)) {
      return NearDecision{*decision, tick};
    }
  }
  return std::nullopt;
}

Result<Comparison> compare_with_reference(const Flown& flown, const std::string& profile,
                                          const Tolerances& tolerances,
                                          std::optional<int> fraction_bits) {
  auto answers = compare_with_reference(flown.trace, profile, tolerances, fraction_bits);
  if (!answers) return tl::unexpected(answers.error());
  if (!flown.attitude_trace || flown.attitude_trace->samples.empty()) return answers->comparison;
  const auto attitude =
      compare_with_reference(*flown.attitude_trace, profile, tolerances, fraction_bits);
  if (!attitude) return tl::unexpected(attitude.error());
  return both(answers->comparison, attitude->comparison);
}

}  // namespace attest
