// The unit's loop on a clock whose lateness the test gives: which releases are used and passed
// over, and which deadlines are missed.
#include "harness/realtime/live_unit.hpp"

#include <functional>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/realtime/allocations.hpp"
#include "tests/harness/realtime/flights.hpp"
#include "tests/harness/realtime/scripted_clock.hpp"
#include "tests/harness/times.hpp"

namespace attest {
namespace {

using testing::ElementsAre;

// Its steps take the times that the test gives, by step number.
class SlowUnit final : public UnitOf<attest_inputs, attest_outputs> {
 public:
  explicit SlowUnit(ScriptedClock& clock) : clock_(clock) {}
  int set_parameter(const std::string&, float) override { return ATTEST_OK; }
  int step(const attest_inputs& in, attest_outputs&) override {
    timestamps.push_back(in.timestamp);
    clock_.pass(takes(timestamps.size() - 1));
    return result;
  }

  std::function<Nanoseconds(std::size_t)> takes = [](std::size_t) { return us(10); };
  std::vector<std::uint64_t> timestamps;
  int result = ATTEST_OK;

 private:
  ScriptedClock& clock_;
};

class LiveUnitTest : public testing::Test {
 protected:
  LiveUnitTest() { timestamps_.reserve(64); }

  // At 1 kHz, for 8 releases.
  LiveUnitRecord run() {
    const auto vehicle = test::quad_vehicle();
    Case the_case = test::hover_case(0.008);
    the_case.unit.on_estimate = on_estimate_;
    UnitTask task(the_case, rate_, vehicle, unit_, {});
    LiveUnit live(the_case, rate_, task, clock_, links_, 4);
    live.run();
    return live.take_record();
  }

  // The estimator's sample of that time arrives.
  void publish(Nanoseconds time) {
    links_.unit.states.write({time, {}, clock_.now()});
    links_.published.release();
  }

  bool on_estimate_ = false;
  Rate rate_ = Rate::hz(1000);
  ScriptedClock clock_;
  SlowUnit unit_{clock_};
  Links links_;
  std::vector<std::uint64_t> timestamps_;
};

TEST_F(LiveUnitTest, MeetsEveryDeadlineWhenItIsQuick) {
  const LiveUnitRecord record = run();
  EXPECT_EQ(record.ticks.size(), 8u);
  EXPECT_EQ(record.samples.size(), 4u);
  EXPECT_EQ(record.skipped, 0u);
  for (const LiveTick& tick : record.ticks) {
    EXPECT_EQ(tick.response(), us(10));
    EXPECT_EQ(tick.latency(), us(0));
  }
  EXPECT_TRUE(links_.stop);
}

TEST_F(LiveUnitTest, AStepThatPassesAReleaseIsFollowedAtOnce) {
  unit_.takes = [](std::size_t step) { return us(step == 2 ? 1300 : 10); };
  const LiveUnitRecord record = run();
  EXPECT_EQ(record.ticks.size(), 8u);
  EXPECT_EQ(record.skipped, 0u);
  EXPECT_EQ(record.ticks[2].response(), us(1300));
  EXPECT_EQ(record.ticks[3].begins, us(3300));
  EXPECT_EQ(record.ticks[4].begins, us(4000));
  EXPECT_EQ(record.ticks[3].latency(), us(300));
}

TEST_F(LiveUnitTest, OfSeveralReleasesThatPassOnlyTheLastIsUsed) {
  unit_.takes = [](std::size_t step) { return us(step == 2 ? 3300 : 10); };
  const LiveUnitRecord record = run();
  EXPECT_EQ(record.ticks.size(), 6u);
  EXPECT_EQ(record.skipped, 2u);
  EXPECT_EQ(record.ticks[2].skipped, 2u);
  EXPECT_THAT(clock_.deadlines,
              ElementsAre(us(0), us(1000), us(2000), us(5000), us(6000), us(7000)));
}

TEST_F(LiveUnitTest, ReleasesThatPassAtTheEndAreSkippedToo) {
  unit_.takes = [](std::size_t step) { return us(step == 5 ? 9000 : 10); };
  const LiveUnitRecord record = run();
  EXPECT_EQ(record.ticks.size(), 6u);
  EXPECT_EQ(record.skipped, 2u);
}

TEST_F(LiveUnitTest, AWakeUpThatIsLateIsNotTheSteps) {
  clock_.latency = [](Nanoseconds deadline) { return us(deadline == us(3000) ? 2500 : 0); };
  const LiveUnitRecord record = run();
  EXPECT_EQ(record.skipped, 1u);
  EXPECT_EQ(record.ticks[3].response(), us(2510));
  EXPECT_EQ(record.ticks[3].latency(), us(2500));
}

TEST_F(LiveUnitTest, ATickKnowsItsReleaseAndItsDeadline) {
  clock_.latency = [](Nanoseconds) { return us(70); };
  const LiveUnitRecord record = run();
  const LiveTick& tick = record.ticks[3];
  EXPECT_EQ(tick.release_number, 3);
  EXPECT_EQ(tick.release, us(3000));
  EXPECT_EQ(tick.deadline, us(4000));
  EXPECT_EQ(tick.start, us(3070));
  EXPECT_EQ(tick.finish, us(3080));
  EXPECT_EQ(tick.elapsed, us(10));
  EXPECT_LT(tick.cpu, ms(1));  // of the real CPU, not of the scripted clock
}

TEST_F(LiveUnitTest, AStepThatSleepsHasWaited) {
  unit_.takes = [](std::size_t step) {
    if (step == 2) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return us(10);
  };
  const LiveUnitRecord record = run();
  EXPECT_TRUE(record.ticks[2].waited);
  EXPECT_EQ(record.ticks[2].execution(), us(10));
}

TEST_F(LiveUnitTest, TimestampsAreWhenItReallyRan) {
  clock_.latency = [](Nanoseconds) { return us(70); };
  run();
  EXPECT_THAT(unit_.timestamps, testing::Contains(5'002'070u));
}

TEST_F(LiveUnitTest, TheSampleIsTheLastThatThereIs) {
  links_.unit.states.write({us(0), {}});
  unit_.takes = [&](std::size_t step) {
    if (step == 1) links_.unit.states.write({us(900), {}});
    return us(10);
  };
  const LiveUnitRecord record = run();
  EXPECT_EQ(record.ticks[1].sampled, us(0));
  EXPECT_EQ(record.ticks[2].sampled, us(900));
  EXPECT_EQ(record.ticks[7].age(), us(7010 - 900));
}

TEST_F(LiveUnitTest, OnEstimatesItRunsOnceForEachSample) {
  on_estimate_ = true;
  publish(us(0));
  unit_.takes = [&](std::size_t step) {
    clock_.pass(us(1000));
    if (step < 7) publish(us(1000) * static_cast<std::int64_t>(step + 1));
    return us(10);
  };
  const LiveUnitRecord record = run();
  ASSERT_EQ(record.ticks.size(), 8u);
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_EQ(record.ticks[i].sampled, us(1000) * static_cast<std::int64_t>(i));
    // From the publication, in the middle of a step.
    EXPECT_EQ(record.ticks[i].latency(), us(i == 0 ? 0 : 10));
  }
  EXPECT_EQ(record.skipped, 0u);
  EXPECT_THAT(clock_.deadlines, testing::IsEmpty());
}

TEST_F(LiveUnitTest, OfSeveralEstimatesThatCameOnlyTheNewestIsUsed) {
  on_estimate_ = true;
  publish(us(0));
  unit_.takes = [&](std::size_t step) {
    if (step == 0) {
      for (const int time : {1000, 2000, 3000}) publish(us(time));
    } else {
      links_.all_published = true;
      links_.published.release();
    }
    return us(10);
  };
  const LiveUnitRecord record = run();
  ASSERT_EQ(record.ticks.size(), 2u);
  EXPECT_EQ(record.ticks[0].skipped, 2u);
  EXPECT_EQ(record.ticks[1].sampled, us(3000));
  EXPECT_EQ(record.ticks[1].skipped, 4u);  // that never came
  EXPECT_EQ(record.skipped, 6u);
}

TEST_F(LiveUnitTest, TheLastUnitThatEndsStopsTheFlight) {
  links_.flying = 2;
  run();
  EXPECT_FALSE(links_.stop);
  run();
  EXPECT_TRUE(links_.stop);
}

TEST_F(LiveUnitTest, AFaultStopsTheFlightOfTheOtherUnitToo) {
  links_.flying = 2;
  unit_.result = ATTEST_FAILED;
  run();
  EXPECT_TRUE(links_.stop);
}

TEST_F(LiveUnitTest, EndsWhenAPortGoesWrong) {
  unit_.result = ATTEST_FAILED;
  const LiveUnitRecord record = run();
  EXPECT_TRUE(record.fault);
  EXPECT_TRUE(record.ticks.empty());
  EXPECT_TRUE(links_.stop);
}

TEST_F(LiveUnitTest, ATickDoesNotAllocate) {
  unit_.timestamps.reserve(64);
  clock_.deadlines.reserve(64);
  std::uint64_t at_first = 0, at_last = 0;
  unit_.takes = [&](std::size_t step) {
    if (step == 1) at_first = thread_allocations();
    if (step == 7) at_last = thread_allocations();
    return us(10);
  };
  run();
  EXPECT_EQ(at_first, at_last);
}

}  // namespace
}  // namespace attest
