#include "harness/sweep/summary.hpp"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace attest {
namespace {

using testing::ElementsAre;

const double nan = std::nan("");

class SummaryTest : public testing::Test {
 protected:
  SummaryTest() {
    sweep_.design = {DesignKind::monte_carlo, 400, 1, {}, {}};
    sweep_.requirements = {{"settles", "settles", -1e9, 2, 0.9, 1}};
    data_ = no_samples();
  }
  static SampleData no_samples() {
    SampleData data;
    data.drawn.resize(1);
    data.pilots.resize(1);
    data.pilots[0].metrics.resize(1);
    return data;
  }
  void add(double drawn, double value) {
    data_.drawn[0].push_back(drawn);
    data_.pilots[0].outcomes.emplace_back(std::isnan(value) ? outcome_diverged : outcome_done);
    data_.pilots[0].metrics[0].push_back(value);
  }
  // The port's metric is that of the reference times `factor(i)`.
  template <typename Factor>
  void add_port(Factor&& factor) {
    columns_.with_port = true;
    PilotData port = data_.pilots[0];
    for (std::size_t i = 0; i < port.outcomes.size(); ++i) port.metrics[0][i] *= factor(i);
    data_.pilots.push_back(port);
  }
  SweepSummary summary() const { return summarise(sweep_, columns_, data_, 3); }

  SweepFile sweep_;
  SampleColumns columns_{{"mass"}, {"settles"}, false};
  SampleData data_;
};

TEST_F(SummaryTest, ARequirementIsMetWhenItsIntervalIsAboveTheNeededProbability) {
  for (int i = 0; i < 400; ++i) add(i, i < 380 ? 1 : 3);  // 95%, and 0.9 is needed
  EXPECT_EQ(summary().requirements[0].held, 380u);
  EXPECT_EQ(summary().requirements[0].decision, RequirementDecision::met);
  EXPECT_TRUE(summary().passes());
  sweep_.requirements[0].probability = 0.95;
  EXPECT_EQ(summary().requirements[0].decision, RequirementDecision::undecided);
  EXPECT_FALSE(summary().passes());
  sweep_.requirements[0].probability = 0.99;
  EXPECT_EQ(summary().requirements[0].decision, RequirementDecision::not_met);
}

TEST_F(SummaryTest, AnEarlyStopHasSequentialIntervalsAndTests) {
  for (int i = 0; i < 400; ++i) add(i, i < 380 ? 1 : 3);
  add_port([](std::size_t i) { return i < 390 ? 1.01 : 1; });
  const SweepSummary fixed = summary();
  sweep_.stop_when_decided = true;
  sweep_.design.samples = 1000;
  const SweepSummary sequential = summary();
  EXPECT_EQ(sequential.planned, 1000u);
  EXPECT_LT(sequential.requirements[0].probability.low, fixed.requirements[0].probability.low);
  EXPECT_EQ(sequential.requirements[0].decision, RequirementDecision::met);
  EXPECT_GT(sequential.port->metrics[0].p_value, fixed.port->metrics[0].p_value);
}

// The other samples of a block share their numbers.
TEST_F(SummaryTest, OfABlockTwoSamplesAreJudged) {
  sweep_.design = {DesignKind::saltelli, 300, 1, {}, {}};
  sweep_.dispersions.resize(1);
  for (int i = 0; i < 300; ++i) add(i, i % 3 == 2 ? 9 : 1 + 1e-3 * i);
  add_port([](std::size_t i) { return i % 3 == 2 ? 2 : 1; });
  const SweepSummary found = summary();
  EXPECT_EQ(found.requirements[0].held, 200u);
  EXPECT_EQ(found.requirements[0].count, 200u);
  EXPECT_EQ(found.requirements[0].worst.front(), 2u);
  EXPECT_EQ(found.port->metrics[0].count, 200u);
  EXPECT_EQ(found.port->metrics[0].above, 0u);
  EXPECT_EQ(found.metrics[0].sobol->blocks, 100u);
  sweep_.design.kind = DesignKind::monte_carlo;
  EXPECT_FALSE(summary().metrics[0].sobol);
}

TEST_F(SummaryTest, AGridIsJudgedByItsPart) {
  sweep_.design.kind = DesignKind::grid;
  for (int i = 0; i < 20; ++i) add(i, i < 18 ? 1 : 3);
  EXPECT_EQ(summary().requirements[0].decision, RequirementDecision::met);
}

TEST_F(SummaryTest, ALostFlightHoldsNothingAndIsTheWorst) {
  for (int i = 0; i < 100; ++i) add(i, i == 40 ? nan : i == 50 ? 9 : i == 60 ? 8 : 1);
  EXPECT_EQ(summary().requirements[0].held, 97u);
  EXPECT_THAT(summary().requirements[0].worst, ElementsAre(40, 50, 60));
  EXPECT_EQ(summary().outcomes.at(outcome_diverged), 1u);
  EXPECT_EQ(summary().metrics[0].count, 99u);
}

TEST_F(SummaryTest, AMetricHasItsDistributionAndSensitivity) {
  for (int i = 1; i <= 400; ++i) add(i, 0.001 * i);
  const MetricSummary metric = summary().metrics[0];
  EXPECT_EQ(metric.min, 0.001);
  EXPECT_EQ(metric.median, 0.2);
  EXPECT_EQ(metric.p95, 0.38);
  EXPECT_EQ(metric.p99, std::nullopt);  // four flights are beyond it
  EXPECT_EQ(metric.max, 0.4);
  EXPECT_NEAR(metric.correlation[0], 1, 1e-12);
}

TEST_F(SummaryTest, AnEqualPortDoesNotDiffer) {
  for (int i = 0; i < 100; ++i) add(i, 1 + 0.001 * i);
  add_port([](std::size_t) { return 1 + 1e-6; });  // another order of arithmetic
  const SweepSummary result = summary();
  EXPECT_EQ(result.port->metrics[0].above, 0u);
  EXPECT_FALSE(result.port->differs());
  EXPECT_TRUE(result.passes());
}

TEST_F(SummaryTest, FewSamplesAreNoComparison) {
  // Two tests at 0.025 each: 2 / 2^6 is above, 2 / 2^7 is below.
  sweep_.requirements.clear();
  for (const int samples : {6, 7}) {
    data_ = no_samples();
    for (int i = 0; i < samples; ++i) add(i, 1);
    add_port([](std::size_t) { return 1.0; });
    const SweepSummary equal = summary();
    EXPECT_EQ(equal.port->pairs_needed, 7u);
    EXPECT_EQ(equal.passes(), samples == 7);
    data_.pilots.pop_back();
    add_port([](std::size_t) { return 2.0; });
    EXPECT_EQ(summary().port->differs(), samples == 7);
    EXPECT_FALSE(summary().passes());
  }
}

TEST_F(SummaryTest, ASmallSystematicDifferenceIsFound) {
  for (int i = 0; i < 100; ++i) add(i, 1 + 0.01 * (i % 50));
  add_port([](std::size_t i) { return i % 5 == 0 ? 0.999 : 1.003; });
  const SweepSummary result = summary();
  EXPECT_EQ(result.port->metrics[0].above, 80u);
  EXPECT_TRUE(result.port->metrics[0].differs);
  EXPECT_FALSE(result.passes());
}

TEST_F(SummaryTest, DifferencesOfBothSignsAreNoShift) {
  for (int i = 0; i < 100; ++i) add(i, 1);
  add_port([](std::size_t i) { return i % 2 == 0 ? 0.99 : 1.01; });
  EXPECT_FALSE(summary().port->differs());
}

TEST_F(SummaryTest, APortThatLosesMoreFlightsDiffers) {
  for (int i = 0; i < 100; ++i) add(i, 1);
  add_port([](std::size_t) { return 1.0; });
  for (std::size_t i = 0; i < 10; ++i) {
    data_.pilots[1].outcomes[i] = outcome_diverged;
    data_.pilots[1].metrics[0][i] = nan;
  }
  EXPECT_EQ(summary().port->lost_by_port, 10u);
  EXPECT_TRUE(summary().port->losses_differ);
}

TEST_F(SummaryTest, AFaultOfThePortFails) {
  for (int i = 0; i < 400; ++i) add(i, 1);
  add_port([](std::size_t) { return 1.0; });
  data_.pilots[1].outcomes[5] = "crash";
  data_.pilots[1].metrics[0][5] = nan;
  EXPECT_EQ(summary().requirements[0].decision, RequirementDecision::met);
  EXPECT_FALSE(summary().passes());
}

}  // namespace
}  // namespace attest
