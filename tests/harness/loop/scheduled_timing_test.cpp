#include "harness/loop/scheduled_timing.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/harness/times.hpp"

namespace attest {
namespace {

using testing::ElementsAre;

TEST(ScheduledTiming, IsWhenTheUnitRunsAndIsOver) {
  const std::vector<TaskJob> unit = {{ms(0), ms(1), ms(3)}, {ms(4), ms(4), ms(5)}};
  EXPECT_THAT(scheduled_timing(unit, nullptr),
              ElementsAre(LoopTick{ms(1), ms(1), ms(3)}, LoopTick{ms(4), ms(4), ms(5)}));
}

TEST(ScheduledTiming, ASampleIsOfTheEstimatorsLastFinishedJob) {
  const std::vector<TaskJob> unit = {
      {ms(0), ms(1), ms(2)}, {ms(4), ms(5), ms(6)}, {ms(8), ms(9), ms(10)}};
  const std::vector<TaskJob> estimator = {{ms(0), ms(0), ms(5)}, {ms(6), ms(6), ms(10)}};
  EXPECT_THAT(scheduled_timing(unit, &estimator),
              ElementsAre(LoopTick{Nanoseconds(-1), ms(1), ms(2)}, LoopTick{ms(0), ms(5), ms(6)},
                          LoopTick{ms(0), ms(9), ms(10)}));
}

TEST(ScheduledTiming, OfTheCascadeTheSampleIsTheAttitudeUnits) {
  const std::vector<TaskJob> rate = {{ms(0), ms(1), ms(2)}};
  const std::vector<TaskJob> attitude = {{ms(4), ms(5), ms(6)}};
  const std::vector<TaskJob> estimator = {{ms(2), ms(3), ms(5)}};
  const FlightTiming timing = scheduled_cascade(rate, attitude, &estimator);
  EXPECT_THAT(timing.unit, ElementsAre(LoopTick{ms(1), ms(1), ms(2)}));
  EXPECT_THAT(timing.attitude_unit, ElementsAre(LoopTick{ms(3), ms(5), ms(6)}));
}

}  // namespace
}  // namespace attest
