#include "harness/loop/timing_file.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/core/file.hpp"
#include "tests/harness/core/temporary_directory.hpp"
#include "tests/harness/times.hpp"

namespace attest {
namespace {

using testing::EndsWith;
using testing::HasSubstr;

TimingFile sample() {
  return {"px4-v1.5.5/flight/hover",
          "0123",
          {Rate::hz(1000, 3), PlantConfiguration{"iris", PlantKind::ode}},
          0.25,
          LoopTiming{{us(-1), us(10), us(1000)},
                     {us(0), us(3010), std::nullopt},
                     {us(2000), us(6001), us(7000)}}};
}

class TimingFileTest : public testing::Test {
 protected:
  std::filesystem::path path() const { return directory_.path() / "timing.json"; }

  void write(const std::string& text) const { ASSERT_TRUE(write_file(path(), text)); }

  // The message, without the folder.
  std::string error_of(const std::string& text) const {
    write(text);
    const auto timing = read_timing(path());
    return timing ? "" : timing.error().message;
  }

 private:
  TemporaryDirectory directory_;
};

TEST_F(TimingFileTest, IsReadAsItWasWritten) {
  ASSERT_TRUE(write_timing(sample(), path()));
  const auto read = read_timing(path());
  ASSERT_TRUE(read) << read.error().to_string();
  EXPECT_EQ(read->case_id, sample().case_id);
  EXPECT_EQ(read->case_sha256, sample().case_sha256);
  EXPECT_EQ(read->configuration, sample().configuration);
  EXPECT_EQ(read->duration_s, 0.25);
  EXPECT_EQ(read->ticks, sample().ticks);
}

TEST_F(TimingFileTest, WhatIsNoTimingIsRefused) {
  for (const char* text : {"[]", "{\"attest_timing\": 2}"}) {
    EXPECT_THAT(error_of(text), HasSubstr("is no timing file")) << text;
  }
  EXPECT_THAT(error_of("{"), HasSubstr("was cut off"));
  EXPECT_THAT(error_of("timestamp,in/x\n1,2\n"), HasSubstr("is not JSON"));
  const auto missing = read_timing(path().parent_path() / "none.json");
  ASSERT_FALSE(missing);
  EXPECT_THAT(missing.error().file, EndsWith("none.json"));
}

TEST_F(TimingFileTest, TimesThatGoBackwardsAreRefused) {
  const auto with_ticks = [](const std::string& ticks) {
    return R"({"attest_timing":1,"case":"c","case_sha256":"0","rate":"100","vehicle":"iris",)"
           R"("plant":"mujoco","duration_s":1,"ticks_ns":)" +
           ticks + "}";
  };
  EXPECT_EQ(error_of(with_ticks("[[0,1000,2000],[0,2000,null]]")), "");
  EXPECT_THAT(error_of(with_ticks("[]")), HasSubstr("has no ticks"));
  EXPECT_THAT(error_of(with_ticks("[[0,1000,2000],[0,1500,3000]]")), HasSubstr("tick 1"));
  EXPECT_THAT(error_of(with_ticks("[[5,4,6]]")), HasSubstr("tick 0"));
  EXPECT_THAT(error_of(with_ticks("[[0,1000,999]]")), HasSubstr("tick 0"));
  EXPECT_THAT(error_of(with_ticks("[[0,1000,9000],[0,2000,8000]]")), HasSubstr("tick 1"));
  EXPECT_THAT(error_of(with_ticks("[[0,1000]]")), HasSubstr("[0,1000] is not"));
  EXPECT_THAT(error_of(with_ticks("[[0,1000,\"x\"]]")), HasSubstr("tick 0"));
}

TEST_F(TimingFileTest, TimesThatDoNotFitAreRefused) {
  const auto with_ticks = [](const std::string& ticks) {
    return R"({"attest_timing":1,"case":"c","case_sha256":"0","rate":"100","vehicle":"iris",)"
           R"("plant":"mujoco","duration_s":1,"ticks_ns":)" +
           ticks + "}";
  };
  EXPECT_EQ(error_of(with_ticks("[[-10000000000000000,10000000000000000,null]]")), "");
  for (const char* time : {"10000000000000001", "9223372036854775807", "18446744073709551615"}) {
    EXPECT_THAT(error_of(with_ticks(fmt::format("[[0,{0},{0}],[0,{0},null]]", time))),
                HasSubstr("tick 0: "));
    EXPECT_THAT(error_of(with_ticks(fmt::format("[[-{0},0,null]]", time))), HasSubstr("tick 0: "));
  }
}

TEST_F(TimingFileTest, OfTheCascadeHasTheTicksOfBothUnits) {
  TimingFile timing = sample();
  timing.configuration.rate = LoopRate(Rate::hz(250), Rate::hz(1000));
  timing.ticks.attitude_unit = {{us(0), us(4), us(9)}};
  ASSERT_TRUE(write_timing(timing, path()));
  const auto read = read_timing(path());
  ASSERT_TRUE(read) << read.error().to_string();
  EXPECT_EQ(read->configuration, timing.configuration);
  EXPECT_EQ(read->ticks, timing.ticks);
  timing.ticks.attitude_unit = {{us(0), us(250000), us(250000)}};
  ASSERT_TRUE(write_timing(timing, path()));
  const auto too_late = read_timing(path());
  ASSERT_FALSE(too_late);
  EXPECT_THAT(too_late.error().message, HasSubstr("has ticks after `duration_s`"));
  EXPECT_THAT(error_of(R"({"attest_timing":1,"case":"c","case_sha256":"0","rate":"250:1000",)"
                       R"("vehicle":"iris","plant":"mujoco","duration_s":1,"ticks_ns":[[0,1,2]]})"),
              HasSubstr("has two rates, but no `attitude_ticks_ns`"));
}

TEST(Timed, IsAsLongAsItWasWithTheMetricsThatBegin) {
  Case the_case;
  the_case.flight.emplace();
  Metric early, late;
  late.window.from_s = 1;
  the_case.flight->metrics = {early, late};
  const Case as_long = with_timing(the_case, sample());
  EXPECT_EQ(as_long.duration.amount, 0.25);
  EXPECT_EQ(as_long.flight->metrics.size(), 1u);
}

}  // namespace
}  // namespace attest
