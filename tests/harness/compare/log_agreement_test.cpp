// Which deviations from a flight log count as agreement, and which are explained.
#include "harness/compare/log_agreement.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

namespace attest {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

// Rates setpoints at successive ticks; a missing one is not published.
using Rolls = std::vector<std::optional<float>>;

Trace trace_of(const Rolls& rolls) {
  Trace trace;
  trace.present = channels_of(Module::mc_att_control, "out/vehicle_rates_setpoint.");
  for (const auto& value : rolls) {
    Sample sample{};
    sample.out.vehicle_rates_setpoint.roll = value.value_or(0.0f);
    sample.out.vehicle_rates_setpoint.published = value ? 1 : 0;
    trace.samples.push_back(sample);
  }
  return trace;
}

Trace part_of(const Trace& whole, std::size_t first, std::size_t ticks) {
  Trace part = whole;
  const auto begin = whole.samples.begin() + static_cast<std::ptrdiff_t>(first);
  part.samples.assign(begin, begin + static_cast<std::ptrdiff_t>(ticks));
  return part;
}

// In parts of that many ticks.
std::vector<TopicAgreement> agreement_with_log(const Trace& got, const Trace& logged,
                                               const Trace& reference, const LogLimits& limits,
                                               const std::vector<bool>& leaves_out = {},
                                               std::size_t most = 1000) {
  LogAgreement agreement(logged.present, limits);
  const std::size_t all = logged.samples.size();
  for (std::size_t first = 0; first < all; first += most) {
    const std::size_t ticks = std::min(most, all - first);
    std::vector<bool> of_part;
    for (std::size_t i = first; i < first + ticks && i < leaves_out.size(); ++i) {
      of_part.push_back(leaves_out[i]);
    }
    agreement.add(part_of(got, first, ticks), part_of(logged, first, ticks),
                  part_of(reference, first, ticks), of_part);
  }
  return agreement.finish();
}

TopicAgreement agreement(const Rolls& got, const Rolls& logged, const LogLimits& limits = {},
                         const Rolls& reference = {}) {
  return agreement_with_log(trace_of(got), trace_of(logged),
                            trace_of(reference.empty() ? got : reference), limits)
      .at(0);
}

TEST(LogAgreement, CountsWhatIsWithin) {
  const TopicAgreement found = agreement({1.0f, 2.0f, 3.0f}, {1.0f, 2.00005f, 3.0f});
  EXPECT_EQ(found.topic, "vehicle_rates_setpoint");
  EXPECT_EQ(found.paired, 3u);
  EXPECT_EQ(found.within, 3u);
  EXPECT_EQ(found.median, 0);
  EXPECT_NEAR(found.largest, 5e-5, 1e-6);
  EXPECT_TRUE(found.agrees({}));
}

TEST(LogAgreement, ComparesOnlyWhatTheLogHas) {
  const TopicAgreement found = agreement({1.0f, 9.0f, 3.0f}, {1.0f, std::nullopt, 3.0f});
  EXPECT_EQ(found.paired, 2u);
  EXPECT_EQ(found.within, 2u);
}

TEST(LogAgreement, AValueBetweenNeighboursAnswersASampleBetweenThem) {
  const TopicAgreement found = agreement({1.0f, 2.0f, 3.0f}, {1.0f, 2.5f, 3.0f});
  EXPECT_EQ(found.between_samples, 1u);
  EXPECT_EQ(found.unexplained(), 0u);
}

TEST(LogAgreement, AValueBeyondTheNeighboursIsNotExplained) {
  const TopicAgreement found = agreement({1.0f, 2.0f, 3.0f, 4.0f}, {1.0f, 3.5f, 3.0f, 4.0f});
  EXPECT_EQ(found.unexplained(), 1u);
  ASSERT_TRUE(found.first_unexplained);
  EXPECT_EQ(found.first_unexplained->tick, 1u);
  EXPECT_EQ(found.first_unexplained->logged, 3.5);
  EXPECT_FALSE(found.agrees({}));
}

// A ramp of 100 ticks, of whose last 20 the log has the answers to later samples.
Rolls ramp(float added) {
  Rolls rolls;
  for (int i = 0; i < 100; ++i) rolls.push_back(static_cast<float>(i) + (i < 80 ? 0.0f : added));
  return rolls;
}

TEST(LogAgreement, AnExcursionOfThePortExplainsNothing) {
  const LogLimits lenient{1e-4, 0.5};
  EXPECT_TRUE(agreement(ramp(0), ramp(0.5f), lenient).agrees(lenient));
  for (const float wild : {100.0f, -100.0f}) {
    Rolls got = ramp(0);
    for (std::size_t i = 0; i < got.size(); i += 25) got[i] = wild;
    const TopicAgreement found = agreement(got, ramp(0.5f), lenient, ramp(0));
    EXPECT_EQ(found.unexplained(), 5u);  // with the last tick, which has no later sample
    EXPECT_FALSE(found.agrees(lenient));
  }
  // Next to an excursion of the port, a wrong value stays wrong.
  const Rolls zeros(4, 0.0f);
  const TopicAgreement next = agreement({0.0f, 100.0f, 9.0f, -100.0f}, zeros, {}, zeros);
  EXPECT_EQ(next.unexplained(), 3u);
}

TEST(LogAgreement, OneGrossDeviationIsAMistakeWhereTheReferenceAgrees) {
  Rolls got = ramp(0), reference = ramp(0);
  got[50] = *got[50] + 0.002f;
  TopicAgreement found = agreement(got, ramp(0), {}, reference);
  EXPECT_EQ(found.mistakes, 1u);
  EXPECT_FALSE(found.agrees({}));
  got[50] = std::nullopt;  // not published
  EXPECT_EQ(agreement(got, ramp(0), {}, reference).mistakes, 1u);
  got[50] = *ramp(0)[50] + 0.0005f;
  found = agreement(got, ramp(0), {}, reference);
  EXPECT_EQ(found.mistakes, 0u);
  EXPECT_TRUE(found.agrees({}));
  got[50] = *ramp(0)[50] + 0.002f;
  reference[50] = *ramp(0)[50] + 0.001f;  // the log lacks an input of this tick
  EXPECT_EQ(agreement(got, ramp(0), {}, reference).mistakes, 0u);
}

TEST(LogAgreement, ANumberIsNeverAnsweredByNanOrInfinity) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  for (const float wrong : {nan, infinity, -infinity}) {
    Rolls got = ramp(0);
    got[50] = wrong;
    const TopicAgreement found = agreement(got, ramp(0), {}, ramp(0));
    EXPECT_EQ(found.non_finite, 1u);
    // Only if the reference has a number, too.
    EXPECT_EQ(agreement(got, ramp(0), {}, got).non_finite, 0u);
    EXPECT_EQ(found.unexplained(), 1u);
    EXPECT_EQ(found.first_unexplained->tick, 50u);
    EXPECT_FALSE(found.agrees({}));  // 1% of wrong numbers would be allowed
  }
  // Infinities of the reference widen nothing.
  const Rolls reference{infinity, 1.0f, -infinity};
  EXPECT_EQ(agreement({infinity, 5.0f, 1.0f}, {infinity, 1.0f, 1.0f}, {}, reference).within, 2u);
  EXPECT_EQ(agreement({infinity, 5.0f, 1.0f}, {infinity, 1.0f, 1.0f}, {}, reference).unexplained(),
            1u);
}

TEST(LogAgreement, ATickThatIsLeftOutMustStillHaveNumbers) {
  const Rolls logged{1.0f, 2.0f, 3.0f};
  const auto found = [&](const Rolls& got, const Rolls& reference) {
    return agreement_with_log(trace_of(got), trace_of(logged), trace_of(reference), {},
                              {false, true, false})
        .at(0);
  };
  EXPECT_EQ(found({1.0f, 9.0f, 3.0f}, logged).left_out, 1u);
  EXPECT_EQ(found({1.0f, 9.0f, 3.0f}, logged).paired, 2u);
  EXPECT_TRUE(found({1.0f, 9.0f, 3.0f}, logged).agrees({}));
  EXPECT_FALSE(found({1.0f, nan, 3.0f}, logged).agrees({}));
  // The reference has no number either, for what the log has of the inputs.
  EXPECT_TRUE(found({1.0f, nan, 3.0f}, {1.0f, nan, 3.0f}).agrees({}));
}

// Each of these has a tick between the reference's values at its neighbours, which may be in
// another part.
TEST(LogAgreement, PartsOfAnySizeAgreeAsTheWhole) {
  Rolls got, logged, reference;
  std::vector<bool> leaves_out;
  for (int i = 0; i < 40; ++i) {
    const float value = std::sin(0.7f * static_cast<float>(i));
    reference.push_back(value);
    got.push_back(i % 5 == 0 ? value + 0.2f : value);
    logged.push_back(i % 3 == 0 ? value - 0.2f : value);
    if (i % 11 == 0) logged.back().reset();
    if (i % 13 == 0) got.back() = nan;
    leaves_out.push_back(i % 7 == 0);
  }
  const auto in_parts_of = [&](std::size_t most) {
    return agreement_with_log(trace_of(got), trace_of(logged), trace_of(reference), {}, leaves_out,
                              most)
        .at(0);
  };
  const TopicAgreement whole = in_parts_of(1000);
  EXPECT_GT(whole.between_samples, 0u);
  EXPECT_GT(whole.unexplained(), 0u);
  for (const std::size_t most : {1U, 2U, 7U, 40U}) {
    const TopicAgreement parts = in_parts_of(most);
    EXPECT_EQ(parts.left_out, whole.left_out);
    EXPECT_EQ(parts.paired, whole.paired);
    EXPECT_EQ(parts.non_finite, whole.non_finite);
    EXPECT_EQ(parts.within, whole.within);
    EXPECT_EQ(parts.between_samples, whole.between_samples) << "parts of " << most;
    EXPECT_EQ(parts.p90, whole.p90);
    EXPECT_EQ(parts.first_unexplained->tick, whole.first_unexplained->tick);
  }
}

TEST(LogAgreement, AWrongSignIsNotExplained) {
  Rolls got, logged;
  for (int i = 0; i < 100; ++i) {
    logged.push_back(std::sin(0.1f * static_cast<float>(i)));
    got.push_back(-*logged.back());
  }
  const TopicAgreement found = agreement(got, logged);
  EXPECT_GT(found.part_unexplained(), 0.9);
  EXPECT_FALSE(found.agrees({}));
}

TEST(LogAgreement, WhatThePortDoesNotPublishIsMissing) {
  const TopicAgreement found = agreement({1.0f, std::nullopt}, {1.0f, 2.0f});
  EXPECT_EQ(found.missing, 1u);
  EXPECT_EQ(found.unexplained(), 1u);
}

TEST(LogAgreement, NanAgreesWithNanOnly) {
  EXPECT_EQ(agreement({nan}, {nan}).within, 1u);
  EXPECT_EQ(agreement({nan}, {1.0f}).unexplained(), 1u);
  EXPECT_EQ(agreement({1.0f}, {nan}).unexplained(), 1u);
}

TEST(LogAgreement, BothLimitsDecide) {
  // Of 100 pairs 14 are between samples, so 86 are within.
  Rolls got, logged;
  for (int i = 0; i < 100; ++i) {
    got.push_back(static_cast<float>(i));
    logged.push_back(*got.back() + (i > 0 && i <= 14 ? 0.5f : 0.0f));
  }
  EXPECT_TRUE(agreement(got, logged).agrees({}));
  EXPECT_FALSE(agreement(got, logged).agrees({1e-4, 0.87}));
  for (const int i : {50, 60}) logged[static_cast<std::size_t>(i)] = -5.0f;
  EXPECT_FALSE(agreement(got, logged).agrees({}));  // 84 are within
  EXPECT_TRUE(agreement(got, logged).agrees({1e-4, 0.8}));
  logged[70] = -5.0f;
  EXPECT_FALSE(agreement(got, logged).agrees({1e-4, 0.8}));  // 3 without explanation
}

TEST(LogAgreement, QuantilesAreOfTheNearestRank) {
  Rolls got, logged;
  for (int i = 1; i <= 100; ++i) {
    got.push_back(0.0f);
    logged.push_back(static_cast<float>(i));
  }
  const TopicAgreement found = agreement(got, logged);
  EXPECT_EQ(found.median, 50);
  EXPECT_EQ(found.p90, 90);
  EXPECT_EQ(found.p99, 99);
  EXPECT_EQ(found.largest, 100);
}

TEST(LogAgreement, QuantilesOfManyDeviationsAreRoundedUp) {
  constexpr std::size_t ticks = 200'000, in_part = 1000;
  LogAgreement agreement(trace_of({}).present, {});
  for (std::size_t first = 0; first < ticks; first += in_part) {
    Rolls got;
    for (std::size_t i = 1; i <= in_part; ++i)
      got.emplace_back(1e-5f * static_cast<float>(first + i));
    agreement.add(trace_of(got), trace_of(Rolls(in_part, 0.0f)), trace_of(got));
  }
  const TopicAgreement found = agreement.finish().front();
  const auto is_near = [](double value, double exact) {
    return value >= exact && value < 1.001 * exact;
  };
  EXPECT_PRED2(is_near, found.median, static_cast<double>(1e-5f * 1e5f));
  EXPECT_PRED2(is_near, found.p90, static_cast<double>(1e-5f * 1.8e5f));
  EXPECT_PRED2(is_near, found.p99, static_cast<double>(1e-5f * 1.98e5f));
  EXPECT_EQ(found.largest, static_cast<double>(1e-5f * 2e5f));
  EXPECT_EQ(found.within, 10u);
}

}  // namespace
}  // namespace attest
