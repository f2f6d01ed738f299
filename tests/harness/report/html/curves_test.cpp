#include <algorithm>
#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "harness/report/html/plot_data.hpp"
#include "harness/report/html/plots.hpp"

namespace attest {
namespace {

using testing::ElementsAre;

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

// A trace whose roll rates setpoints are these values.
Trace trace_of(const std::vector<float>& rolls) {
  Trace trace;
  trace.present = channels_of(Module::mc_att_control, "out/");
  for (const float roll : rolls) {
    trace.samples.emplace_back().out.vehicle_rates_setpoint.roll = roll;
  }
  return trace;
}

std::size_t roll() {
  return *find_channel(Module::mc_att_control, "out/vehicle_rates_setpoint.roll");
}

Curves roll_curves(const std::vector<float>& got, const std::vector<float>& want, float allowed) {
  const Trace allowed_trace = trace_of(std::vector<float>(want.size(), allowed));
  for (Curves& curves : curves_of(trace_of(got), trace_of(want), &allowed_trace)) {
    if (curves.channel == roll()) return curves;
  }
  return {};
}

TEST(Curves, CountTheTicksOutsideTheTolerance) {
  const Curves curves = roll_curves({0, 1.5f, 2, nan, 4.25f}, {0, 1, 2, 3, 4}, 0.25f);
  EXPECT_EQ(curves.deviating, 2u);
  EXPECT_EQ(curves.first_tick, 1u);
  EXPECT_EQ(roll_curves({nan, 0.0f}, {nan, -0.0f}, 0.25f).deviating, 0u);
  EXPECT_EQ(roll_curves({nan, 0.0f}, {nan, -0.0f}, 0).deviating, 1u);  // the level exact: bits
}

TEST(Curves, EndWhereTheOutputsOfThePortEnd) {
  EXPECT_EQ(roll_curves({0, 1}, {0, 1, 2}, 0).size(), 2u);
}

TEST(Curves, TheFirstDivergenceIsPlottedFirst) {
  const auto curves = [](std::size_t channel, std::size_t deviating, std::size_t tick) {
    Curves out;
    out.channel = channel;
    out.got = out.want = {0};
    out.deviating = deviating;
    out.first_tick = tick;
    return out;
  };
  std::vector<std::size_t> order;
  for (const Curves& one :
       curves_to_plot({curves(1, 0, 0), curves(2, 1, 9), curves(3, 0, 0), curves(4, 5, 3)}, 3, 9)) {
    order.push_back(one.channel);
  }
  EXPECT_THAT(order, ElementsAre(3, 4, 2));
  EXPECT_EQ(curves_to_plot({curves(2, 1, 9), curves(4, 5, 3)}, 2, 1).size(), 1u);
}

TEST(DrawnTicks, OfAShortTraceAreAllTicks) {
  EXPECT_THAT(drawn_ticks(roll_curves({1, 2, 3}, {1, 2, 3}, 0), 1, 3), ElementsAre(0, 1, 2));
}

// Floats of every kind, most of them equal.
rc::Gen<std::vector<float>> values(std::size_t size) {
  return rc::gen::container<std::vector<float>>(
      size, rc::gen::weightedOneOf<float>(
                {{8, rc::gen::just(0.0f)},
                 {2, rc::gen::map(rc::gen::inRange(-1000, 1000),
                                  [](int i) { return 0.1f * static_cast<float>(i); })},
                 {1, rc::gen::element(nan, std::numeric_limits<float>::infinity(),
                                      -std::numeric_limits<float>::infinity())}}));
}

// True if near `tick` a kept tick has a value as large and one has a value as small. A NaN needs a
// NaN.
template <typename Value>
bool is_visible(std::size_t tick, const std::vector<std::size_t>& kept, std::size_t width,
                Value value) {
  bool low = false, high = false, unknown = false;
  for (const std::size_t other : kept) {
    const bool is_near = other + width > tick && tick + width > other;
    if (!is_near) continue;
    low |= value(other) <= value(tick);
    high |= value(other) >= value(tick);
    unknown |= std::isnan(value(other));
  }
  return std::isnan(value(tick)) ? unknown : low && high;
}

RC_GTEST_PROP(DrawnTicks, HideNoSpike, ()) {
  constexpr std::size_t size = 400, most = 90;  // 10 parts of 40 ticks
  Curves curves;
  curves.got = *values(size);
  curves.want = *values(size);
  const auto marked = *rc::gen::inRange<std::size_t>(0, size);
  const auto kept = drawn_ticks(curves, marked, most);
  RC_ASSERT(std::is_sorted(kept.begin(), kept.end()));
  RC_ASSERT(std::adjacent_find(kept.begin(), kept.end()) == kept.end());
  RC_ASSERT(kept.size() <= most + 5);
  for (const std::size_t tick : {std::size_t{0}, marked, size - 1}) {
    RC_ASSERT(std::binary_search(kept.begin(), kept.end(), tick));
  }
  const auto difference = [&](std::size_t i) { return curves.got[i] - curves.want[i]; };
  for (std::size_t tick = 0; tick < size; ++tick) {
    RC_ASSERT(is_visible(tick, kept, 40, [&](std::size_t i) { return curves.got[i]; }));
    RC_ASSERT(is_visible(tick, kept, 40, [&](std::size_t i) { return curves.want[i]; }));
    RC_ASSERT(is_visible(tick, kept, 40, difference));
  }
}

}  // namespace
}  // namespace attest
