#include <cmath>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include "harness/compare/compare.hpp"
#include "tests/harness/compare/sample_trace.hpp"

namespace attest {
namespace {

constexpr std::size_t trace_ticks = 8;

// Any bits in any output, NaN and infinities included.
Trace any_trace() {
  Trace trace = sample_trace(trace_ticks);
  for (Sample& sample : trace.samples) {
    for (const Channel& what : channels()) {
      if (!what.is_output()) continue;
      if (what.type == ChannelType::f32) {
        set_value(what, sample, *rc::gen::arbitrary<double>());
      } else {
        set_value(what, sample, *rc::gen::inRange(0, 256));
      }
    }
  }
  return trace;
}

struct Place {
  std::size_t tick, channel;
};

Place any_float_output() {
  std::vector<std::size_t> outputs;
  for (std::size_t i = 0; i < channels().size(); ++i) {
    const Channel& what = channels()[i];
    if (what.module != Module::mc_att_control) continue;
    if (what.is_output() && what.type == ChannelType::f32) outputs.push_back(i);
  }
  return {*rc::gen::inRange<std::size_t>(0, trace_ticks), *rc::gen::elementOf(outputs)};
}

// `want` with one value moved by `amount` times its tolerance.
Trace moved(const Trace& want, const Place& place, double amount, const Tolerances& tolerances) {
  const Channel& what = channels()[place.channel];
  Trace got = want;
  const double value = value_of(what, want.samples[place.tick]);
  const Tolerance tolerance = tolerances.of(place.channel);
  const double allowed = std::max(tolerance.absolute, tolerance.relative * std::abs(value));
  set_value(what, got.samples[place.tick], value + amount * allowed);
  return got;
}

RC_GTEST_PROP(Compare, ATraceAgreesWithItself, ()) {
  const Trace trace = any_trace();
  for (const Level level : {Level::exact, Level::numeric}) {
    const Comparison comparison = compare(trace, trace, Tolerances(level));
    RC_ASSERT(comparison.agrees());
    RC_ASSERT(comparison.ticks == trace_ticks);
    RC_ASSERT(comparison.deviating_ticks == 0u);
  }
}

RC_GTEST_PROP(Compare, OneValueBeyondItsToleranceIsFoundWhereItIs, (bool up)) {
  const Trace want = sample_trace(trace_ticks);
  const Place place = any_float_output();
  const Comparison comparison =
      compare(moved(want, place, up ? 1.1 : -1.1, Tolerances()), want, Tolerances());
  RC_ASSERT(comparison.first.has_value());
  RC_ASSERT(comparison.first->tick == place.tick);
  RC_ASSERT(comparison.first->channel == place.channel);
  RC_ASSERT(comparison.deviating_ticks == 1u);
}

RC_GTEST_PROP(Compare, OneValueWithinItsToleranceAgreesAndIsTheTightest, (bool up)) {
  const Trace want = sample_trace(trace_ticks);
  const Place place = any_float_output();
  const Comparison comparison =
      compare(moved(want, place, up ? 0.9 : -0.9, Tolerances()), want, Tolerances());
  RC_ASSERT(comparison.agrees());
  RC_ASSERT(comparison.tightest.has_value());
  RC_ASSERT(comparison.tightest->channel == place.channel);
  RC_ASSERT(comparison.tightest->tick == place.tick);
  RC_ASSERT(comparison.tightest->ratio > 1);
}

RC_GTEST_PROP(Compare, OfTwoDeviationsTheEarlierIsReported, ()) {
  const Trace want = sample_trace(trace_ticks);
  const Place a = any_float_output(), b = any_float_output();
  const Trace got = moved(moved(want, a, 50, Tolerances()), b, 50, Tolerances());
  const auto order = [](const Place& place) {
    return std::tuple(place.tick, channels()[place.channel].stage, place.channel);
  };
  const Place first = order(a) < order(b) ? a : b;
  const Comparison comparison = compare(got, want, Tolerances());
  RC_ASSERT(comparison.first.has_value());
  RC_ASSERT(comparison.first->tick == first.tick);
  RC_ASSERT(comparison.first->channel == first.channel);
}

RC_GTEST_PROP(Compare, WhatIsExactIsNumeric, ()) {
  const Trace a = any_trace(), b = any_trace();
  if (compare(a, b, Tolerances(Level::exact)).agrees()) {
    RC_ASSERT(compare(a, b, Tolerances()).agrees());
  }
  // The bits decide, so got and golden can be exchanged.
  RC_ASSERT(compare(a, b, Tolerances(Level::exact)).deviating_ticks ==
            compare(b, a, Tolerances(Level::exact)).deviating_ticks);
}

}  // namespace
}  // namespace attest
