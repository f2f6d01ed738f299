// When a log has every step of a unit, and when it is too sparse.
#include "harness/ulog/step_gaps.hpp"

#include <vector>

#include <gmock/gmock.h>

namespace attest {
namespace {

using testing::HasSubstr;

std::vector<std::uint64_t> times(std::size_t count, std::uint64_t period_us) {
  std::vector<std::uint64_t> all;
  for (std::size_t i = 0; i < count; ++i) all.push_back(1000 + period_us * i);
  return all;
}

StepGaps step_gaps(const std::vector<std::uint64_t>& times_us) {
  GapCounts times;
  for (const std::uint64_t time : times_us) times.add(time);
  return times.gaps();
}

TEST(StepGaps, CountsWhatIsMissing) {
  auto all = times(1000, 1000);
  all.erase(all.begin() + 500, all.begin() + 503);
  const StepGaps gaps = step_gaps(all);
  EXPECT_EQ(gaps.median_us, 1000);
  EXPECT_EQ(gaps.missing, 3u);
  EXPECT_EQ(gaps.longest_us, 4000u);
  EXPECT_EQ(too_sparse(Module::rate_unit, gaps, {}), "");
  EXPECT_FALSE(may_be_complete(Module::rate_unit, gaps, 1000));
  all.erase(all.begin() + 100, all.begin() + 120);
  EXPECT_THAT(too_sparse(Module::rate_unit, step_gaps(all), {}),
              HasSubstr("the log lacks about 2.3% of the gyro samples: usually they are 1 ms "
                        "apart, at most 21 ms"));
}

// A loop of 1.5 ms that may run at 800 Hz, of which a log has about one step in 14.
TEST(StepGaps, ThePeriodOfTheLoopDividesTheGaps) {
  GapCounts times;
  std::uint64_t time = 1000;
  for (std::size_t i = 0; i < 200; ++i) {
    times.add(time + i % 3);  // a timestamp may be late by 2 us
    time += (i % 7 == 0 ? 12 : 14) * 1500;
  }
  EXPECT_NEAR(times.gaps(800).period_us, 1500, 5);
  EXPECT_EQ(times.gaps().period_us, 0);
}

TEST(StepGaps, ALogSlowerThanAnyLoopIsTooSparse) {
  EXPECT_EQ(too_sparse(Module::rate_unit, step_gaps(times(100, 20000)), {}),
            "the log has a gyro sample every 20 ms, and the loop runs at 100 Hz or more; the "
            "integral and the yaw filter depend on every step");
  EXPECT_THAT(too_sparse(Module::rate_unit, step_gaps(times(100, 20000)), 800),
              HasSubstr("the loop runs at up to 800 Hz (IMU_GYRO_RATEMAX)"));
  EXPECT_EQ(too_sparse(Module::attitude_unit, step_gaps(times(100, 20000)), {}), "");
  EXPECT_THAT(too_sparse(Module::attitude_unit, step_gaps(times(100, 50000)), {}),
              HasSubstr("the log has a sample of the attitude every 50 ms"));
  EXPECT_THAT(too_sparse(Module::rate_unit, step_gaps(times(1, 1)), {}),
              testing::StartsWith("the log has 1 gyro sample"));
  EXPECT_EQ(too_sparse(Module::rate_unit, step_gaps(times(0, 1)), {}),
            "the log has 0 gyro samples");
}

TEST(StepGaps, ARateUnitIsCompleteOnlyAtItsOwnRate) {
  const StepGaps gaps = step_gaps(times(100, 2500));
  EXPECT_TRUE(may_be_complete(Module::rate_unit, gaps, 400));
  EXPECT_FALSE(may_be_complete(Module::rate_unit, gaps, 1000));  // thinned
  EXPECT_FALSE(may_be_complete(Module::rate_unit, gaps, {}));
  EXPECT_TRUE(may_be_complete(Module::attitude_unit, gaps, {}));
}

}  // namespace
}  // namespace attest
