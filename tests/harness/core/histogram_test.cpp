#include "harness/core/histogram.hpp"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include "tests/harness/times.hpp"

namespace attest {
namespace {

TEST(Histogram, OfNothingIsZero) {
  const Histogram histogram;
  EXPECT_EQ(histogram.count(), 0u);
  EXPECT_EQ(histogram.min(), ns(0));
  EXPECT_EQ(histogram.max(), ns(0));
  EXPECT_EQ(histogram.mean(), ns(0));
  EXPECT_EQ(histogram.percentile(0.5), ns(0));
}

TEST(Histogram, KnowsExactlyWhatIsRare) {
  Histogram histogram(ns(1000));
  for (const std::int64_t time : {10, 1000, 1001, 3'000'000}) histogram.add(ns(time));
  EXPECT_EQ(histogram.min(), ns(10));
  EXPECT_EQ(histogram.max(), ns(3'000'000));
  EXPECT_EQ(histogram.over_limit(), 2u);
  EXPECT_EQ(histogram.mean(), ns(3'002'011 / 4));
}

TEST(Histogram, TakesSeveralEqualTimesAtOnce) {
  Histogram histogram(ns(5));
  histogram.add(ns(10), 3);
  histogram.add(ns(2), 0);
  histogram.add(ns(4));
  EXPECT_EQ(histogram.count(), 4u);
  EXPECT_EQ(histogram.over_limit(), 3u);
  EXPECT_EQ(histogram.mean(), ns(34 / 4));
  EXPECT_EQ(histogram.min(), ns(2));
  EXPECT_EQ(histogram.percentile(0.25), ns(4));
  EXPECT_EQ(histogram.percentile(0.5), ns(10));
}

TEST(Histogram, TakesWhatIsBeyondItsBins) {
  Histogram histogram;
  histogram.add(ns(-5));  // of a clock that is read on two CPUs
  histogram.add(std::chrono::hours(1));
  EXPECT_EQ(histogram.min(), ns(-5));
  EXPECT_EQ(histogram.max(), Nanoseconds(std::chrono::hours(1)));
  EXPECT_EQ(histogram.percentile(1), Nanoseconds(std::chrono::hours(1)));
}

// Compared with the sorted values.
RC_GTEST_PROP(Histogram, PercentilesAreRightToABin, (std::vector<std::uint32_t> values)) {
  RC_PRE(!values.empty());
  const double part = *rc::gen::inRange(0, 1001) / 1000.0;
  Histogram histogram;
  for (const std::uint32_t value : values) histogram.add(ns(value));
  std::sort(values.begin(), values.end());
  const auto rank = static_cast<std::size_t>(std::ceil(part * static_cast<double>(values.size())));
  const double exact = values[rank == 0 ? 0 : rank - 1];
  const auto found = static_cast<double>(histogram.percentile(part).count());
  RC_ASSERT(found >= exact - 1);
  RC_ASSERT(found <= exact * 1.0101 + 1);
}

TEST(Histogram, APercentileNeedsTenSamplesBeyondIt) {
  const std::vector<std::pair<double, std::uint64_t>> least = {
      {0.5, 20}, {0.9, 100}, {0.99, 1000}, {0.999, 10'000}};
  for (const auto& [part, count] : least) {
    EXPECT_TRUE(supports_percentile(count, part)) << part;
    EXPECT_FALSE(supports_percentile(count - 1, part)) << part;
  }
}

RC_GTEST_PROP(Histogram, EveryTimeIsInOneBucket, (std::vector<std::uint32_t> values)) {
  Histogram histogram;
  for (const std::uint32_t value : values) histogram.add(ns(value));
  std::uint64_t count = 0;
  Nanoseconds last{0};
  for (const auto& [from, to, times] : histogram.buckets()) {
    RC_ASSERT(last <= from);
    RC_ASSERT(from < to);
    const auto inside = [from = from, to = to](std::uint32_t v) {
      return from <= ns(v) && ns(v) < to;
    };
    RC_ASSERT(static_cast<std::uint64_t>(std::count_if(values.begin(), values.end(), inside)) ==
              times);
    last = to;
    count += times;
  }
  RC_ASSERT(count == values.size());
}

TEST(Histogram, BucketsHoldWhatIsBeyondTheBins) {
  Histogram histogram;
  EXPECT_TRUE(histogram.buckets().empty());
  histogram.add(ns(-5));
  histogram.add(std::chrono::hours(1));
  const auto buckets = histogram.buckets();
  ASSERT_EQ(buckets.size(), 2u);
  EXPECT_EQ(buckets[0].from, ns(-5));
  EXPECT_EQ(buckets[1].to, Nanoseconds(std::chrono::hours(1)) + ns(1));
}

}  // namespace
}  // namespace attest
