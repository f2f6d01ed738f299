#include "harness/sweep/early_stop.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "harness/sweep/requirement.hpp"
#include "harness/sweep/sequential.hpp"

namespace attest {
namespace {

class EarlyStopTest : public testing::Test {
 protected:
  EarlyStopTest() {
    sweep_.requirements = {{"good", "settles", -1e9, 2, 0.9, 1}, {"calm", "peak", 0, 5, 0.5, 2}};
    sweep_.stop_when_decided = true;
  }
  // How many samples are flown; the sample i has these metrics.
  template <typename Metrics>
  int flown(Metrics&& metrics) const {
    EarlyStop early(sweep_, columns_);
    for (int i = 0; i < 1000; ++i) {
      if (early.is_decided()) return i;
      early.add({{}, {{outcome_done, {9, 9}}, {outcome_done, metrics(i)}}});
    }
    return 1000;
  }

  SweepFile sweep_;
  SampleColumns columns_{{}, {"settles", "peak"}, true};
};

TEST_F(EarlyStopTest, EndsWhenTheLastRequirementIsDecided) {
  const int both = flown([](int) { return std::vector<double>{1, 1}; });
  EXPECT_TRUE(
      excludes(static_cast<std::uint64_t>(both), static_cast<std::uint64_t>(both), 0.9, 0.95));
  EXPECT_FALSE(excludes(static_cast<std::uint64_t>(both) - 1, static_cast<std::uint64_t>(both) - 1,
                        0.9, 0.95));
  EXPECT_LT(flown([](int) { return std::vector<double>{3, 1}; }), both);  // soon not met
}

TEST_F(EarlyStopTest, FliesAllSamplesWhereOneIsNotDecided) {
  EXPECT_EQ(flown([](int i) { return std::vector<double>{1, i % 2 == 0 ? 1.0 : 9.0}; }), 1000);
}

TEST_F(EarlyStopTest, FliesAllSamplesWithoutTheKey) {
  sweep_.stop_when_decided = false;
  EXPECT_EQ(flown([](int) { return std::vector<double>{1, 1}; }), 1000);
}

TEST_F(EarlyStopTest, ALostFlightCountsAsNotHeld) {
  const int lost = flown([](int) { return std::vector<double>(2, std::nan("")); });
  EXPECT_EQ(lost, flown([](int) { return std::vector<double>{3, 9}; }));
}

TEST_F(EarlyStopTest, TheReportDecidesTheSame) {
  const int both = flown([](int) { return std::vector<double>{1, 1}; });
  PilotData data;
  for (const int count : {both - 1, both}) {
    data.metrics.assign(2, std::vector<double>(static_cast<std::size_t>(count), 1));
    const auto result = judge_requirement(sweep_.requirements[0], data, 0, sweep_, 0);
    EXPECT_EQ(result.decision,
              count == both ? RequirementDecision::met : RequirementDecision::undecided);
    EXPECT_EQ(result.probability.low >= 0.9, count == both);
  }
}

}  // namespace
}  // namespace attest
